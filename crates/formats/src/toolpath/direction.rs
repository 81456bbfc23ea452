//! Limits that the readers of tool paths share: how large a number may be, and what is a direction.

use armill_core::nalgebra::{Unit, Vector3};

/// No number of a program is larger, in its own units: coordinates in mm beyond it have lost the micrometre.
pub(super) const LARGEST: f64 = 1e9;
/// A direction has a length of 1 within this: three decimals.
const UNIT_SLACK: f64 = 2e-3;

/// The direction of three numbers.
///
/// What is within the slack is brought to length 1.
///
/// # Errors
/// The length of what is none.
pub(super) fn direction(ijk: [f64; 3]) -> Result<Unit<Vector3<f64>>, f64> {
    let vector = Vector3::from(ijk);
    let length = vector.norm();
    match (length - 1.0).abs() <= UNIT_SLACK {
        true => Ok(Unit::new_normalize(vector)),
        false => Err(length),
    }
}
