//! Whether a moving tool is on one side of a point of a dexel: a quick sufficient test.
//!
//! The swept solid is convex. If a plane through the point `p` has all of it on one side, and the dexel leaves the plane to that side, then
//! the tool meets the dexel beyond `p` alone, or not at all, and cuts no material that ends there:
//!
//! ```text
//! n . p <= min over x in the tool of n . x  +  min(0, n . m),    n . d >= 0
//! ```
//!
//! `n` points from `p` to the nearest point of the core of the tool at the time when its axis is near: of a corner the disc that it is the
//! enlargement of, of a flank straight inwards. For a ball this is the distance of the point from the line of centres, and the test is
//! exact. Most dexels under a tool were cut by the move before, and this test finds that in a tenth of the time of the interval.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `p`, `d` | point and direction of the dexel | m, - |
//! | `m` | the move | m |
//! | `n` | normal of the plane | m |
//!
//! Source: separating planes of convex sets \[derived\].

use nalgebra::Vector3;

use super::swept::{End, across};
use super::tool_solid::{Side, ToolSolid};
use super::turning::Stroke;

/// A tool on a straight move, for the test. Vectors have their parts in the order of the two directions across the dexels, and the one along them.
#[derive(Clone, Debug)]
pub(super) struct Apart {
    from: Parts,
    travel: Parts,
    /// The move over the square of its length; zero of no move.
    per_travel: Parts,
    /// The same of its part across the axis.
    per_across: Parts,
    axis: Parts,
    corner: Option<RoundedDisc>,
    /// Lower ends of flanks, and the top.
    rims: Vec<Rim>,
    /// Cuts less deep than this are left out, m.
    skin: f64,
}

/// Across the dexels twice, along them.
type Parts = [f64; 3];

/// A disc across the axis, enlarged by a radius: the corner.
#[derive(Clone, Copy, Debug)]
struct RoundedDisc {
    disc: f64,
    height: f64,
    radius: f64,
    /// The corner ends here.
    ends: f64,
    /// Square of the sine of the angle between the axis and the flank above.
    taper_squared: f64,
}

/// A circle around the axis.
#[derive(Clone, Copy, Debug)]
struct Rim {
    height: f64,
    radius: f64,
    /// Slope of the flank above it.
    slope: f64,
}

#[inline]
fn dot(a: &Parts, b: &Parts) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Apart {
    /// The tool with this axis, whose tip moves between two points, and dexels along `k`; cuts less deep than `skin` are left out, m.
    pub(super) fn new(tool: &ToolSolid, stroke: &Stroke, k: usize, skin: f64) -> Apart {
        let [i, j] = across(k);
        let parts = |vector: &Vector3<f64>| [vector[i], vector[j], vector[k]];
        let travel = stroke.ends[1] - stroke.ends[0];
        let square = travel.norm_squared();
        let per_travel = if square > 0.0 {
            travel / square
        } else {
            Vector3::zeros()
        };
        let across_axis = travel - stroke.axis.into_inner() * travel.dot(&stroke.axis);
        let square_across = across_axis.norm_squared();
        let per_across = if square_across > 0.0 {
            across_axis / square_across
        } else {
            Vector3::zeros()
        };
        let mut corner = None;
        let mut rims = Vec::with_capacity(4);
        for band in tool.bands() {
            match band.side {
                Side::Flank { slope, .. } => rims.push(Rim {
                    height: band.heights[0],
                    radius: band.radius_at(band.heights[0]),
                    slope,
                }),
                Side::Corner {
                    centre_radius,
                    centre_height,
                    radius,
                } => {
                    let taper = (centre_height - band.heights[1]) / radius;
                    corner = Some(RoundedDisc {
                        disc: centre_radius,
                        height: centre_height,
                        radius,
                        ends: band.heights[1],
                        taper_squared: taper * taper,
                    });
                }
            }
        }
        if let Some(band) = tool.bands().last() {
            rims.push(Rim {
                height: band.heights[1],
                radius: band.radius_at(band.heights[1]),
                slope: 0.0,
            });
        }
        Apart {
            from: parts(&stroke.ends[0].coords),
            travel: parts(&travel),
            per_travel: parts(&per_travel),
            per_across: parts(&per_across),
            axis: parts(&stroke.axis),
            corner,
            rims,
            skin,
        }
    }

    /// Whether it is certain that the tool meets the dexel of this point above it only (`End::Low`: its lower end is above), or
    /// below it only.
    #[inline]
    pub(super) fn is_certain(&self, point: Parts, end: End) -> bool {
        let off = [
            point[0] - self.from[0],
            point[1] - self.from[1],
            point[2] - self.from[2],
        ];
        let of_ball = match &self.corner {
            Some(corner) if corner.disc == 0.0 => self.ball(corner, &off, end),
            _ => None,
        };
        of_ball.unwrap_or_else(|| self.any(&off, end))
    }

    /// Of a tool that ends in a ball; `None` where the plane of its nearest point is steeper than the flank.
    #[inline]
    fn ball(&self, ball: &RoundedDisc, off: &Parts, end: End) -> Option<bool> {
        let off = std::array::from_fn(|n| off[n] - self.axis[n] * ball.height);
        let t = dot(&off, &self.per_travel).clamp(0.0, 1.0);
        let normal: Parts = std::array::from_fn(|n| self.travel[n] * t - off[n]);
        let (square, up) = (dot(&normal, &normal), dot(&normal, &self.axis));
        if up < 0.0 || up * up < ball.taper_squared * square {
            return None;
        }
        let least = ball.radius - self.skin;
        let leaves = match end {
            End::Low => normal[2] > 0.0,
            End::High => normal[2] < 0.0,
        };
        Some(leaves && square >= least * least)
    }

    fn any(&self, off: &Parts, end: End) -> bool {
        let along = dot(off, &self.axis);
        let is_low = self.corner.as_ref().is_some_and(|corner| along < corner.ends);
        let per = if is_low {
            &self.per_travel
        } else {
            &self.per_across
        };
        let t = dot(off, per).clamp(0.0, 1.0);
        let from_tip: Parts = std::array::from_fn(|n| off[n] - self.travel[n] * t);
        let height = dot(&from_tip, &self.axis);
        let across: Parts = std::array::from_fn(|n| from_tip[n] - self.axis[n] * height);
        let rho = dot(&across, &across).sqrt();
        let [out, up] = self.inwards(rho, height);
        let per_rho = if rho > 0.0 { out / rho } else { 0.0 };
        let normal: Parts = std::array::from_fn(|n| across[n] * per_rho + self.axis[n] * up);
        // A dexel along the plane does not meet what is behind it.
        let leaves = match end {
            End::Low => normal[2] >= 0.0,
            End::High => normal[2] <= 0.0,
        };
        if !leaves {
            return false;
        }
        let length = (out * out + up * up).sqrt();
        let mut least = match &self.corner {
            Some(corner) => corner.height * up - corner.disc * out.abs() - corner.radius * length,
            None => f64::INFINITY,
        };
        for rim in &self.rims {
            least = least.min(rim.height * up - rim.radius * out.abs());
        }
        let travel = dot(&normal, &self.travel);
        let place = out * rho + up * height + t * travel;
        place <= least + travel.min(0.0) + self.skin * length
    }

    /// The direction to the core of the tool: away from the axis, and along it.
    #[inline]
    fn inwards(&self, rho: f64, height: f64) -> [f64; 2] {
        if let Some(corner) = &self.corner
            && height < corner.ends
        {
            return [rho.min(corner.disc) - rho, corner.height - height];
        }
        let Some(rim) = self.rims.iter().rev().find(|rim| height >= rim.height) else {
            // Below a sharp corner or point.
            let [radius, begins] = self.rims.first().map_or([0.0; 2], |rim| [rim.radius, rim.height]);
            return [rho.min(radius) - rho, begins - height];
        };
        if self.rims.last().is_some_and(|top| height >= top.height) {
            return [0.0, -1.0];
        }
        [-1.0, rim.slope]
    }
}
