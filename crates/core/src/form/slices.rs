//! Roundness of slices of a cylinder: minimum zone, least squares, inscribed and circumscribed circle at heights along the axis.
//!
//! Points within half the thickness of a slice are projected along the axis of the given cylinder. The circles are those of
//! [`crate::roundness`]; a tilt of the axis by `t` changes a slice of thickness `h` by `t h` only.

use nalgebra::{Point2, Point3};

use super::cylinder::Cylinder;
use super::error::FormError;
use super::plane::known;
use crate::roundness::{Profile, ReferenceCircle, RoundnessError, Zone};

/// Roundness of a slice.
#[derive(Clone, Debug, PartialEq)]
pub struct SliceRoundness {
    /// Height along the axis from the point of the cylinder, m.
    pub height: f64,
    /// Number of points.
    pub points: usize,
    /// The least-squares circle, about the axis of the cylinder (LSCI).
    pub least_squares: ReferenceCircle,
    /// The minimum zone (MZCI), or why there is none.
    pub minimum_zone: Result<Zone, RoundnessError>,
    /// The largest inscribed circle (MICI), or why there is none.
    pub inscribed: Result<ReferenceCircle, RoundnessError>,
    /// The smallest circumscribed circle (MCCI).
    pub circumscribed: ReferenceCircle,
}

/// Roundness at each of these heights, m; `None` where the points of a slice have no circle.
///
/// # Errors
/// No points, or points that are not finite; a thickness that is not above 0.
pub fn slice_roundness(
    points: &[Point3<f64>],
    cylinder: &Cylinder,
    heights: &[f64],
    thickness: f64,
) -> Result<Vec<Option<SliceRoundness>>, FormError> {
    known(points, 1)?;
    if !(thickness > 0.0 && thickness.is_finite()) {
        return Err(FormError::Length { value: thickness });
    }
    let [x, y] = cylinder.directions();
    let along = |p: &Point3<f64>| (p - cylinder.at).dot(&cylinder.axis);
    let seen = |p: &Point3<f64>| Point2::new((p - cylinder.at).dot(&x), (p - cylinder.at).dot(&y));
    let of = |height: &f64| {
        let inside = points
            .iter()
            .filter(|p| (along(p) - height).abs() <= 0.5 * thickness);
        let profile = Profile::new(inside.map(seen).collect()).ok()?;
        Some(SliceRoundness {
            height: *height,
            points: profile.points().len(),
            least_squares: profile.least_squares(),
            minimum_zone: profile.minimum_zone(),
            inscribed: profile.maximum_inscribed(),
            circumscribed: profile.minimum_circumscribed(),
        })
    };
    Ok(heights.iter().map(of).collect())
}

#[cfg(test)]
mod tests;
