//! An arm of three joints and load tests of it, for tests.

use nalgebra::Vector3;

use super::effect::{Effects, State};
use super::load_test::{LoadTest, Measured, Reading};
use super::unknown::Unknown;
use crate::robot::chain::{Amount, Axis, Motion};
use crate::robot::{Joint, Limits, Robot};
use crate::spatial::Wrench;

/// Reach of 1 m times `scale` from its first axis.
pub(super) fn arm(scale: f64) -> Robot {
    let about = |axis, joint| Motion::About(axis, Amount::Joint(joint));
    let along = |axis, by: f64| Motion::Along(axis, Amount::Constant(by * scale));
    let motions = vec![
        along(Axis::Z, 0.5),
        about(Axis::Z, 0),
        along(Axis::X, 0.1),
        about(Axis::Y, 1),
        along(Axis::X, 0.5),
        about(Axis::Y, 2),
        along(Axis::X, 0.4),
    ];
    let joint = |name| Joint {
        limits: Some(Limits {
            lower: -1.9,
            upper: 1.7,
        }),
        ..Joint::plain(name)
    };
    Robot::new("small", motions, ["a", "b", "c"].map(joint).to_vec()).unwrap()
}

/// Numbers from -1 to 1 without pattern: SplitMix64.
pub(super) fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// This many tests of `arm(1.0)` with loads of some 300 N, each read along three axes with an error of up to `noise`
/// (m), predicted by `state`.
pub(super) fn tests(unknowns: &[Unknown], state: &State, count: usize, noise: f64) -> Vec<LoadTest> {
    let (robot, mut next) = (arm(1.0), numbers(11));
    let mut test = || {
        let mut vector = |size: f64| Vector3::from_fn(|_, _| size * next());
        let (joints, wrench) = (vector(1.4), Wrench::from_force(vector(300.0)));
        let (force_point, measured_point) = (vector(0.2), vector(0.2));
        let reading = |axis| Reading {
            what: Measured::Displacement(axis),
            value: 0.0,
            standard_uncertainty: 1e-5,
        };
        let mut test = LoadTest {
            joints: joints.iter().copied().collect(),
            wrench,
            force_point,
            measured_point,
            readings: [Axis::X, Axis::Y, Axis::Z].map(reading).to_vec(),
        };
        let values = Effects::of(&robot, unknowns, &test).readings(unknowns, state);
        for (reading, value) in test.readings.iter_mut().zip(values) {
            reading.value = value + noise * next();
        }
        test
    };
    (0..count).map(|_| test()).collect()
}
