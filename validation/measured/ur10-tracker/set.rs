//! UR10: 632 poses measured by a laser tracker. See README.md.

use nalgebra::Vector3;

use armill_core::calibrate::{MeasuredPose, ParameterSet, Prior, Question};
use armill_core::frame::Isometry;
use armill_core::learn::held_out;
use armill_core::units::{from_deg, from_mm};
use armill_core::watch::Watch;

use crate::arms;
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
    let question = Question {
        requested: ParameterSet::Geometry,
        flange_from_point: Isometry::identity(),
        turn_length: 1.0,
        prior: Some(Prior {
            length: from_mm(0.5),
            angle: from_deg(0.05),
        }),
    };
    let robot = arms::library("universal-robots/ur10");
    let errors = held_out(&robot, &poses, &question, STRETCHES, Watch::NONE)
        .unwrap_or_else(|error| panic!("the series determines the arm: {error}"));
    Comparison::of_models("position, held out in 8 stretches", &errors)
}
