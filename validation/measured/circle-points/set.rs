//! An arm moved axis by axis, with three reflectors on the tool. See README.md.

use armill_core::calibrate::MeasuredPose;
use armill_measure::tracker::{Files, JointUnit, together};

use crate::arms;
use crate::measured::poses::stretches_held_out;
use crate::measured::{Comparison, Samples};

/// The motions of the six axes, each held out once.
const AXES: usize = 6;

/// Positions at the motion of each axis, by what was found from those of the others.
pub fn comparisons(samples: &Samples) -> Vec<Comparison> {
    stretches_held_out(
        &arms::library("fanuc/r2000ic"),
        "36 poses, axis by axis",
        &poses(samples),
        AXES,
    )
}

fn poses(samples: &Samples) -> Vec<MeasuredPose> {
    let files = Files {
        measured: vec![samples.path("kuka-circle-points/N1N2N3Jval.csv")],
        base: None,
        joints: None,
        joint_unit: JointUnit::Degree,
    };
    let robot = arms::library("fanuc/r2000ic");
    together(&robot, &files)
        .unwrap_or_else(|error| panic!("{error}"))
        .poses
}
