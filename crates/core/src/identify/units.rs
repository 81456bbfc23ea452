//! Plausibility of the units of load tests: measured displacements compared with those of a typical arm.

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

#[cfg(test)]
mod tests {
    use super::super::small_arm::{arm, tests};
    use super::*;

    #[test]
    fn readings_in_other_units_show_the_factor_between_them() {
        let robot = arm(1.0);
        let unknowns = drives(&robot);
        let typical = tests(&unknowns, &State::typical(&unknowns), 7, 0.0);
        assert!((measured_over_typical(&robot, &typical).unwrap() - 1.0).abs() < 1e-12);
        let mut in_mm = typical.clone();
        for reading in in_mm.iter_mut().flat_map(|test| &mut test.readings) {
            reading.value *= 1e3;
        }
        assert!((measured_over_typical(&robot, &in_mm).unwrap() - 1e3).abs() < 1e-9);
        // One of seven in other units does not move the median far.
        let mixed = [&in_mm[..1], &typical[1..]].concat();
        assert!((measured_over_typical(&robot, &mixed).unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn without_readings_or_loads_there_is_no_factor() {
        let robot = arm(1.0);
        let mut still = tests(&drives(&robot), &State::typical(&drives(&robot)), 3, 0.0);
        for test in &mut still {
            test.wrench.force *= 0.0;
        }
        assert_eq!(measured_over_typical(&robot, &still), None);
        assert_eq!(measured_over_typical(&robot, &[]), None);
    }
}
