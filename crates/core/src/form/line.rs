//! Straightness of a section (ISO 12780): heights over the position along a line.
//!
//! ```text
//! LSLI  z = a + b t with the least sum of squares; STRt = cos(atan b) (max - min of z - a - b t)
//! MZLI  the two parallel lines of least distance that contain all points: minimax of z - a - b t
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `t`, `z` | position along the line, height across it | m |
//!
//! The zone is measured across the lines; slopes are found again about the line of the step before until they are zero.
//! Valid for heights that are small against the length.

use nalgebra::{Point2, Vector2};

use super::chebyshev::{ResidualSide, minimax};
use super::error::FormError;

/// Slopes below this do not change a width by more than rounding.
const LEVEL: f64 = 1e-9;
/// Steps until the slope is zero: each squares it.
const MOST_ROUNDS: usize = 12;

/// Straightness of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Straightness {
    /// Direction of the least-squares line, of length 1.
    pub direction: Vector2<f64>,
    /// Peak to valley about the least-squares line (LSLI), m.
    pub least_squares: f64,
    /// Width of the minimum zone (MZLI), m.
    pub minimum_zone: f64,
}

/// Straightness of points (position along the line, height; m).
///
/// # Errors
/// Fewer than three points, values that are not finite, all points at one position.
pub fn straightness(points: &[Point2<f64>]) -> Result<Straightness, FormError> {
    if points.len() < 3 {
        return Err(FormError::TooFew {
            needed: 3,
            given: points.len(),
        });
    }
    if let Some(index) = points
        .iter()
        .position(|p| !p.coords.iter().all(|x| x.is_finite()))
    {
        return Err(FormError::NotFinite { index });
    }
    let mean: Vector2<f64> = points.iter().map(|p| p.coords).sum::<Vector2<f64>>() / points.len() as f64;
    let off: Vec<Vector2<f64>> = points.iter().map(|p| p.coords - mean).collect();
    let spread: nalgebra::Matrix2<f64> = off.iter().map(|p| p * p.transpose()).sum();
    let eigen = spread.symmetric_eigen();
    let most = eigen.eigenvalues.imax();
    // Below this the spread along the line is not determined.
    if eigen.eigenvalues[1 - most] > 0.99 * eigen.eigenvalues[most] {
        return Err(FormError::Undetermined);
    }
    let direction = eigen.eigenvectors.column(most).into_owned();
    let direction = direction * direction[direction.iamax()].signum();
    let across = |direction: &Vector2<f64>| Vector2::new(-direction.y, direction.x);
    let width = |normal: &Vector2<f64>| {
        let heights = off.iter().map(|p| p.dot(normal));
        let [low, high] = heights.fold([f64::MAX, f64::MIN], |[low, high], h| [low.min(h), high.max(h)]);
        high - low
    };
    let least_squares = width(&across(&direction));
    let (mut along, mut minimum_zone) = (direction, least_squares);
    for _ in 0..MOST_ROUNDS {
        let normal = across(&along);
        let rows: Vec<[f64; 2]> = off.iter().map(|p| [1.0, p.dot(&along)]).collect();
        let heights: Vec<f64> = off.iter().map(|p| p.dot(&normal)).collect();
        let found = minimax(&rows, &heights, ResidualSide::Both)?;
        let slope = found.unknowns[1];
        along = (along + normal * slope).normalize();
        minimum_zone = minimum_zone.min(width(&across(&along)));
        if slope.abs() < LEVEL {
            break;
        }
    }
    Ok(Straightness {
        direction,
        least_squares,
        minimum_zone,
    })
}

#[cfg(test)]
mod tests;
