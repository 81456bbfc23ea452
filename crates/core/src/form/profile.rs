//! Profile of a surface (ISO 1101) from deviations along the normal of the nominal surface.
//!
//! ```text
//! fixed nominal      t = 2 max |d|                                the zone is centred on the nominal surface
//! with its datum     d less the rigid motion with the least max |d|   (six unknowns, minimax)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `d` | deviation along the outer normal | m |
//! | `t` | width of the zone | m |
//!
//! A small motion, displacement `u` and rotation `w` about the mean of the points `c`, changes `d` by
//! `n (u + w x (p - c))`. Directions in which the surface can move along itself (a plane: two displacements and one rotation)
//! are left out by the caller's choice of the unknowns: [`MotionFreedom`].

use nalgebra::{Point3, Vector3};

use super::chebyshev::{ResidualSide, minimax};
use super::error::FormError;
use super::plane::known;

/// A deviation at a point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalDeviation {
    /// Nominal point, m.
    pub at: Point3<f64>,
    /// Outer normal, of length 1.
    pub normal: Vector3<f64>,
    /// Deviation along the normal, m.
    pub deviation: f64,
}

/// Which motions are removed before the width is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionFreedom {
    /// A displacement along the mean normal and two rotations across it: of a nearly plane surface.
    Plane,
    /// All six: of a surface that determines them.
    Rigid,
}

/// Width of the zone, and its extremes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceProfile {
    /// Width of the zone about the nominal surface, m.
    pub width: f64,
    /// Least deviation, m.
    pub least: f64,
    /// Largest deviation, m.
    pub largest: f64,
}

/// Profile of a surface with the nominal surface fixed.
///
/// # Errors
/// No deviations, or one that is not finite.
pub fn surface_profile(deviations: &[f64]) -> Result<SurfaceProfile, FormError> {
    if let Some(index) = deviations.iter().position(|d| !d.is_finite()) {
        return Err(FormError::NotFinite { index });
    }
    if deviations.is_empty() {
        return Err(FormError::TooFew { needed: 1, given: 0 });
    }
    let [least, largest] = super::plane::range(deviations.iter().copied());
    Ok(SurfaceProfile {
        width: 2.0 * largest.max(-least),
        least,
        largest,
    })
}

/// Profile of a surface after the best rigid motion: no other motion gives a narrower zone, to first order.
///
/// # Errors
/// Too few points, values that are not finite, a surface that does not determine the motion.
pub fn fitted_surface_profile(
    points: &[NormalDeviation],
    freedom: MotionFreedom,
) -> Result<SurfaceProfile, FormError> {
    let places: Vec<Point3<f64>> = points.iter().map(|point| point.at).collect();
    known(&places, 3)?;
    let count = points.len() as f64;
    let centre: Vector3<f64> = places.iter().map(|p| p.coords).sum::<Vector3<f64>>() / count;
    let scale = places
        .iter()
        .map(|p| (p.coords - centre).norm())
        .fold(0.0, f64::max);
    let right: Vec<f64> = points.iter().map(|point| point.deviation).collect();
    let fitted = match freedom {
        MotionFreedom::Rigid => {
            let row = |point: &NormalDeviation| {
                let turns = (point.at.coords - centre).cross(&point.normal) / scale;
                let n = &point.normal;
                [n.x, n.y, n.z, turns.x, turns.y, turns.z]
            };
            left(&points.iter().map(row).collect::<Vec<_>>(), &right)?
        }
        MotionFreedom::Plane => {
            let normal: Vector3<f64> = points.iter().map(|point| point.normal).sum();
            let normal = normal.try_normalize(0.0).ok_or(FormError::Undetermined)?;
            let x = Vector3::ith(normal.iamin(), 1.0);
            let x = (x - normal * x.dot(&normal)).normalize();
            let y = normal.cross(&x);
            let row = |point: &NormalDeviation| {
                let turns = (point.at.coords - centre).cross(&point.normal) / scale;
                [point.normal.dot(&normal), turns.dot(&x), turns.dot(&y)]
            };
            left(&points.iter().map(row).collect::<Vec<_>>(), &right)?
        }
    };
    surface_profile(&fitted)
}

/// What the best unknowns leave.
fn left<const M: usize>(rows: &[[f64; M]], right: &[f64]) -> Result<Vec<f64>, FormError> {
    let found = minimax(rows, right, ResidualSide::Both)?;
    let residual = |(row, right): (&[f64; M], &f64)| {
        row.iter()
            .zip(&found.unknowns)
            .fold(*right, |left, (a, x)| left - a * x)
    };
    Ok(rows.iter().zip(right).map(residual).collect())
}

#[cfg(test)]
mod tests;
