//! Are the units of load tests right? Measured displacements beside those of a typical arm.

use super::effect::{Effects, State};
use super::load_test::LoadTest;
use super::unknown::drives;
use crate::robot::Robot;

/// Median over all readings other than 0 of measured over predicted with typical drives: far from 1, units are wrong.
/// `None` where there is nothing to compare.
pub fn measured_over_typical(robot: &Robot, tests: &[LoadTest]) -> Option<f64> {
    let unknowns = drives(robot);
    let state = State::typical(&unknowns);
    let length = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let mut ratios = Vec::new();
    for test in tests {
        let predicted = Effects::of(robot, &unknowns, test).readings(&unknowns, &state);
        let measured = length(&mut test.readings.iter().map(|reading| reading.value));
        let predicted = length(&mut predicted.into_iter());
        if measured > 0.0 && predicted > 0.0 {
            ratios.push(measured / predicted);
        }
    }
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied()
}
