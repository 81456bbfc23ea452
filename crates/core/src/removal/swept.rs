//! A tool on a straight move with a fixed axis, and the part of a dexel inside of what it sweeps.
//!
//! The swept solid is the Minkowski sum of a convex solid and a segment. It is convex, so a straight line is inside of it in
//! one interval. The points of the dexel at all times are a plane in the frame of the tool:
//!
//! ```text
//! x(s, t) = q + s d - t m,    0 <= t <= 1
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `s`, `t` | place along the dexel, time of the move | m, - |
//! | `d`, `m` | direction of the dexel, the move | -, m |
//! | `q` | the point of the dexel at the height of the start, relative to the tip there | m |
//! | `u`, `v` | coordinates in this plane: across the tool axis, and as steep as the plane | m |
//!
//! The slice of the tool by that plane is `|u| <= w(v)`: it is symmetric, since the plane through the axis and the normal of the slice is a plane of symmetry of both. Both `s` and
//! `t` are linear in `u` and `v`:
//!
//! ```text
//! s = alpha (u - u_q) + beta v,    t = alpha_t (u - u_q) + beta_t v
//! least s = -alpha u_q - max (|alpha| w(v) - beta v)
//! ```
//!
//! Where that is at a time before or after the move, the interval ends at the start or end of the move, since the slice is convex: there
//! the end is that of the tool at rest. Of cylinders, cones and spheres every step is in closed form
//! ([`conic`](super::conic)), of other corners by search ([`torus`](super::torus)). Without motion across the dexel the
//! interval is that of the tool at rest, longer by the move.
//!
//! Source: \[derived\]; the swept solid of a convex tool as a Minkowski sum is usual.

use nalgebra::{Point3, Unit, Vector3};

use super::conic::{Chord, Conic, Farthest, PlaneLine};
use super::tool_solid::{Band, Side, ToolSolid};
use super::torus::Torus;

/// A tool on a straight move, seen along the dexels of one direction.
#[derive(Clone, Debug)]
pub(super) struct SweptTool<'a> {
    tool: &'a ToolSolid,
    /// The start across the dexels and along them, m.
    start: [f64; 2],
    start_along: f64,
    /// `u`, `y` and height per distance across the dexels.
    u_of: [f64; 2],
    y_of: [f64; 2],
    h_of: [f64; 2],
    /// Growth of the height and of `y` per `v`.
    sin: f64,
    cos: f64,
    /// Rates of `u` and `v` along the dexel and along the move.
    dexel: [f64; 2],
    travel: [f64; 2],
    /// `s` and `t` per `u` and per `v`.
    per_u: [f64; 2],
    per_v: [f64; 2],
    /// Length of a move along the dexels, m.
    parallel: Option<f64>,
    top: Option<(End, f64)>,
}

/// An end of the interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    Low = 0,
    High = 1,
}

impl End {
    /// The direction out of the interval.
    fn sign(self) -> f64 {
        match self {
            End::Low => -1.0,
            End::High => 1.0,
        }
    }
}

/// Motion across the dexels that is neglected, m: the interval is exact for a dexel this far away.
const PARALLEL: f64 = 1e-9;
/// Planes this level, rad, are level: an error of 10 pm in a tool of 10 mm.
const LEVEL: f64 = 1e-9;

/// The two directions across direction `k`, in order.
pub(super) fn across(k: usize) -> [usize; 2] {
    match k {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}

/// The end at the top of a tool that moves between two places along its axis.
fn top(tool: &ToolSolid, [from, to]: [f64; 2], axis: f64) -> Option<(End, f64)> {
    // Below this height every radius is within that of the top.
    let widens = tool
        .bands()
        .windows(2)
        .all(|pair| pair[0].radius_at(pair[0].heights[1]) <= tool.radius());
    let top = tool
        .bands()
        .last()
        .filter(|band| widens && band.radius_at(band.heights[1]) >= tool.radius())?;
    let height = top.heights[1];
    match () {
        () if axis >= 1.0 => Some((End::High, from.min(to) + height)),
        () if axis <= -1.0 => Some((End::Low, from.max(to) - height)),
        () => None,
    }
}

/// The slice of a band.
enum Slice {
    Conic(Conic),
    Torus(Torus),
}

impl Slice {
    #[inline]
    fn farthest(&self, a: f64, b: f64) -> Option<Farthest> {
        match self {
            Slice::Conic(conic) => conic.farthest(a, b),
            Slice::Torus(torus) => torus.farthest(a, b),
        }
    }

    #[inline]
    fn meets(&self, line: &PlaneLine) -> Option<Chord> {
        match self {
            Slice::Conic(conic) => conic.meets(line),
            Slice::Torus(torus) => torus.meets(line),
        }
    }
}

/// The dexel at the height of the start of the move, in the axes of the slice, m.
#[derive(Clone, Copy)]
struct Foot {
    u: f64,
    y: f64,
    h: f64,
}

impl SweptTool<'_> {
    /// The tool with this axis, from its tip towards the spindle, whose tip moves between two points, m; dexels along
    /// axis `k`.
    pub(super) fn new<'a>(
        tool: &'a ToolSolid,
        ends: [Point3<f64>; 2],
        axis: &Unit<Vector3<f64>>,
        k: usize,
    ) -> SweptTool<'a> {
        let [from, to] = ends;
        let (direction, mut travel) = (Vector3::ith(k, 1.0), to - from);
        let mut parallel = None;
        let mut normal = direction.cross(&travel);
        if normal.norm() <= PARALLEL {
            parallel = Some(travel[k]);
            // Any plane through the dexel: the tool rests.
            let least = if axis.cross(&direction).norm() > 0.5 {
                axis.into_inner()
            } else {
                Vector3::ith((k + 1) % 3, 1.0)
            };
            normal = direction.cross(&least);
            travel = least;
        }
        let normal = normal.normalize();
        let level = axis.cross(&normal);
        let sin = level.norm();
        let (e_u, sin) = if sin > LEVEL {
            (level / sin, sin)
        } else {
            (direction, 0.0)
        };
        let e_v = normal.cross(&e_u);
        let e_y = axis.cross(&e_u);
        let in_plane = |vector: &Vector3<f64>| [vector.dot(&e_u), vector.dot(&e_v)];
        let (d, m) = (in_plane(&direction), in_plane(&travel));
        let [i, j] = across(k);
        let area = m[0] * d[1] - m[1] * d[0];
        // x = q + s d - t m, solved for s and t: the determinant of the columns d, -m is m_u d_v - m_v d_u.
        SweptTool {
            tool,
            start: [from[i], from[j]],
            start_along: from[k],
            u_of: [e_u[i], e_u[j]],
            y_of: [e_y[i], e_y[j]],
            h_of: [axis[i], axis[j]],
            sin,
            cos: e_v.dot(&e_y),
            dexel: d,
            travel: m,
            per_u: [-m[1] / area, -d[1] / area],
            per_v: [m[0] / area, d[0] / area],
            parallel,
            top: top(tool, ends.map(|end| end[k]), axis[k]),
        }
    }

    /// Where the axis is along the dexels: the end of a dexel inside that is at the top of the tool, and how far out it is at
    /// least, m. A dexel that enters the tool leaves it there.
    pub(super) fn top(&self) -> Option<(End, f64)> {
        self.top
    }

    /// An end of the part of the dexel at `at` (coordinates across it) inside of the swept solid, m; `None` where it is outside.
    #[inline]
    pub(super) fn end(&self, at: [f64; 2], end: End) -> Option<f64> {
        let off = [at[0] - self.start[0], at[1] - self.start[1]];
        let along = |per: [f64; 2]| off[0] * per[0] + off[1] * per[1];
        let foot = Foot {
            u: along(self.u_of),
            y: along(self.y_of),
            h: along(self.h_of),
        };
        let s = match self.parallel {
            Some(length) => {
                let by = match end {
                    End::Low => length.min(0.0),
                    End::High => length.max(0.0),
                };
                self.at_rest(&foot, 0.0, end)? + by
            }
            None => self.of_move(&foot, end)?,
        };
        Some(self.start_along + s)
    }

    #[inline]
    fn of_move(&self, foot: &Foot, end: End) -> Option<f64> {
        let sign = end.sign();
        let [alpha, alpha_t] = self.per_u;
        let [beta, beta_t] = self.per_v;
        let (a, b) = (alpha.abs(), sign * beta);
        let mut best: Option<(f64, Farthest)> = None;
        for band in self.tool.bands() {
            let Some(found) = self.slice(band, foot).and_then(|slice| slice.farthest(a, b)) else {
                continue;
            };
            let value = a * found.w + b * found.v;
            if best.is_none_or(|(most, _)| value > most) {
                best = Some((value, found));
            }
            if found.inside {
                break;
            }
        }
        let (value, found) = best?;
        let u = found.w.copysign(sign * alpha);
        let t = alpha_t * (u - foot.u) + beta_t * found.v;
        if (0.0..=1.0).contains(&t) {
            return Some(sign * value - alpha * foot.u);
        }
        self.at_rest(foot, t.clamp(0.0, 1.0), end)
    }

    /// An end of the part of the dexel inside of the tool at the time `t`.
    #[inline]
    fn at_rest(&self, foot: &Foot, t: f64, end: End) -> Option<f64> {
        let line = PlaneLine {
            start: [foot.u - t * self.travel[0], -t * self.travel[1]],
            rate: self.dexel,
        };
        let (sign, side) = (end.sign(), end as usize);
        let mut most: Option<f64> = None;
        for band in self.tool.bands() {
            let Some(chord) = self.slice(band, foot).and_then(|slice| slice.meets(&line)) else {
                continue;
            };
            let place = chord.ends[side];
            if most.is_none_or(|most| (place - most) * sign > 0.0) {
                most = Some(place);
            }
            // An end on the side of the tool is that of the whole tool.
            if chord.on_outline[side] {
                break;
            }
        }
        most
    }

    #[inline]
    fn slice(&self, band: &Band, foot: &Foot) -> Option<Slice> {
        let &Foot { y, h, .. } = foot;
        let (sin, cos) = (self.sin, self.cos);
        let [low, high] = band.heights;
        if sin == 0.0 {
            if h < low || h > high {
                return None;
            }
            let radius = band.radius_at(h);
            return Some(Slice::Conic(Conic {
                a: (radius - y) * (radius + y),
                b: -y * cos,
                c: -1.0,
                root: Some(radius),
                opening: 0.0,
                range: [f64::NEG_INFINITY, f64::INFINITY],
            }));
        }
        let range = [(low - h) / sin, (high - h) / sin];
        Some(match band.side {
            Side::Flank {
                radius_at_zero,
                slope,
            } => {
                let (radius, opening) = (radius_at_zero + slope * h, slope * sin);
                Slice::Conic(Conic {
                    a: (radius - y) * (radius + y),
                    b: radius * opening - y * cos,
                    c: opening * opening - cos * cos,
                    root: Some((radius * cos - y * opening).abs()),
                    opening,
                    range,
                })
            }
            Side::Corner {
                centre_radius: 0.0,
                centre_height,
                radius,
            } => {
                let up = h - centre_height;
                let b = -(up * sin + y * cos);
                // The distance of the plane from the centre, without the difference of large numbers.
                let off = up * cos - y * sin;
                let square = (radius - off) * (radius + off);
                Slice::Conic(Conic {
                    a: square - b * b,
                    b,
                    c: -1.0,
                    root: (square >= 0.0).then(|| square.sqrt()),
                    opening: 0.0,
                    range,
                })
            }
            Side::Corner {
                centre_radius,
                radius,
                ..
            } => Slice::Torus(Torus {
                disc: centre_radius,
                corner: radius,
                h,
                y,
                sin,
                cos,
                range,
            }),
        })
    }
}

#[cfg(test)]
mod tests;
