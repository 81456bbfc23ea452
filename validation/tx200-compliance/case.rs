//! Staubli TX200 against a published compliance matrix. See README.md.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Matrix3, Vector3};

use armill_core::compliance::compliance_at_tool;
use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::{Posture, Robot};

use crate::arms;
use crate::check::{Check, Gap, worst_difference};

const PUBLISHED: &str = "rafisondi/sensitivity_milling_analysis";
const COMPUTED: &str = "independent computation";

/// Springs of the older identification, joints 4 to 6 rigid, N m/rad.
pub const OLDER_SPRINGS: [f64; 6] = [
    1.15e6,
    3.76e6,
    1.29e6,
    f64::INFINITY,
    f64::INFINITY,
    f64::INFINITY,
];
/// Springs about the drive axes of Huynh et al., N m/rad.
const DRIVE_SPRINGS: [f64; 6] = [2.3e6, 8.6e6, 2.8e6, 3.0e6, 0.2e6, 0.9e6];

const TCP: [f64; 3] = [-0.025, -1.6224, 0.4857];
const JOINTS_DEG: [f64; 6] = [-91.2017, 26.2433, 113.0264, -2.0609, -34.2838, 1.3920];
/// Translational compliance at the TCP in the workpiece frame, um/N.
pub const COMPLIANCE_IN_PART: Matrix3<f64> =
    Matrix3::new(0.795, 0.019, 0.801, 0.019, 2.289, -0.017, 0.801, -0.017, 1.204);

const SECOND_JOINTS_DEG: [f64; 6] = [-90.0, 30.0, 95.0, 0.0, 0.0, 0.0];
const SECOND_TCP: [f64; 3] = [0.0, -1.647_400_025_592_229_6, 0.480_698_121_343_784_3];
/// Translational compliance there in base, um/N.
const SECOND_COMPLIANCE: Matrix3<f64> =
    Matrix3::new(1.2908, 0.0, 0.0, 0.0, 1.7278, -1.0517, 0.0, -1.0517, 0.8876);

pub fn checks() -> Vec<Check> {
    let robot = arms::tx200(OLDER_SPRINGS);
    let posture = posture(&robot);
    let found_deg: Vec<f64> = posture.joints.iter().map(|q| q.to_degrees()).collect();
    let joints = worst_difference(&found_deg, &JOINTS_DEG);
    let matrix = worst_difference(
        compliance_in_part(&robot, &posture).as_slice(),
        COMPLIANCE_IN_PART.as_slice(),
    );

    let robot = arms::tx200(DRIVE_SPRINGS);
    let second = posture_at(
        &robot,
        &SECOND_JOINTS_DEG.map(f64::to_radians),
        &flange_from_tool(),
    );
    let tcp = worst_difference(second.base_from_tool.translation.vector.as_slice(), &SECOND_TCP);
    let second_matrix = worst_difference(
        translational(&robot, &second).as_slice(),
        SECOND_COMPLIANCE.as_slice(),
    );
    vec![
        // Half of the last printed digit, here and below.
        Check::printed(
            "joints that hold the published TCP pose, among the postures of the closed form",
            COMPUTED,
            Gap {
                worst: joints,
                tolerance: 5e-5,
                unit: "deg",
            },
            6,
        ),
        Check::printed(
            "translational compliance in the workpiece frame, 9 numbers",
            PUBLISHED,
            Gap {
                worst: matrix,
                tolerance: 5e-4,
                unit: "um/N",
            },
            5,
        ),
        Check::computed(
            "TCP at (-90, 30, 95, 0, 0, 0) deg",
            PUBLISHED,
            Gap {
                worst: tcp,
                tolerance: 1e-14,
                unit: "m",
            },
        ),
        Check::printed(
            "translational compliance there, six drive springs, 9 numbers",
            COMPUTED,
            Gap {
                worst: second_matrix,
                tolerance: 5e-5,
                unit: "um/N",
            },
            6,
        ),
    ]
}

/// The posture that holds the published TCP pose in the branch of the printed joints.
pub fn posture(robot: &Robot) -> Posture {
    let orientation = workpiece() * from_xyz_and_fixed_angles(Vector3::zeros(), Vector3::new(PI, 0.0, PI));
    let base_from_tool = Isometry::from_parts(TCP.into(), orientation.rotation);
    let tool = ToolAt {
        flange_from_tool: &flange_from_tool(),
        near: None,
        home: None,
    };
    let found = postures(robot, &base_from_tool, tool).expect("the pose lies in reach");
    let away = |posture: &Posture| {
        let joints_deg: Vec<f64> = posture.joints.iter().map(|q| q.to_degrees()).collect();
        worst_difference(&joints_deg, &JOINTS_DEG)
    };
    found
        .into_iter()
        .min_by(|a, b| away(a).total_cmp(&away(b)))
        .expect("there is at least one posture")
}

/// Translational compliance at the TCP in the workpiece frame, um/N.
pub fn compliance_in_part(robot: &Robot, posture: &Posture) -> Matrix3<f64> {
    let base_from_part = workpiece().rotation.to_rotation_matrix().into_inner();
    base_from_part.transpose() * translational(robot, posture) * base_from_part
}

/// The workpiece frame in base: `Rz(-90 deg)`.
pub fn workpiece() -> Isometry {
    from_xyz_and_fixed_angles(Vector3::zeros(), Vector3::new(0.0, 0.0, -FRAC_PI_2))
}

fn flange_from_tool() -> Isometry {
    from_xyz_and_fixed_angles(
        Vector3::new(0.277, 0.0, 0.326),
        Vector3::new(0.0, 1.308_996_9, 0.0),
    )
}

/// Translational compliance at the TCP in base, um/N.
fn translational(robot: &Robot, posture: &Posture) -> Matrix3<f64> {
    let joints = robot.compliance().expect("the arm was made with springs");
    compliance_at_tool(&posture.screws, joints).fixed_view::<3, 3>(0, 0) * 1e6
}

#[cfg(test)]
mod tests {
    #[test]
    fn tx200_compliance_holds() {
        crate::check::assert_all_hold(&super::checks());
    }
}
