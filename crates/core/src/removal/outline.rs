//! The nearest point of the outline of a tool, and the normal there.

use super::tool_solid::{Side, ToolSolid};

/// A point of the outline that is nearest to a given one, in the plane through the axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// m; negative inside.
    pub(super) distance: f64,
    /// Outward unit vector, away from the axis and along it.
    pub(super) normal: [f64; 2],
}

/// Below this distance, m, the normal is that of the outline; above it that of the offset.
const ON_OUTLINE: f64 = 1e-9;

/// The point of the outline nearest to one at the distance `rho` from the axis and the height `h`, m.
pub(super) fn nearest(tool: &ToolSolid, rho: f64, h: f64) -> Nearest {
    let [bottom, top] = tool.heights();
    let is_inside = tool.radius_at(h).is_some_and(|radius| rho <= radius);
    let mut best: Option<(f64, [f64; 2], [f64; 2])> = None;
    let mut take = |point: [f64; 2], normal: [f64; 2]| {
        let off = [rho - point[0], h - point[1]];
        let square = off[0] * off[0] + off[1] * off[1];
        if best.is_none_or(|(least, ..)| square < least) {
            best = Some((square, off, normal));
        }
    };
    for (height, normal) in [(bottom, [0.0, -1.0]), (top, [0.0, 1.0])] {
        let radius = tool.radius_at(height).unwrap_or_default();
        // A point has no face.
        if radius > 0.0 {
            take([rho.min(radius), height], normal);
        }
    }
    for band in tool.bands() {
        let [low, high] = band.heights;
        match band.side {
            Side::Flank {
                radius_at_zero,
                slope,
            } => {
                let length = (1.0 + slope * slope).sqrt();
                // The foot of the perpendicular on the line.
                let foot = (h + slope * (rho - radius_at_zero)) / (length * length);
                let foot = foot.clamp(low, high);
                take(
                    [radius_at_zero + slope * foot, foot],
                    [1.0 / length, -slope / length],
                );
            }
            Side::Corner {
                centre_radius,
                centre_height,
                radius,
            } => {
                let (out, up) = (rho - centre_radius, h - centre_height);
                let length = out.hypot(up);
                let lowest = (high - centre_height) / radius;
                if length > 0.0 && out >= 0.0 && up / length <= lowest {
                    let normal = [out / length, up / length];
                    take(
                        [
                            centre_radius + radius * normal[0],
                            centre_height + radius * normal[1],
                        ],
                        normal,
                    );
                }
            }
        }
    }
    let (square, off, normal) = best.unwrap_or((0.0, [0.0; 2], [0.0, 1.0]));
    let length = square.sqrt();
    let sign = if is_inside { -1.0 } else { 1.0 };
    Nearest {
        distance: sign * length,
        normal: if length > ON_OUTLINE {
            off.map(|part| sign * part / length)
        } else {
            normal
        },
    }
}
