//! FANUC R-2000iC: 43 load tests, each predicted from the others. See README.md.

use nalgebra::Vector3;

use armill_core::identify::effect::{Effects, State};
use armill_core::identify::fit::Scatter;
use armill_core::identify::unknown::{bending, drives};
use armill_core::identify::{
    Identified, LoadTest, Loss, Measured, Method, Points, Prior, Reading, Unknown, identify,
};
use armill_core::robot::Axis;
use armill_core::spatial::Wrench;
use armill_core::units::to_mm;

use crate::arms;
use crate::fanuc_rows::TOOL_POINT;
use crate::measured::{Comparison, NORMAL_95, Samples, Stated};

/// Displacements by the published stiffness, and left out by identified ones.
pub fn comparisons(samples: &Samples) -> Vec<Comparison> {
    let (tests, robot) = (tests(samples), arms::r2000ic());
    let drives = drives(&robot);
    let published = robot.compliance().expect("the arm was made with springs");
    let state = State::of_sizes(published.iter().map(|joint| joint.value).collect());
    let by_published = tests.iter().map(|test| {
        let found = Effects::of(&robot, &drives, test).readings(&drives, &state);
        length(
            found
                .iter()
                .zip(&test.readings)
                .map(|(found, reading)| found - reading.value),
        )
    });
    let row = |model: &str, errors, stated| Comparison {
        quantity: "displacement under load".to_owned(),
        model: model.to_owned(),
        unit: "mm",
        errors,
        stated,
    };
    let none = tests
        .iter()
        .map(|test| length(test.readings.iter().map(|reading| reading.value)));
    let mut rows = vec![
        row("none: the displacement itself", none.collect(), Stated::Nothing),
        row(
            "published stiffness of the drives",
            by_published.collect(),
            Stated::Nothing,
        ),
    ];
    let all = [drives.clone(), bending(&robot)].concat();
    for (model, unknowns, points) in [
        ("drives, held out", drives, Points::Known),
        (
            "drives and bending, points uncertain by 0.1 m, held out",
            all,
            Points::Separate(0.1),
        ),
    ] {
        let method = Method {
            prior: Prior::Typical,
            points,
            loss: Loss::Huber,
            scatter: Scatter::Found,
        };
        let found = identify(&robot, &unknowns, &tests, method).expect("43 tests are sufficient");
        let errors = found
            .tests
            .iter()
            .map(|test| length(test.left_out.iter().copied()));
        let stated = match points {
            Points::Known => Stated::Coverage(coverage(&tests, &unknowns, &found)),
            _ => Stated::Nothing,
        };
        rows.push(row(model, errors.collect(), stated));
    }
    rows
}

/// Fraction of the left-out components within 95 %: the scatter of the readings and the uncertainty of the springs.
fn coverage(tests: &[LoadTest], unknowns: &[Unknown], found: &Identified) -> f64 {
    let robot = arms::r2000ic();
    let state = State::of_sizes(found.estimates.iter().map(|spring| spring.value).collect());
    let mut within = (0.0, 0.0);
    for (test, outcome) in tests.iter().zip(&found.tests) {
        let jacobian = Effects::of(&robot, unknowns, test).jacobian(unknowns, &state);
        let of_sizes = jacobian.columns(0, unknowns.len());
        let of_springs = of_sizes * &found.covariance * of_sizes.transpose();
        for (row, (error, reading)) in outcome.left_out.iter().zip(&test.readings).enumerate() {
            let scatter = found.scale * reading.standard_uncertainty;
            let u = (scatter * scatter + of_springs[(row, row)]).sqrt();
            within.0 += f64::from(error.abs() <= NORMAL_95 * u);
            within.1 += 1.0;
        }
    }
    within.0 / within.1
}

fn length(components: impl Iterator<Item = f64>) -> f64 {
    to_mm(components.map(|part| part * part).sum::<f64>().sqrt())
}

fn tests(samples: &Samples) -> Vec<LoadTest> {
    let rows = |file: &str| samples.rows(&format!("fanuc-r2000ic-deflection/{file}"));
    let reading = |displacement: &[f64], axis: Axis| Reading {
        what: Measured::Displacement(axis),
        value: displacement[axis.index()],
        standard_uncertainty: 1e-5,
    };
    rows("joint_angles.csv")
        .into_iter()
        .zip(rows("forces.csv"))
        .zip(rows("deltaX.csv"))
        .map(|((joints, force), displacement)| LoadTest {
            joints,
            wrench: Wrench::from_force(Vector3::from_column_slice(&force)),
            force_point: TOOL_POINT,
            measured_point: TOOL_POINT,
            readings: Axis::ALL.map(|axis| reading(&displacement, axis)).to_vec(),
        })
        .collect()
}
