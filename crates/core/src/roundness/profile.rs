//! Points of a profile, and their four reference circles.
//!
//! Internally, all coordinates are relative to the centre of the least-squares circle in units of its radius: rounding
//! is then the same for a part of any size and position.

use nalgebra::{Point2, Vector2};

use super::least_squares::{ReferenceCircle, least_squares};
use super::polar::Polar;
use super::zone::Zone;
use super::{RoundnessError, circumscribed, inscribed, zone};

/// Points of a profile, at least three of them not on a line.
#[derive(Clone, Debug)]
pub struct Profile {
    points: Vec<Point2<f64>>,
    least_squares: ReferenceCircle,
    /// From the centre of the least-squares circle, in its radii.
    scaled: Vec<Vector2<f64>>,
}

/// Largest coordinate, m.
const FARTHEST: f64 = 1e6;

impl Profile {
    /// The profile through `points` (m), in any order.
    ///
    /// # Errors
    /// A coordinate that is not finite; no circle that is nearest to the points.
    pub fn new(points: Vec<Point2<f64>>) -> Result<Profile, RoundnessError> {
        // Not `>`: NaN is refused too.
        let is_known = |p: &Point2<f64>| p.coords.amax() <= FARTHEST && !p.x.is_nan() && !p.y.is_nan();
        if let Some(index) = points.iter().position(|p| !is_known(p)) {
            return Err(RoundnessError::NotFinite { index });
        }
        let least_squares = least_squares(&points).ok_or(RoundnessError::NoCircle)?;
        let scale = |p: &Point2<f64>| (p - least_squares.centre) / least_squares.radius;
        let scaled: Vec<Vector2<f64>> = points.iter().map(scale).collect();
        if !scaled.iter().all(|p| p.x.is_finite() && p.y.is_finite()) {
            return Err(RoundnessError::NoCircle);
        }
        Ok(Profile {
            points,
            least_squares,
            scaled,
        })
    }

    /// The points given, m.
    pub fn points(&self) -> &[Point2<f64>] {
        &self.points
    }

    /// The least-squares circle (LSCI).
    pub fn least_squares(&self) -> ReferenceCircle {
        self.least_squares
    }

    /// The narrowest ring between two concentric circles that contains all points (MZCI): no ring is narrower by
    /// more than 1e-14 of the radius. Where several are equally narrow, one of them.
    ///
    /// # Errors
    /// An arc so short for its form error that lines are better than circles, or that no centre can be proven.
    pub fn minimum_zone(&self) -> Result<Zone, RoundnessError> {
        let found = zone::minimum_zone(&self.scaled)?;
        Ok(Zone {
            centre: self.place(found.centre.coords),
            inner: found.inner * self.least_squares.radius,
            outer: found.outer * self.least_squares.radius,
        })
    }

    /// The smallest circle that encloses all points (MCCI).
    pub fn minimum_circumscribed(&self) -> ReferenceCircle {
        let (centre, [inner, outer]) = circumscribed::minimum_circumscribed(&self.scaled);
        self.circle(centre, outer, outer - inner)
    }

    /// The largest circle that contains no point, about a centre within the profile (MICI): none is larger by more than
    /// 1e-14 of the radius.
    ///
    /// # Errors
    /// Points that leave half a turn open, so that there is no such circle, or that touch it on one side only.
    pub fn maximum_inscribed(&self) -> Result<ReferenceCircle, RoundnessError> {
        let gap_deg = self.polar().gap.width.to_degrees();
        if gap_deg >= inscribed::WIDEST_GAP_DEG {
            return Err(RoundnessError::Open {
                gap_deg,
                most_deg: inscribed::WIDEST_GAP_DEG,
            });
        }
        let (centre, [inner, outer]) = inscribed::maximum_inscribed(&self.scaled)?;
        Ok(self.circle(centre, inner, outer - inner))
    }

    /// Angles and deviations about the least-squares circle.
    pub fn polar(&self) -> Polar {
        Polar::about(&self.points, &self.least_squares)
    }

    fn place(&self, centre: Vector2<f64>) -> Point2<f64> {
        self.least_squares.centre + centre * self.least_squares.radius
    }

    fn circle(&self, centre: Vector2<f64>, radius: f64, peak_to_valley: f64) -> ReferenceCircle {
        ReferenceCircle {
            centre: self.place(centre),
            radius: radius * self.least_squares.radius,
            peak_to_valley: peak_to_valley * self.least_squares.radius,
        }
    }
}
