//! FANUC R-2000iC: deflections computed elsewhere, back to the joint stiffness behind them. See README.md.
//!
//! Ordinary least squares of fifteen readings for six unknown compliances, without a prior:
//! the result depends on the readings only.

use nalgebra::Vector3;

use armill_core::identify::fit::Scatter;
use armill_core::identify::unknown::drives;
use armill_core::identify::{LoadTest, Loss, Measured, Method, Points, Prior, Reading, identify};
use armill_core::robot::Axis;
use armill_core::spatial::Wrench;

use crate::arms;
use crate::check::{Check, ErrorBound, worst};
use crate::fanuc_rows::{ROWS, TOOL_POINT};

/// Compliances of the drives, found back from deflections that were computed from the published ones.
pub fn checks() -> Vec<Check> {
    let robot = arms::r2000ic();
    let tests: Vec<LoadTest> = ROWS
        .iter()
        .map(|row| LoadTest {
            joints: row.joints.to_vec(),
            wrench: Wrench::from_force(row.force.into()),
            force_point: TOOL_POINT,
            measured_point: TOOL_POINT,
            readings: readings(row.predicted_mm.into()),
        })
        .collect();
    let method = Method {
        prior: Prior::None,
        points: Points::Known,
        loss: Loss::Squares,
        scatter: Scatter::Found,
    };
    let found = identify(&robot, &drives(&robot), &tests, method).expect("fifteen readings for six drives");
    let published = robot.compliance().expect("the arm was made with springs");
    let errors = found.estimates.iter().zip(published);
    vec![Check::printed(
        "compliance of the six drives from five computed deflections, relative to the published",
        "independent computation",
        ErrorBound {
            worst: worst(errors.map(|(found, published)| found.value / published.value - 1.0)),
            tolerance: 4.7e-5,
            unit: "",
        },
        7,
    )]
}

/// The three components of a deflection as readings in m; their uncertainty is half of the last printed digit.
fn readings(deflection_mm: Vector3<f64>) -> Vec<Reading> {
    let reading = |axis: Axis| Reading {
        what: Measured::Displacement(axis),
        value: deflection_mm[axis.index()] * 1e-3,
        standard_uncertainty: 5e-9,
    };
    [Axis::X, Axis::Y, Axis::Z].map(reading).to_vec()
}
