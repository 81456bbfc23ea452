//! The displacement and rotation of a rigid body between two sets of points.
//!
//! Source: W. Kabsch, A solution for the best rotation to relate two sets of vectors, Acta Cryst. A32, 1976.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::frame::Isometry;

/// The displacement and rotation that brings `from` nearest to `to`, by weighted least squares.
pub(crate) fn superposed(from: &[Vector3<f64>], to: &[Vector3<f64>], weights: &[f64]) -> Isometry {
    let whole: f64 = weights.iter().sum();
    let mean = |points: &[Vector3<f64>]| {
        let sum: Vector3<f64> = points
            .iter()
            .zip(weights)
            .map(|(point, weight)| point * *weight)
            .sum();
        sum / whole
    };
    let (here, there) = (mean(from), mean(to));
    let mut spread = Matrix3::zeros();
    for ((from, to), weight) in from.iter().zip(to).zip(weights) {
        spread += (to - there) * (from - here).transpose() * *weight;
    }
    let parts = spread.svd(true, true);
    let turn = match (parts.u, parts.v_t) {
        (Some(u), Some(v_t)) => {
            let side = (u * v_t).determinant().signum();
            u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, side)) * v_t
        }
        _ => Matrix3::identity(),
    };
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
    Isometry::from_parts((there - turn * here).into(), turn)
}
