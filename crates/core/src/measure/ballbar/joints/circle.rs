//! A circle in the cell, and the arm that follows it: joints and levers over the angle.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `a` | angle on the circle, from its +y' towards z' | rad |
//! | `theta` | position of a joint there, the chain's counting | rad (m) |
//! | `l` | lever of a joint: how its screw moves the tool, per unit | m/rad (m/m) |
//! | `g` | what moves the tool beside load and backlash: geometry, gravity | m |
//!
//! Levers and `g` are told along the axes of the circle: towards angle 0, towards 90 deg, along the normal. All are known
//! at stations evenly round the circle; between them cubics through four stations stand for them, which leave
//! the fourth power of the pitch: 1e-9 of the whole at 720 stations.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Point2, Vector3};

use super::reversal::{JointReversal, reversals};
use crate::kernel::Question;
use crate::load::{LoadCases, LoadFrame, PathLoad};
use crate::map::along_path;
use crate::path::{Placing, Shape, Track};
use crate::robot::{BacklashSide, Unreachable};
use crate::source::{Arm, ArmState, StiffnessModel};
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// A circle on a plane of the cell, with the tool held still on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Where its plane lies, and how the tool stands on it.
    pub placing: Placing,
    /// Path x and y, m.
    pub centre: Point2<f64>,
    /// m
    pub radius: f64,
}

/// Stations that a measured circle is followed at.
pub const STATIONS: usize = 720;
/// Fewest stations: cubics need neighbours.
pub const LEAST_STATIONS: usize = 24;
/// A joint that moves less over a whole circle stands still: rounding of the inverse, rad (m).
const STILL: f64 = 1e-9;
/// A joint that turns farther from one of 24 stations to the next jumps, rad (m).
const JUMP: f64 = 1.0;

/// An arm that follows a circle, without load.
#[derive(Clone, Debug)]
pub struct Followed {
    /// Nominal radius, m.
    pub radius: f64,
    /// Where joints turn back, by joint, then by angle.
    pub reversals: Vec<JointReversal>,
    /// Least distance of a joint to its limit on the way, negative outside, rad (m).
    pub limit_margin: f64,
    /// By joint.
    pub(super) joints: Vec<JointAlong>,
    /// `g` at each station.
    pub(super) beside: Vec<Vector3<f64>>,
}

/// One joint along the circle.
#[derive(Clone, Debug)]
pub(super) struct JointAlong {
    /// `theta` at each station.
    pub theta: Vec<f64>,
    /// Whether it moves by rounding alone: then it drags its link nowhere.
    pub stands_still: bool,
    /// How far it has gone on after a whole turn.
    pub winding: f64,
    /// `l` at each station.
    pub lever: Vec<Vector3<f64>>,
    /// Torque of gravity on its link at each station, N m (N).
    pub torque: Vec<f64>,
    /// What decides on its flank.
    pub side: BacklashSide,
}

/// Why an arm follows no circle.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotFollowed {
    /// It does not get there.
    #[error("at {} deg of the circle: {why}", angle.to_degrees())]
    Unreachable {
        /// rad
        angle: f64,
        /// Why.
        why: Unreachable,
    },
    /// It changes its posture.
    #[error("joint number {} jumps at {} deg of the circle", joint + 1, angle.to_degrees())]
    Jumps {
        /// Which.
        joint: usize,
        /// rad
        angle: f64,
    },
    /// The watch says so.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The arm of `question` along `circle`, in the branch of the question, at so many stations (at least
/// [`LEAST_STATIONS`]). Load cases of the question are not looked at.
///
/// # Errors
/// [`NotFollowed`].
pub fn follow(
    question: &Question<'_>,
    (circle, stations): (&Circle, usize),
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
            stands_still: false,
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
    let beside = (0..track.len()).map(|index| axes.tr_mul(&answers.deviations_at(index)[0]));
    Ok(Followed {
        radius: circle.radius,
        reversals: reversals(&joints),
        limit_margin,
        beside: beside.collect(),
        joints,
    })
}

/// The same model without backlash: what is left moves the tool the same way both ways round.
fn without_gaps(model: &StiffnessModel) -> StiffnessModel {
    let mut model = model.clone();
    model.structure.backlash.clear();
    model
}

impl JointAlong {
    /// Finds how far the joint goes on in a turn, and whether it stands still.
    fn close(&mut self, joint: usize, slides: bool) -> Result<(), NotFollowed> {
        let count = self.theta.len();
        let seam = self.theta[0] - self.theta[count - 1];
        // The last station and the first are neighbours, by whole turns of a joint that turns.
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
        self.stands_still = most - least < STILL;
        if self.stands_still {
            self.theta.fill(least);
        }
        Ok(())
    }

    /// `theta` at a station of the first turn or the second.
    pub fn at(&self, index: usize) -> f64 {
        let count = self.theta.len();
        self.theta[index % count] + self.winding * (index / count) as f64
    }

    /// `theta` at an angle of the first turn.
    pub fn theta_at(&self, angle: f64) -> f64 {
        if self.stands_still {
            return self.theta[0];
        }
        let count = self.theta.len();
        let (four, weights) = cubic(angle, count);
        // Stations are counted from one turn before.
        let of = |k: usize| self.at(four + k) - self.winding;
        (0..4).map(|k| weights[k] * of(k)).sum()
    }
}

/// What stands at `angle` (rad) between values at even stations of a turn.
pub(super) fn between(values: &[Vector3<f64>], angle: f64) -> Vector3<f64> {
    let (four, weights) = cubic(angle, values.len());
    let of = |k: usize| values[(four + k) % values.len()];
    (0..4).map(|k| of(k) * weights[k]).sum()
}

/// The same of plain numbers.
pub(super) fn between_numbers(values: &[f64], angle: f64) -> f64 {
    let (four, weights) = cubic(angle, values.len());
    (0..4)
        .map(|k| values[(four + k) % values.len()] * weights[k])
        .sum()
}

/// The first of four stations about an angle of a turn, counted from one turn before, and the weights of these.
fn cubic(angle: f64, count: usize) -> (usize, [f64; 4]) {
    let place = angle.rem_euclid(TAU) / TAU * count as f64;
    let before = place.floor();
    let t = place - before;
    let weights = [
        -t * (t - 1.0) * (t - 2.0) / 6.0,
        (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
        -(t + 1.0) * t * (t - 2.0) / 2.0,
        (t + 1.0) * t * (t - 1.0) / 6.0,
    ];
    (before as usize + count - 1, weights)
}
