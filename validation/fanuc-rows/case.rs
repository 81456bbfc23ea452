//! FANUC R-2000iC: measured postures and forces to joint torques and deflection. See README.md.
//!
//! Controller angles go in, coupled as this controller couples them; tool point, torque about each joint axis
//! and deflection are the result. The measured deflections of the data set are not used here.

use nalgebra::Vector3;

use armill_core::frame::Isometry;
use armill_core::robot::inverse::posture_at;
use armill_core::source::elastic::predict;
use armill_core::spatial::Wrench;

use crate::arms;
use crate::check::{Check, ErrorBound, worst, worst_difference};

const REFERENCE: &str = "independent computation";
/// Tool point in the flange frame, m.
pub(crate) const TOOL_POINT: Vector3<f64> = Vector3::new(0.0069, 0.2453, 0.3193);

/// One measured pose and what follows from it: angles and force were measured, the rest another program
/// computed from them.
pub(crate) struct Row {
    /// From 1, as in the data set.
    pub number: usize,
    /// Controller angles, rad: `joint_angles.csv`.
    pub joints: [f64; 6],
    /// Force on the tool point, base, N: `forces.csv`.
    pub force: [f64; 3],
    /// Tool point, m, base.
    pub tcp: [f64; 3],
    /// Torque of the force about each joint axis of the model, N m.
    pub torque: [f64; 6],
    /// Predicted deflection, base, mm.
    pub predicted_mm: [f64; 3],
}

/// Every row: five of the 43 of the data set, all over its postures and forces.
pub(crate) const ROWS: [Row; 5] = [
    Row {
        number: 1,
        joints: [
            -1.047040472,
            -0.291347812,
            -0.504923753,
            0.066113072,
            -1.098335698,
            2.529313699,
        ],
        force: [-120.2110768, -78.21523168, -14.69090881],
        tcp: [0.825436, -1.075485, 0.727976],
        torque: [-193.8469, 15.6042, 12.3063, -62.7472, 1.0694, 20.0324],
        predicted_mm: [-0.33978, -0.26410, -0.05427],
    },
    Row {
        number: 9,
        joints: [
            -0.89966487,
            0.068155107,
            -0.271939751,
            0.843430361,
            -0.966528433,
            1.847849892,
        ],
        force: [-737.9375097, 52.92501608, -457.3978791],
        tcp: [1.156830, -1.746331, 1.232671],
        torque: [-1227.4578, 530.3421, 1033.4830, -37.6185, 501.8071, -70.5649],
        predicted_mm: [-3.08234, -1.15866, -1.57272],
    },
    Row {
        number: 17,
        joints: [
            -2.0753012,
            -0.749217488,
            -0.274627558,
            0.301366002,
            -0.808907748,
            2.804656841,
        ],
        force: [618.7614783, -783.1895378, -407.001901],
        tcp: [-0.459237, -1.087788, 0.837132],
        torque: [1032.7511, 415.5366, 409.2752, 322.8184, -161.2982, 9.5712],
        predicted_mm: [1.65428, -0.90319, -0.13029],
    },
    Row {
        number: 32,
        joints: [
            -1.944960012,
            0.279671559,
            -0.051190507,
            -0.111788339,
            -0.651129984,
            3.321064861,
        ],
        force: [331.408543, 330.8453734, -562.4732479],
        tcp: [-0.571667, -2.219894, 1.507703],
        torque: [546.5583, 744.8305, 1021.2631, -100.1596, 382.5096, -166.8282],
        predicted_mm: [1.38434, 0.32829, -2.11210],
    },
    Row {
        number: 43,
        joints: [
            -1.625163333,
            0.089709924,
            -0.043545965,
            0.035430184,
            -1.612893668,
            1.877991728,
        ],
        force: [65.1951642, 66.82878567, -897.760084],
        tcp: [-0.040910, -1.882516, 1.355062],
        torque: [119.9970, 1361.3043, 1350.0814, -21.7328, 204.4736, -21.0843],
        predicted_mm: [0.26749, 0.34180, -1.66020],
    },
];

/// Greatest differences of a row from what is printed: tool point (um), torque (N m), deflection (um).
fn differences(row: &Row) -> [f64; 3] {
    let robot = arms::r2000ic();
    let joints = robot.compliance().expect("the arm was made with springs");
    let flange_from_tool = Isometry::translation(TOOL_POINT.x, TOOL_POINT.y, TOOL_POINT.z);
    let posture = posture_at(&robot, &row.joints, &flange_from_tool);
    let load = Wrench::from_force(row.force.into());
    let torque: Vec<f64> = posture.screws.iter().map(|screw| screw.dot(&load)).collect();
    let tcp = posture.base_from_tool.translation.vector;
    let deflection_mm = predict(&posture, joints, &load).twist.linear * 1e3;
    [
        worst_difference(tcp.as_slice(), &row.tcp) * 1e6,
        worst_difference(&torque, &row.torque),
        worst_difference(deflection_mm.as_slice(), &row.predicted_mm) * 1e3,
    ]
}

/// Displacements of the rows against what was computed from the published inputs.
pub fn checks() -> Vec<Check> {
    let found = ROWS.map(|row| differences(&row));
    let rows = ROWS.map(|row| row.number.to_string()).join(", ");
    let over_rows = |index: usize| worst(found.iter().map(|differences| differences[index]));
    vec![
        // Half of the last printed digit, here and below.
        Check::printed(
            format!("tool point, rows {rows}"),
            REFERENCE,
            ErrorBound {
                worst: over_rows(0),
                tolerance: 0.5,
                unit: "um",
            },
            3,
        ),
        Check::printed(
            "torque of the measured force about the six joint axes",
            REFERENCE,
            ErrorBound {
                worst: over_rows(1),
                tolerance: 5e-5,
                unit: "N m",
            },
            7,
        ),
        Check::printed(
            "deflection with the published joint stiffness",
            REFERENCE,
            ErrorBound {
                worst: over_rows(2),
                tolerance: 0.005,
                unit: "um",
            },
            5,
        ),
    ]
}

#[cfg(test)]
mod tests;
