//! The angle between two orientations.

use armill_core::nalgebra::UnitQuaternion;

/// The angle between two orientations, rad; accurate to rounding if it is small.
pub(super) fn angle(one: &UnitQuaternion<f64>, other: &UnitQuaternion<f64>) -> f64 {
    let between = one.inverse() * other;
    2.0 * between.vector().norm().atan2(between.scalar().abs())
}
