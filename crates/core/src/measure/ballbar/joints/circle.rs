//! A circle in the cell, and the arm that follows it: joint positions and levers over the angle.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `a` | angle on the circle, from its +y' towards z' | rad |
//! | `theta` | position of a joint there, chain coordinates | rad (m) |
//! | `l` | lever of a joint: displacement of the tool per unit | m/rad (m/m) |
//! | `g` | displacement of the tool by geometry and gravity | m |
//!
//! Levers and `g` are given along the axes of the circle: towards angle 0, towards 90 deg, along the normal. All are
//! computed at stations evenly round the circle; between them cubics through four stations interpolate with an error of
//! the fourth power of the pitch: 1e-9 of the whole at 720 stations.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Point2, Vector3};

use super::along::JointAlong;
use super::reversal::{JointReversal, reversals};
use crate::kernel::Question;
use crate::load::{LoadCases, LoadFrame, PathLoad};
use crate::map::along_path;
use crate::path::{Placing, Shape, Track};
use crate::robot::{BacklashSide, Unreachable};
use crate::source::{Arm, ArmState, StiffnessModel};
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// A circle on a plane of the cell, with constant tool orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Its plane, and the tool orientation.
    pub placing: Placing,
    /// Path x and y, m.
    pub centre: Point2<f64>,
    /// m
    pub radius: f64,
}

/// Number of stations on a measured circle.
pub const STATIONS: usize = 720;
/// Minimum number of stations: cubics need neighbours.
pub const LEAST_STATIONS: usize = 24;
/// A joint that moves less over a whole circle is at standstill: rounding of the inverse, rad (m).
const STILL: f64 = 1e-9;
/// A joint that turns farther from one of 24 stations to the next jumps, rad (m).
const JUMP: f64 = 1.0;

/// An arm that follows a circle, without load.
#[derive(Clone, Debug)]
pub struct Followed {
    /// Nominal radius, m.
    pub radius: f64,
    /// Reversals of the joints, by joint, then by angle.
    pub reversals: Vec<JointReversal>,
    /// Least margin of a joint to its limit on the path, negative outside, rad (m).
    pub limit_margin: f64,
    /// By joint.
    pub(super) joints: Vec<JointAlong>,
    /// `g` at each station.
    pub(super) unloaded: Vec<Vector3<f64>>,
}

/// Why an arm does not follow a circle.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotFollowed {
    /// A point is out of reach.
    #[error("at {} deg of the circle: {why}", angle.to_degrees())]
    Unreachable {
        /// rad
        angle: f64,
        /// Why.
        why: Unreachable,
    },
    /// The posture changes.
    #[error("joint number {} jumps at {} deg of the circle", joint + 1, angle.to_degrees())]
    Jumps {
        /// Index of the joint.
        joint: usize,
        /// rad
        angle: f64,
    },
    /// Cancelled by the watch.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The arm of `question` along `circle`, in the branch of the question, at this number of stations (at least
/// [`LEAST_STATIONS`]). Load cases of the question are ignored.
///
/// # Errors
/// [`NotFollowed`].
pub fn follow(
    question: &Question<'_>,
    circle: &Circle,
    stations: usize,
    watch: Watch<'_>,
) -> Result<Followed, NotFollowed> {
    let stations = stations.max(LEAST_STATIONS);
    let shape = Shape::Circle {
        centre: circle.centre,
        radius: circle.radius,
    };
    let track = Track {
        path: shape.sampled(shape.length() / stations as f64),
        placing: circle.placing,
        base_from_part: circle.placing.base_from_path,
        spins: None,
        homes: None,
    };
    let model = without_gaps(question.arm.model);
    let arm = Arm {
        model: &model,
        ..question.arm
    };
    let requested = Question { arm, ..*question };
    let unloaded = PathLoad::Cases(LoadCases {
        frame: LoadFrame::Base,
        cases: vec![Wrench::ZERO],
    });
    let along = along_path(&requested, &track, unloaded, watch)?;
    let answers = &along.answers;
    let angle = |index: usize| TAU * index as f64 / track.len() as f64;
    let mut limit_margin = f64::INFINITY;
    for (index, point) in answers.points.iter().enumerate() {
        let evaluation = point.as_ref().map_err(|why| NotFollowed::Unreachable {
            angle: angle(index),
            why: *why,
        })?;
        limit_margin = limit_margin.min(evaluation.limit_margin);
    }
    // A circle begins at +y', which is -x of the part.
    let path = circle.placing.base_from_path.rotation.to_rotation_matrix();
    let axes = path.matrix() * Matrix3::from_columns(&[-Vector3::x(), Vector3::y(), Vector3::z()]);
    let mut joints: Vec<JointAlong> = (0..answers.joint_count)
        .map(|joint| JointAlong {
            theta: (0..track.len())
                .map(|index| arm.robot.theta(joint, answers.joints_at(index)))
                .collect(),
            at_standstill: false,
            winding: 0.0,
            lever: Vec::with_capacity(track.len()),
            torque: Vec::with_capacity(track.len()),
            side: question
                .arm
                .model
                .structure
                .backlash
                .get(joint)
                .and_then(Option::as_ref)
                .map_or(BacklashSide::Motion, |gap| gap.side),
        })
        .collect();
    for (joint, along) in joints.iter_mut().enumerate() {
        along.close(joint, arm.robot.slides(joint))?;
    }
    let mut arm_state = ArmState::new(arm);
    for index in 0..track.len() {
        arm_state.set_joints(answers.joints_at(index));
        for (joint, along) in joints.iter_mut().enumerate() {
            along.lever.push(axes.tr_mul(&arm_state.screws()[joint].linear));
            along.torque.push(arm_state.gravity_torques()[joint]);
        }
    }
    let unloaded = (0..track.len()).map(|index| axes.tr_mul(&answers.deviations_at(index)[0]));
    Ok(Followed {
        radius: circle.radius,
        reversals: reversals(&joints),
        limit_margin,
        unloaded: unloaded.collect(),
        joints,
    })
}

/// The same model without backlash: the rest is equal in both directions.
fn without_gaps(model: &StiffnessModel) -> StiffnessModel {
    let mut model = model.clone();
    model.structure.backlash.clear();
    model
}

impl JointAlong {
    /// Determines the change of the joint over a turn, and whether it is at standstill.
    fn close(&mut self, joint: usize, slides: bool) -> Result<(), NotFollowed> {
        let count = self.theta.len();
        let seam = self.theta[0] - self.theta[count - 1];
        // The last station and the first are neighbours, modulo whole turns of a revolute joint.
        let turns = if slides { 0.0 } else { (seam / TAU).round() };
        self.winding = -turns * TAU;
        let most = JUMP * LEAST_STATIONS as f64 / count as f64;
        for index in 0..count {
            if (self.at(index + 1) - self.at(index)).abs() > most {
                let angle = TAU * index as f64 / count as f64;
                return Err(NotFollowed::Jumps { joint, angle });
            }
        }
        let least = self.theta.iter().copied().fold(f64::INFINITY, f64::min);
        let most = self.theta.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        self.at_standstill = most - least < STILL;
        if self.at_standstill {
            self.theta.fill(least);
        }
        Ok(())
    }
}
