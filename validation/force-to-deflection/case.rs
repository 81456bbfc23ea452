//! From a milling force to a static deflection, TX200. See README.md.
//!
//! `d = C F`: once with the printed compliance, three digits, once with that of the chain and its springs.
//! Force and deflection are in the workpiece frame.

use nalgebra::Vector3;

use armill_core::source::elastic::predict;
use armill_core::spatial::Wrench;

use crate::arms;
use crate::check::{Check, ErrorBound, worst_difference};
use crate::tx200_compliance::{COMPLIANCE_IN_PART, OLDER_SPRINGS, posture, workpiece};

const REFERENCE: &str = "independent computation";

/// Mean force of up-milling on the tool, workpiece frame, N.
const FORCE: Vector3<f64> = Vector3::new(-150.7929, 35.6771, 14.3684);
/// Deflection with the printed matrix, um.
const DEFLECTION_UM: [f64; 3] = [-107.7, 78.6, -104.1];
/// Lengths of the deflection with the printed matrix, and with the one before it was printed, um.
const LENGTH_PRINTED_MATRIX_UM: f64 = 169.13;
const LENGTH_UM: f64 = 169.19;

/// Displacement under one force against the printed matrix and against its inverse.
pub fn checks() -> Vec<Check> {
    let printed = COMPLIANCE_IN_PART * FORCE;
    let robot = arms::tx200(OLDER_SPRINGS);
    let joints = robot.compliance().expect("the arm was made with springs");
    let load = Wrench::from_force(workpiece() * FORCE);
    let deviation = predict(&posture(&robot), joints, &load).twist.linear;
    let in_part_um = workpiece().inverse_transform_vector(&deviation) * 1e6;
    vec![
        Check::printed(
            "length of the deflection, printed compliance matrix: 169.13 um",
            REFERENCE,
            ErrorBound {
                worst: (printed.norm() - LENGTH_PRINTED_MATRIX_UM).abs(),
                tolerance: 0.01,
                unit: "um",
            },
            4,
        ),
        Check::printed(
            "its components, printed compliance matrix",
            REFERENCE,
            ErrorBound {
                worst: worst_difference(printed.as_slice(), &DEFLECTION_UM),
                tolerance: 0.05,
                unit: "um",
            },
            4,
        ),
        Check::printed(
            "length of the deflection as armill predicts it: 169.19 um",
            REFERENCE,
            ErrorBound {
                worst: (in_part_um.norm() - LENGTH_UM).abs(),
                tolerance: 0.01,
                unit: "um",
            },
            4,
        ),
    ]
}
