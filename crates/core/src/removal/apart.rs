//! Whether a moving tool is on one side of a point of a dexel: a quick sufficient test.
//!
//! The swept solid is convex. If a plane through the point `p` has all of it on one side, and the dexel leaves the plane to that side, then
//! the tool meets the dexel beyond `p` alone, and cuts no material that ends there:
//!
//! ```text
//! n . p <= min over x in the tool of n . x  +  min(0, n . m),    n . d > 0
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

use nalgebra::{Point3, Unit, Vector3};

use super::swept::End;
use super::tool_solid::{Side, ToolSolid};

/// A tool on a straight move, for the test.
#[derive(Clone, Debug)]
pub(super) struct Apart {
    from: Point3<f64>,
    travel: Vector3<f64>,
    /// The move over the square of its length; zero of no move.
    per_travel: Vector3<f64>,
    axis: Vector3<f64>,
    k: usize,
    /// The lowest band: a corner, or nothing.
    corner: Option<RoundedDisc>,
    /// Height, radius and slope of the lower ends of flanks, and of the top.
    rims: Vec<Rim>,
    /// Cuts less deep than this are left out, m.
    skin: f64,
}

/// A disc across the axis, enlarged by a radius.
#[derive(Clone, Copy, Debug)]
struct RoundedDisc {
    disc: f64,
    height: f64,
    radius: f64,
    /// The corner ends here.
    ends: f64,
}

/// A circle around the axis.
#[derive(Clone, Copy, Debug)]
struct Rim {
    height: f64,
    radius: f64,
    /// Slope of the flank above it.
    slope: f64,
}

impl Apart {
    pub(super) fn new(tool: &ToolSolid, ends: [Point3<f64>; 2], axis: &Unit<Vector3<f64>>, k: usize) -> Apart {
        let travel = ends[1] - ends[0];
        let square = travel.norm_squared();
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
                    corner = Some(RoundedDisc {
                        disc: centre_radius,
                        height: centre_height,
                        radius,
                        ends: band.heights[1],
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
            from: ends[0],
            travel,
            per_travel: if square > 0.0 { travel / square } else { Vector3::zeros() },
            axis: axis.into_inner(),
            k,
            corner,
            rims,
            skin: 0.0,
        }
    }

    /// The same that leaves out cuts less deep than `skin`, m.
    pub(super) fn with_skin(self, skin: f64) -> Apart {
        Apart { skin, ..self }
    }

    /// Whether it is certain that the tool meets the dexel of this point above it only (`End::Low`: its lower end is above), or
    /// below it only.
    #[inline]
    pub(super) fn is_certain(&self, point: &Point3<f64>, end: End) -> bool {
        let sign = match end {
            End::Low => 1.0,
            End::High => -1.0,
        };
        let off = point - self.from;
        match self.corner {
            Some(corner) if corner.disc == 0.0 => self.ball(&corner, &off, sign),
            _ => self.any(&off, sign),
        }
    }

    /// Of a tool that ends in a ball.
    #[inline]
    fn ball(&self, ball: &RoundedDisc, off: &Vector3<f64>, sign: f64) -> bool {
        let from_centre = off - self.axis * ball.height;
        let t = from_centre.dot(&self.per_travel).clamp(0.0, 1.0);
        let normal = self.travel * t - from_centre;
        let up = normal.dot(&self.axis);
        let least = ball.radius - self.skin;
        let square = normal.norm_squared();
        if normal[self.k] * sign <= 0.0 || square < least * least {
            return false;
        }
        // What is above the ball is behind the plane, if that is not steeper than the flank.
        self.rims_are_behind(normal.norm_squared().sqrt(), up, ball.height * up - ball.radius * square.sqrt())
    }

    /// Whether the rims are not nearer along a normal with this length and part along the axis than `least`.
    #[inline]
    fn rims_are_behind(&self, length: f64, up: f64, least: f64) -> bool {
        let across = ((length - up) * (length + up)).max(0.0).sqrt();
        let behind = |rim: &Rim| rim.height * up - rim.radius * across >= least - 1e-12 * length;
        self.rims.iter().all(behind)
    }

    fn any(&self, off: &Vector3<f64>, sign: f64) -> bool {
        let t = off.dot(&self.per_travel).clamp(0.0, 1.0);
        let from_tip = off - self.travel * t;
        let height = from_tip.dot(&self.axis);
        let across = from_tip - self.axis * height;
        let rho = across.norm();
        let [out, up] = self.inwards(rho, height);
        let radial = if rho > 0.0 { across / rho } else { Vector3::zeros() };
        let normal = radial * out + self.axis * up;
        if normal[self.k] * sign <= 0.0 {
            return false;
        }
        let length = out.hypot(up);
        let mut least = match self.corner {
            Some(corner) => corner.height * up - corner.disc * out.abs() - corner.radius * length,
            None => f64::INFINITY,
        };
        for rim in &self.rims {
            least = least.min(rim.height * up - rim.radius * out.abs());
        }
        let travel = normal.dot(&self.travel);
        let place = out * rho + up * height + t * travel;
        place <= least + travel.min(0.0) + self.skin * length
    }

    /// The direction to the core of the tool: away from the axis, and along it.
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
