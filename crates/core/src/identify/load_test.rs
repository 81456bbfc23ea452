//! A load test: a posture, a wrench on the tool, and what moved.
//!
//! | symbol | meaning | unit, frame |
//! |---|---|---|
//! | `q` | posture | rad (m), the controller's counting |
//! | `w` | load less what was there before, about the force point | N, N m, base axes |
//! | `p`, `m` | where the force acts, where displacement is measured | m, flange |
//! | `r`, `u` | a reading loaded less unloaded, and its standard uncertainty | m or rad |

use nalgebra::Vector3;

use crate::robot::chain::Axis;
use crate::spatial::Wrench;

/// One loading and the readings that belong to it: loaded minus unloaded, in one posture.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadTest {
    /// Joint positions in the controller's counting, rad (m).
    pub joints: Vec<f64>,
    /// Load on the tool, base axes, moment about the force point: the difference of loaded and unloaded.
    pub wrench: Wrench,
    /// Where the force acts, m, flange frame.
    pub force_point: Vector3<f64>,
    /// Where the displacement is measured, m, flange frame.
    pub measured_point: Vector3<f64>,
    /// What was read.
    pub readings: Vec<Reading>,
}

impl LoadTest {
    /// Displacements in this test, base axes, m; `None` where an axis was not measured.
    pub fn displacement(&self) -> [Option<f64>; 3] {
        [Axis::X, Axis::Y, Axis::Z].map(|axis| {
            let found = self
                .readings
                .iter()
                .find(|reading| reading.what == Measured::Displacement(axis));
            found.map(|reading| reading.value)
        })
    }
}

/// One number read from an instrument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Of what.
    pub what: Measured,
    /// m or rad.
    pub value: f64,
    /// Standard uncertainty, m or rad; above 0.
    pub standard_uncertainty: f64,
}

/// What an instrument can look at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measured {
    /// Displacement of the measured point along a base axis.
    Displacement(Axis),
    /// Turn of the link after this joint against the link before, about the joint's axis by the right hand of the
    /// chain: how Shneor & Chapsky 2021 measured, section 3.4.
    Turn(usize),
}
