//! A pose measured at standstill.

use nalgebra::{UnitQuaternion, Vector3};

/// Joint positions and the measured point.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredPose {
    /// Controller coordinates, rad or m.
    pub joints: Vec<f64>,
    /// The point, m, in the axes of the tracker.
    pub position: Vector3<f64>,
    /// `tracker_from_point`: rotation of the measured body, if it was measured.
    pub rotation: Option<UnitQuaternion<f64>>,
}

impl MeasuredPose {
    /// Whether all its numbers are finite.
    pub(super) fn is_finite(&self) -> bool {
        let turned = self
            .rotation
            .is_none_or(|rotation| rotation.coords.iter().all(|part| part.is_finite()));
        turned
            && self
                .position
                .iter()
                .chain(&self.joints)
                .all(|number| number.is_finite())
    }
}
