//! The motion that brings points of a body nearest to where they were measured: three or more pairs, in any frame.
//!
//! Least squares over all pairs; of three points the triangle must not be a line.

use nalgebra::{Matrix3, Point3, Vector3};

use super::error::FormError;
use super::plane::known;
use crate::frame::Isometry;
use crate::least_squares::superposed;

/// A motion, and what it leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Superposition {
    /// From the frame of the body to that of the measurement.
    pub motion: Isometry,
    /// Distance of each point from where it was measured, m.
    pub residuals: Vec<f64>,
}

/// Points on a line, relative to their length, do not determine a rotation.
const ON_LINE: f64 = 1e-6;

/// The motion from `body` to `measured`, m; pairs in the same order.
///
/// # Errors
/// Fewer than three pairs, lists of different lengths, values that are not finite, points on a line.
pub fn superposition(body: &[Point3<f64>], measured: &[Point3<f64>]) -> Result<Superposition, FormError> {
    known(body, 3)?;
    known(measured, 3)?;
    if body.len() != measured.len() {
        return Err(FormError::Lengths {
            needed: body.len(),
            given: measured.len(),
        });
    }
    for points in [body, measured] {
        let count = points.len() as f64;
        let middle: Vector3<f64> = points.iter().map(|point| point.coords).sum::<Vector3<f64>>() / count;
        let off = points.iter().map(|point| point.coords - middle);
        let spread: Matrix3<f64> = off.map(|off| off * off.transpose()).sum();
        let mut sizes = spread.symmetric_eigenvalues();
        sizes.as_mut_slice().sort_by(f64::total_cmp);
        if sizes[1] <= ON_LINE * ON_LINE * sizes[2] {
            return Err(FormError::Undetermined);
        }
    }
    let vectors = |points: &[Point3<f64>]| points.iter().map(|point| point.coords).collect::<Vec<_>>();
    let motion = superposed(&vectors(body), &vectors(measured), &vec![1.0; body.len()]);
    let pairs = body.iter().zip(measured);
    Ok(Superposition {
        residuals: pairs.map(|(from, to)| (motion * from - to).norm()).collect(),
        motion,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_points_give_the_motion_and_a_fourth_shows_its_error() {
        let motion = Isometry::new(Vector3::new(0.4, -1.0, 0.2), Vector3::new(0.3, -2.0, 0.7));
        let body = [
            [0.0, 0.0, 0.0],
            [0.2, 0.0, 0.0],
            [0.0, 0.1, 0.03],
            [0.1, 0.1, 0.0],
        ]
        .map(Point3::from);
        let mut measured = body.map(|point| motion * point);
        let found = superposition(&body[..3], &measured[..3]).unwrap();
        assert!((found.motion.to_homogeneous() - motion.to_homogeneous()).norm() < 1e-12);
        assert!(found.residuals.iter().all(|residual| *residual < 1e-12));
        measured[3].x += 1e-3;
        let found = superposition(&body, &measured).unwrap();
        assert!(found.residuals[3] > 2e-4 && found.residuals[3] < 1e-3);
    }

    #[test]
    fn points_on_a_line_and_lists_of_different_lengths_are_refused() {
        let line = [0.0, 0.1, 0.2].map(|x| Point3::new(x, 2.0 * x, 0.0));
        assert_eq!(superposition(&line, &line), Err(FormError::Undetermined));
        assert!(superposition(&line[..2], &line).is_err());
    }
}
