//! Modes of a Staubli TX200 against published frequencies. See README.md.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `f` | frequencies of the three modes, rising | Hz |
//! | `G(0)` | receptance at rest: translational compliance at the TCP, workpiece frame | um/N |
//!
//! Chain, springs, pose and workpiece frame are those of the case `tx200-compliance`.

use nalgebra::Matrix3;

use armill_core::dynamics::{Mode, receptance};
use armill_core::frame::Isometry;
use armill_core::robot::{Attachment, Mass, Structure};
use armill_core::source::{Arm, ArmState, StiffnessModel};

use crate::arms;
use crate::check::{Check, ErrorBound, worst_difference};
use crate::tx200_compliance::{COMPLIANCE_IN_PART, OLDER_SPRINGS, flange_from_tool, posture, workpiece};

const PUBLISHED: &str = "rafisondi/sensitivity_milling_analysis";

/// The published modes, Hz.
const MODES_HZ: [f64; 3] = [8.77, 14.82, 23.14];

/// A body: where it is, mass (kg), centre (m), and Ixx, Ixy, Ixz, Iyy, Iyz, Izz about the centre (kg m^2) in the axes of the attachment.
type Body = (Attachment, f64, [f64; 3], [f64; 6]);

/// Links 1 to 6, the box for data acquisition on link 4, and the spindle on the flange.
const BODIES: [Body; 8] = [
    (
        Attachment::Joint(0),
        364.0,
        [0.15, -0.008, 0.209],
        [12.248, -0.204, 1.552, 17.833, 0.25, 16.95],
    ),
    (
        Attachment::Joint(1),
        256.1,
        [0.401, 0.007, 0.139],
        [6.574, 0.178, 0.741, 36.584, 0.054, 39.916],
    ),
    (
        Attachment::Joint(2),
        98.7,
        [0.039, 0.043, -0.219],
        [0.569, 0.073, -0.018, 0.462, -0.025, 0.512],
    ),
    (
        Attachment::Joint(3),
        40.8,
        [0.0, 0.004, 0.266],
        [1.23, 0.001, 0.0, 1.172, 0.062, 0.299],
    ),
    (
        Attachment::Joint(3),
        5.4,
        [-0.141, -0.054, 0.285],
        [0.078, 0.002, 0.0, 0.024, 0.005, 0.058],
    ),
    (
        Attachment::Joint(4),
        13.6,
        [0.0, -0.067, 0.0],
        [0.026, 0.0, 0.0, 0.016, 0.0, 0.026],
    ),
    (
        Attachment::Joint(5),
        0.6,
        [0.0, 0.0, 0.005],
        [0.0005, 0.0, 0.0, 0.0005, 0.0, 0.001],
    ),
    (
        Attachment::Flange,
        61.4,
        [-0.048, -0.001, 0.173],
        [1.342, 0.002, 0.016, 1.622, 0.018, 0.548],
    ),
];

/// Frequencies with and without the inertias of the bodies, and the compliance that the modes make.
pub fn checks() -> Vec<Check> {
    let modes = modes(true);
    let found = frequencies(&modes);
    let points = frequencies(&self::modes(false));
    let raised = points
        .iter()
        .zip(&found)
        .filter(|(point, body)| point <= body)
        .count();
    let turn = workpiece().rotation.to_rotation_matrix().into_inner();
    let still = receptance(&modes, 0.0).map(|part| part.re);
    let still: Matrix3<f64> = turn.transpose() * still.fixed_view::<3, 3>(0, 0) * turn;
    vec![
        Check::printed(
            "frequencies of the three modes at the published pose: 8.77, 14.82, 23.14 Hz",
            PUBLISHED,
            ErrorBound {
                worst: worst_difference(&found, &MODES_HZ),
                // Half of the last printed digit.
                tolerance: 5e-3,
                unit: "Hz",
            },
            4,
        ),
        Check::printed(
            "receptance of these modes at 0 Hz, workpiece frame, 9 numbers",
            PUBLISHED,
            ErrorBound {
                worst: worst_difference((still * 1e6).as_slice(), COMPLIANCE_IN_PART.as_slice()),
                tolerance: 5e-4,
                unit: "um/N",
            },
            5,
        ),
        Check::none_wrong(
            "modes of bodies taken as points that are not above those of the bodies",
            "a body has more inertia than a point",
            raised,
        ),
    ]
}

/// The modes at the published pose, of bodies or of points.
fn modes(with_inertia: bool) -> Vec<Mode> {
    let robot = arms::tx200(OLDER_SPRINGS);
    let body = |(attachment, mass, centre, own): &Body| {
        let [xx, xy, xz, yy, yz, zz] = *own;
        Mass {
            attachment: *attachment,
            mass: *mass,
            centre: (*centre).into(),
            inertia: with_inertia.then(|| Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)),
            relative_uncertainty: 0.0,
        }
    };
    let model = StiffnessModel {
        structure: Structure {
            masses: BODIES.iter().map(body).collect(),
            ..Structure::EMPTY
        },
        ..StiffnessModel::DRIVES.clone()
    };
    let tool: Isometry = flange_from_tool();
    let mut state = ArmState::new(Arm {
        robot: &robot,
        compliance: robot.compliance().expect("the arm was made with springs"),
        model: &model,
        flange_from_tool: &tool,
    });
    state.set_joints(&posture(&robot).joints);
    let found = state.modes().expect("the arm has no compensator");
    found.modes.iter().map(|mode| mode.at_tool).collect()
}

fn frequencies(modes: &[Mode]) -> Vec<f64> {
    modes.iter().map(Mode::frequency_hz).collect()
}
