//! Identification from load tests: known springs are recovered, with correct uncertainty; real tests are predicted as
//! documented.
//!
//! `exact_readings`: without noise; `uncertainty`: with it; `insufficient_tests`: outlying or insufficient tests;
//! `planned`: design of tests; `real_tests`: those of a FANUC.

// A panic is how a test fails; in helper functions too.
#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]

#[path = "../arms/mod.rs"]
mod arms;
mod exact_readings;
mod insufficient_tests;
mod planned;
mod real_tests;
mod uncertainty;

use armill_core::identify::effect::{Effects, State};
use armill_core::identify::fit::Scatter;
use armill_core::identify::{LoadTest, Loss, Measured, Method, Points, Prior, Reading, Unknown};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::robot::chain::Axis;
use armill_core::spatial::Wrench;

const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

/// SplitMix64; the seed is part of the test.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normal with mean 0 and standard deviation 1, by Box and Muller.
    fn normal(&mut self) -> f64 {
        let (a, b) = (self.uniform().max(1e-300), self.uniform());
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

/// Least squares without prior knowledge.
fn plain() -> Method {
    Method {
        prior: Prior::None,
        points: Points::Known,
        loss: Loss::Squares,
        scatter: Scatter::Found,
    }
}

/// Robust weights and the typical prior.
fn usual() -> Method {
    Method {
        prior: Prior::Typical,
        points: Points::Known,
        loss: Loss::Huber,
        scatter: Scatter::Found,
    }
}

/// Tests of `robot` in random postures with loads of up to 500 N, without readings.
fn loads(robot: &Robot, count: usize, random: &mut Random) -> Vec<LoadTest> {
    let test = |_| LoadTest {
        joints: robot
            .joints()
            .iter()
            .map(|joint| {
                let limits = joint.limits.unwrap();
                limits.middle() + 0.7 * (random.uniform() - 0.5) * (limits.upper - limits.lower)
            })
            .collect(),
        wrench: Wrench::from_force(Vector3::from_fn(|_, _| 500.0 * (2.0 * random.uniform() - 1.0))),
        force_point: Vector3::new(0.0, 0.05, 0.3),
        measured_point: Vector3::new(0.01, 0.05, 0.28),
        readings: AXES
            .map(|axis| Reading {
                what: Measured::Displacement(axis),
                value: 0.0,
                standard_uncertainty: 1e-5,
            })
            .to_vec(),
    };
    (0..count).map(test).collect()
}

/// Readings with springs of these sizes, with normal noise, m.
fn measure(
    robot: &Robot,
    unknowns: &[Unknown],
    state: &State,
    tests: &mut [LoadTest],
    mut noise: impl FnMut() -> f64,
) {
    for test in tests {
        let values = Effects::of(robot, unknowns, test).readings(unknowns, state);
        for (reading, value) in test.readings.iter_mut().zip(values) {
            reading.value = value + noise();
        }
    }
}

/// Some sizes about the middle of the prior, different for each unknown.
fn some_sizes(unknowns: &[Unknown], random: &mut Random) -> Vec<f64> {
    armill_core::identify::prior::typical_sizes(unknowns)
        .into_iter()
        .map(|size| size * (2.0 * random.uniform() - 1.0).exp())
        .collect()
}
