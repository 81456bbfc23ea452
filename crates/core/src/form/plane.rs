//! Planes: flatness, departure from a nominal plane, and the zone of orientation.
//!
//! ```text
//! LSPL  the least-squares plane; FLTt = max - min of the heights on it            (ISO 12781)
//! MZPL  the two parallel planes of least distance that contain all points          (ISO 1101, flatness)
//!       minimax of z - a - b x - c y, again about the plane found until b = c = 0
//! parallelism to a datum plane with the normal n       max - min of n p            (ISO 1101)
//! perpendicularity to it   the least distance of two planes that contain n
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `x`, `y`, `z` | coordinates in the plane, height on it | m |
//! | `n`, `p` | normal of the datum, point | -, m |
//!
//! Valid for a form error that is small against the feature. Features are planes without their edge: the caller selects
//! the points.

use nalgebra::{Point2, Point3, UnitVector3, Vector3};

use super::chebyshev::{ResidualSide, minimax};
use super::error::FormError;
use super::line::straightness;
use crate::roundness::Plane;

/// Below a nanometre the points are on a plane: the rest is rounding of coordinates, which has no optimum.
const NEGLIGIBLE: f64 = 1e-9;
/// Slopes below this do not change a width by more than rounding.
const LEVEL: f64 = 1e-9;
/// Steps until the slopes are zero: each squares them.
const MOST_ROUNDS: usize = 12;

/// Flatness of a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flatness {
    /// The least-squares plane, with the peak to valley about it (FLTt of LSPL).
    pub least_squares: Plane,
    /// Width of the minimum zone (ISO 1101), m.
    pub minimum_zone: f64,
    /// Normal of the minimum zone, of length 1, on the side of that of the least-squares plane.
    pub zone_normal: Vector3<f64>,
    /// A point in the middle of the zone, m.
    pub zone_middle: Point3<f64>,
}

/// Flatness of `points`, m.
///
/// # Errors
/// Fewer than three points, points on a line, values that are not finite.
pub fn flatness(points: &[Point3<f64>]) -> Result<Flatness, FormError> {
    let plane = least_squares_plane(points)?;
    if plane.flatness <= NEGLIGIBLE {
        return Ok(Flatness {
            least_squares: plane,
            minimum_zone: plane.flatness,
            zone_normal: plane.normal,
            zone_middle: plane.origin,
        });
    }
    let off: Vec<Vector3<f64>> = points.iter().map(|p| p - plane.origin).collect();
    let mut normal = plane.normal;
    let range = |normal: &Vector3<f64>| range(off.iter().map(|p| p.dot(normal)));
    let mut zone = (normal, range(&normal));
    for _ in 0..MOST_ROUNDS {
        let x = (plane.x - normal * plane.x.dot(&normal)).normalize();
        let y = normal.cross(&x);
        let rows: Vec<[f64; 3]> = off.iter().map(|p| [1.0, p.dot(&x), p.dot(&y)]).collect();
        let heights: Vec<f64> = off.iter().map(|p| p.dot(&normal)).collect();
        let [_, b, c] = minimax(&rows, &heights, ResidualSide::Both)?.unknowns;
        normal = (normal - x * b - y * c).normalize();
        let found = range(&normal);
        if found[1] - found[0] < zone.1[1] - zone.1[0] {
            zone = (normal, found);
        }
        if b.abs().max(c.abs()) < LEVEL {
            break;
        }
    }
    let (zone_normal, [low, high]) = zone;
    Ok(Flatness {
        least_squares: plane,
        minimum_zone: high - low,
        zone_normal,
        zone_middle: plane.origin + zone_normal * (0.5 * (low + high)),
    })
}

/// The least-squares plane (LSPL) of `points`, m.
///
/// # Errors
/// Fewer than three points, points on a line, values that are not finite.
pub fn least_squares_plane(points: &[Point3<f64>]) -> Result<Plane, FormError> {
    known(points, 3)?;
    Plane::nearest(points).ok_or(FormError::Undetermined)
}

/// A measured plane relative to its nominal one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneDeparture {
    /// Distance of the mean of the points from the nominal plane along its normal, m: above 0 outside of the part.
    pub offset: f64,
    /// Rotation vector from the nominal normal to the measured one, rad: across the normal.
    pub tilt: Vector3<f64>,
}

/// Departure of a measured plane from the nominal one through `at` with the outer `normal`.
pub fn departure(measured: &Plane, at: &Point3<f64>, normal: &UnitVector3<f64>) -> PlaneDeparture {
    let own = measured.normal * measured.normal.dot(normal).signum();
    let across = normal.cross(&own);
    let sine = across.norm();
    let angle = sine.atan2(normal.dot(&own));
    PlaneDeparture {
        offset: (measured.origin - at).dot(normal),
        tilt: if sine > 0.0 {
            across * (angle / sine)
        } else {
            across
        },
    }
}

/// Parallelism of a plane's points to a datum plane with this normal, m: the width of the zone across it.
///
/// # Errors
/// No points, or values that are not finite.
pub fn parallelism(points: &[Point3<f64>], datum_normal: &UnitVector3<f64>) -> Result<f64, FormError> {
    known(points, 1)?;
    // About the first point: rounding is then that of the feature.
    let [low, high] = range(points.iter().map(|p| (p - points[0]).dot(datum_normal)));
    Ok(high - low)
}

/// Perpendicularity of a plane's points to a datum plane with this normal, m: the least width between two planes across
/// the datum.
///
/// # Errors
/// Fewer than three points, points on a line along the normal, values that are not finite.
pub fn perpendicularity(points: &[Point3<f64>], datum_normal: &UnitVector3<f64>) -> Result<f64, FormError> {
    known(points, 3)?;
    let x = Vector3::ith(datum_normal.iamin(), 1.0);
    let x = (x - datum_normal.as_ref() * x.dot(datum_normal)).normalize();
    let y = datum_normal.cross(&x);
    let seen = |p: &Point3<f64>| Point2::new((p - points[0]).dot(&x), (p - points[0]).dot(&y));
    let section: Vec<Point2<f64>> = points.iter().map(seen).collect();
    Ok(straightness(&section)?.minimum_zone)
}

/// Checks number and values of points.
pub(super) fn known(points: &[Point3<f64>], needed: usize) -> Result<(), FormError> {
    // Not `>`: NaN is refused too.
    let is_known = |p: &Point3<f64>| p.coords.iter().all(|x| x.abs() <= 1e6);
    match points.iter().position(|p| !is_known(p)) {
        Some(index) => Err(FormError::NotFinite { index }),
        None if points.len() < needed => Err(FormError::TooFew {
            needed,
            given: points.len(),
        }),
        None => Ok(()),
    }
}

/// The least and the largest of these values.
pub(super) fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

#[cfg(test)]
mod tests;
