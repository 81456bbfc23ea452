//! A load test: a posture, a wrench on the tool, and the displacements.
//!
//! | symbol | meaning | unit, frame |
//! |---|---|---|
//! | `q` | posture | rad (m), controller coordinates |
//! | `w` | difference of loaded and unloaded, about the force point | N, N m, base axes |
//! | `p`, `m` | force point, measured point | m, flange |
//! | `r`, `u` | a reading loaded less unloaded, and its standard uncertainty | m or rad |

use nalgebra::Vector3;

use crate::robot::chain::Axis;
use crate::spatial::Wrench;

/// One loading and the readings that belong to it: loaded minus unloaded, in one posture.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadTest {
    /// Joint positions in controller coordinates, rad (m).
    pub joints: Vec<f64>,
    /// Load on the tool, base axes, moment about the force point: the difference of loaded and unloaded.
    pub wrench: Wrench,
    /// Where the force acts, m, flange frame.
    pub force_point: Vector3<f64>,
    /// Where the displacement is measured, m, flange frame.
    pub measured_point: Vector3<f64>,
    /// The readings.
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
    /// The measured quantity.
    pub what: Measured,
    /// m or rad.
    pub value: f64,
    /// Standard uncertainty, m or rad; above 0.
    pub standard_uncertainty: f64,
}

/// Measured quantity of an instrument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measured {
    /// Displacement of the measured point along a base axis.
    Displacement(Axis),
    /// Rotation of the link after this joint relative to the link before, about the joint's axis by the right hand of
    /// the chain: the measurement of Shneor & Chapsky 2021, section 3.4.
    Turn(usize),
}
