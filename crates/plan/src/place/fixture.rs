//! The plane of a part in a fixture.

use armill_core::frame::from_xyz_and_fixed_angles;
use armill_core::nalgebra::Vector3;
use armill_core::units::{from_deg, from_mm};
use armill_core::workpiece::Plane;
use armill_study::file::placement::FixtureTable;
use armill_study::input::setting::Setting;

/// The plane in this fixture, base, and its tilt if it is given by one.
pub(super) fn plane_of(fixture: &FixtureTable, setting: &Setting) -> (Plane, Option<f64>) {
    let centre = from_mm(Vector3::from(fixture.centre_mm));
    let reference_from_part = match fixture.rotation_deg {
        Some(angles) => from_xyz_and_fixed_angles(centre, Vector3::from(angles).map(from_deg)),
        None => {
            let tilt = from_deg(fixture.tilt_deg.unwrap_or(0.0));
            Plane::tilted(centre.into(), tilt).base_from_part
        }
    };
    let plane = Plane {
        base_from_part: setting.base_from_reference * reference_from_part,
    };
    let tilt = fixture
        .rotation_deg
        .is_none()
        .then(|| from_deg(fixture.tilt_deg.unwrap_or(0.0)));
    (plane, tilt)
}
