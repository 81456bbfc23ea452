//! MH12 at one point: posture, compliance, zero position, reach. See README.md.
//!
//! One posture that can be checked manually: the arm is in the plane y = 0, so that links and lever arms can be added
//! as in README.md.

use nalgebra::{Matrix3, Point3, Vector3};

use armill_core::compliance::compliance_at_tool;
use armill_core::frame::{Isometry, tool_orientation};
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::{Posture, Robot, Unreachable};

use crate::arms;
use crate::check::{Check, ErrorBound, worst_difference};

const REFERENCE: &str = "independent computation";

/// Tip (m) of the bare flange, tool along base +x.
const TIP: Point3<f64> = Point3::new(1.0, 0.0, 0.8);
/// The posture there, deg: S, L, U, R, B, T.
const JOINTS_DEG: [f64; 6] = [0.0, 11.5959, -27.7845, 0.0, 39.3804, 0.0];
/// Translational compliance there, um/N.
const COMPLIANCE: Matrix3<f64> = Matrix3::new(2.8357, 0.0, 6.5188, 0.0, 2.3415, 0.0, 6.5188, 0.0, 23.2123);
/// Flange in base with all joints at zero.
const FLANGE_AT_ZERO_MM: [f64; 3] = [895.0, 0.0, 1264.0];
/// How far the wrist centre comes from the first axis at the height of the shoulder.
const REACH_MM: f64 = 1439.5;

/// Chain, compliance and deviation at one posture against those computed before.
pub fn checks() -> Vec<Check> {
    let robot = arms::mh12();
    let posture = nearest_to_printed(&robot);
    let found_deg: Vec<f64> = posture.joints.iter().map(|q| q.to_degrees()).collect();
    let compliance = compliance_at_tool(&posture.screws, robot.compliance().expect("the library gives it"));
    let found = compliance.fixed_view::<3, 3>(0, 0) * 1e6;
    let at_zero = posture_at(&robot, &[0.0; 6], &Isometry::identity())
        .base_from_tool
        .translation
        .vector
        * 1e3;
    let joints = worst_difference(&found_deg, &JOINTS_DEG);
    let matrix = worst_difference(found.as_slice(), COMPLIANCE.as_slice());
    let reach_mm = reach(&robot) * 1e3;
    vec![
        // Half of the last printed digit, here and below.
        Check::printed(
            "MH12 joints at (1, 0, 0.8) m, tool along +x, front elbow-up",
            REFERENCE,
            ErrorBound {
                worst: joints,
                tolerance: 5e-5,
                unit: "deg",
            },
            6,
        ),
        Check::printed(
            "translational compliance there, 9 numbers",
            REFERENCE,
            ErrorBound {
                worst: matrix,
                tolerance: 5e-5,
                unit: "um/N",
            },
            6,
        ),
        Check::computed(
            "flange at joint zero",
            "URDF of ROS-Industrial, added manually",
            ErrorBound {
                worst: worst_difference(at_zero.as_slice(), &FLANGE_AT_ZERO_MM),
                tolerance: 1e-12,
                unit: "mm",
            },
        ),
        Check::printed(
            "reach of the wrist centre",
            "lengths of the URDF, added manually",
            ErrorBound {
                worst: (reach_mm - REACH_MM).abs(),
                tolerance: 0.05,
                unit: "mm",
            },
            3,
        ),
    ]
}

/// The posture of the front elbow-up branch whose joint 6 is at zero.
fn nearest_to_printed(robot: &Robot) -> Posture {
    // At joint zero the flange's second axis points along base -y: half a turn from spin zero.
    let orientation = tool_orientation(Vector3::x_axis(), std::f64::consts::PI);
    let base_from_tool = Isometry::from_parts(TIP.into(), orientation);
    let tool = ToolAt {
        flange_from_tool: &Isometry::identity(),
        near: None,
        home: None,
    };
    let found = postures(robot, &base_from_tool, tool).expect("the point is in reach");
    let away = |posture: &Posture| {
        let joints_deg: Vec<f64> = posture.joints.iter().map(|q| q.to_degrees()).collect();
        worst_difference(&joints_deg, &JOINTS_DEG)
    };
    found
        .into_iter()
        .min_by(|a, b| away(a).total_cmp(&away(b)))
        .expect("there is at least one posture")
}

/// How far (m) the wrist centre comes from the first axis at shoulder height.
fn reach(robot: &Robot) -> f64 {
    // A pose far out: the wrist centre is 0.1 m behind the flange.
    let far = Isometry::from_parts(
        Point3::new(5.1, 0.0, 0.450).into(),
        tool_orientation(Vector3::x_axis(), 0.0),
    );
    let tool = ToolAt {
        flange_from_tool: &Isometry::identity(),
        near: None,
        home: None,
    };
    match postures(robot, &far, tool) {
        Err(Unreachable::TooFar { by }) => 5.0 - by,
        _ => f64::NAN,
    }
}
