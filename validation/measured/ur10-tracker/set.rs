//! UR10: 632 poses measured by a laser tracker. See README.md.

use nalgebra::Vector3;

use armill_core::calibrate::MeasuredPose;
use armill_core::units::from_mm;

use crate::arms;
use crate::measured::poses::stretches_held_out;
use crate::measured::{Comparison, Samples};

/// Stretches of the series, each held out once.
const STRETCHES: usize = 8;

/// Positions held out, by three models.
pub fn comparisons(samples: &Samples) -> Vec<Comparison> {
    let rows = samples.rows("ur10-lasertracker/Series_D/measurements_iso_cubes.csv");
    let pose = |row: &Vec<f64>| MeasuredPose {
        joints: row[7..13].to_vec(),
        position: Vector3::new(row[14], row[16], row[18]).map(from_mm),
        rotation: None,
    };
    let poses: Vec<MeasuredPose> = rows.iter().map(pose).collect();
    let robot = arms::library("universal-robots/ur10");
    stretches_held_out(&robot, "632 poses", &poses, STRETCHES)
}
