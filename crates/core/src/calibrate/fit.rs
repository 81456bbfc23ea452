//! The most likely geometry of an arm, from measured poses.
//!
//! Levenberg and Marquardt in two rounds: base and tool alone, from a best turn of the flange's places onto the measured
//! ones; then, of all that is asked, what `select` keeps there. Each pose counts alike. With `m` rows, `p` unknowns kept and
//! residuals `r` at the end:
//!
//! ```text
//! s^2 = |r|^2 / (m - p)        cov = s^2 (J'J)^-1        standard uncertainty = sqrt(diagonal)
//! ```
//!
//! With a [prior](super::prior) small motions are held to zero, and `p` is the number that the poses tell.
//!
//! These uncertainties take what the geometry leaves (sag, gears, tracker) for noise that is independent from pose to pose.
//!
//! Source: Mooring, Roth and Driels 1991; Everett, Driels and Mooring 1987; `docs/theory/calibration.md`.

use nalgebra::{DMatrix, Matrix3, Rotation3, UnitQuaternion, Vector3};

use super::arm::Arm;
use super::errors::PoseErrors;
use super::pose::MeasuredPose;
use super::prior::{Hold, Prior};
use super::select::{Redundant, select};
use super::triangle::{Triangle, solve};
use super::unknown::{Asked, Place, Unknown, unknowns};
use crate::frame::Isometry;
use crate::robot::chain::{Amount, Motion};
use crate::robot::forward::forward;
use crate::robot::{Robot, RobotError};

/// Steps of a round; the second ends after some five.
const MOST_STEPS: usize = 60;
/// A step that lowers the sum of squares by less than this part of it is the last.
const SETTLED: f64 = 1e-13;
/// Damping at first, and where no step helps any more.
const DAMPING: [f64; 2] = [1e-3, 1e9];
/// Rounds of scatter and geometry with a prior, and the change of the variance that ends them.
const MOST_ROUNDS: usize = 40;
const SAME_SCATTER: f64 = 1e-6;
/// Fewest poses: below, base and tool alone meet any measurement.
const FEWEST_POSES: usize = 4;
/// Greatest position that a tracker measures, m.
const FARTHEST: f64 = 1e4;

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Of the chain.
    pub requested: Asked,
    /// About where the measured point sits on the flange.
    pub flange_from_point: Isometry,
    /// So many metres count as much as a radian.
    pub turn_length: f64,
    /// What is known of small motions of the chain before; nothing if left out.
    pub prior: Option<Prior>,
}

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// Too few poses.
    #[error("{poses} poses with {rows} readings do not tell {unknowns} unknowns")]
    TooFew {
        /// Given.
        poses: usize,
        /// Numbers measured.
        rows: usize,
        /// To find.
        unknowns: usize,
    },
    /// A pose with another count of joints than the robot has, or with a number that cannot be.
    #[error("pose number {}: {what}", .index + 1)]
    Pose {
        /// From 0.
        index: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// Some poses with a turn and others without.
    #[error("the turn was measured in {with} of {poses} poses: in all of them or in none")]
    TurnsMissing {
        /// Poses with it.
        with: usize,
        /// All.
        poses: usize,
    },
    /// A weight of turns that is not above 0.
    #[error("a radian counts as {0} m, which is no length above 0")]
    TurnLength(f64),
    /// A prior that holds nothing, or all.
    #[error("a prior of {} m and {} rad: both must be above 0", .0.length, .0.angle)]
    Prior(Prior),
    /// The search left the finite numbers or found no independent unknown.
    #[error("no geometry near the nominal one was found; do these poses belong to this robot?")]
    NotFound,
}

/// An unknown that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Which.
    pub unknown: Unknown,
    /// m or rad; of base and tool 0, since their frames have taken it.
    pub value: f64,
    /// Same unit.
    pub standard_uncertainty: f64,
}

/// The geometry that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibrated {
    /// What was found, in the order of asking.
    pub estimates: Vec<Estimate>,
    /// Covariance of the estimates, in their order, m and rad.
    pub covariance: DMatrix<f64>,
    /// All that was asked for.
    pub unknowns: Vec<Unknown>,
    /// What stays at its nominal value; indices are of `unknowns`.
    pub redundant: Vec<Redundant>,
    /// Where the base stands in the tracker.
    pub tracker_from_base: Isometry,
    /// Where the point sits on the flange; turned only if turns were measured.
    pub flange_from_point: Isometry,
    /// Of the poses that it was found from.
    pub errors: PoseErrors,
    /// `s`, m: standard deviation of a single reading about the geometry that was found.
    pub standard_deviation: f64,
    /// How many of the estimates the poses tell: all without a prior.
    pub given: f64,
    /// Of each joint but the last, m and rad.
    small: Vec<[f64; 6]>,
}

impl Calibrated {
    /// The motions that come right after joint `index`: those that were found.
    pub fn motions_after(&self, index: usize) -> Vec<Motion> {
        let here = self
            .estimates
            .iter()
            .filter(|estimate| estimate.unknown.place == Place::After(index));
        let mut found: Vec<&Estimate> = here.collect();
        found.sort_by_key(|estimate| estimate.unknown.component);
        let motion = |estimate: &&Estimate| estimate.unknown.motion(estimate.value);
        found.iter().map(motion).collect()
    }

    /// The elementary motions of the calibrated chain of `robot`, base to flange.
    pub fn motions(&self, robot: &Robot) -> Vec<Motion> {
        let mut motions = Vec::new();
        for motion in robot.chain().motions() {
            motions.push(*motion);
            if let Amount::Joint(joint) = motion.amount() {
                motions.extend(self.motions_after(joint));
            }
        }
        motions
    }

    /// `robot` with this geometry and nothing else of its own: no compliance, no frames.
    ///
    /// # Errors
    /// A chain that became longer than any robot.
    pub fn bare_robot(&self, robot: &Robot) -> Result<Robot, RobotError> {
        Robot::new(robot.name(), self.motions(robot), robot.joints().to_vec())
    }

    /// Errors of other poses of `robot`, predicted by what was found here.
    ///
    /// # Errors
    /// A pose of another robot, or with a number that cannot be.
    pub fn errors_of(&self, robot: &Robot, poses: &[MeasuredPose]) -> Result<PoseErrors, Refusal> {
        check(robot, poses)?;
        let mut arm = Arm::nominal(robot, self.tracker_from_base, self.flange_from_point);
        arm.small.clone_from(&self.small);
        Ok(errors_of(&arm, poses))
    }
}

/// The geometry of `robot` that fits `poses` best.
///
/// # Errors
/// See [`Refusal`].
pub fn fit(robot: &Robot, poses: &[MeasuredPose], question: &Question) -> Result<Calibrated, Refusal> {
    check(robot, poses)?;
    if !(question.turn_length > 0.0 && question.turn_length.is_finite()) {
        return Err(Refusal::TurnLength(question.turn_length));
    }
    if let Some(prior) = question.prior.filter(|prior| !prior.is_sound()) {
        return Err(Refusal::Prior(prior));
    }
    let with = poses.iter().filter(|pose| pose.rotation.is_some()).count();
    if with != 0 && with != poses.len() {
        let poses = poses.len();
        return Err(Refusal::TurnsMissing { with, poses });
    }
    let length = question.turn_length;
    let free = Data {
        poses,
        length,
        hold: Hold::NOTHING,
    };
    let rows = if with > 0 { 6 } else { 3 } * poses.len();
    let enough = |unknowns: usize| match rows > unknowns && poses.len() >= FEWEST_POSES {
        true => Ok(()),
        false => Err(Refusal::TooFew {
            poses: poses.len(),
            rows,
            unknowns,
        }),
    };
    let frames = unknowns(robot, Asked::BaseAndTool, with > 0);
    if poses.len() < FEWEST_POSES {
        enough(frames.len())?;
    }
    let start = start(robot, poses, &question.flange_from_point);
    let (in_frames, _) = told_apart(&start, &frames, &free);
    let mut arm = settle(start, &in_frames, &free)?;
    enough(in_frames.len())?;
    let unknowns = unknowns(robot, question.requested, with > 0);
    let mut variance = cost(&arm, &in_frames, &free) / (rows - in_frames.len()) as f64;
    // Once for all rounds: what is kept in one and not in the next would keep a value that nobody tells.
    let (kept, redundant) = told_apart(&arm, &unknowns, &free);
    enough(kept.len())?;
    let (mut rounds, mut is_settled) = (0, false);
    // Without a prior nothing depends on the scatter, and one round is enough.
    let (inverse, given) = loop {
        let data = Data {
            hold: question
                .prior
                .map_or(Hold::NOTHING, |prior| Hold::of(&prior, variance.sqrt())),
            ..free
        };
        arm = settle(arm, &kept, &data)?;
        let (r, z) = triangle(&arm, &kept, &data).whole();
        let (_, inverse) = solve(&r, &z, 0.0).ok_or(Refusal::NotFound)?;
        let given = data.hold.reported(&kept, &inverse);
        let next = cost(&arm, &kept, &free) / (rows as f64 - given);
        is_settled |= question.prior.is_none() || (next / variance - 1.0).abs() < SAME_SCATTER;
        variance = next;
        rounds += 1;
        // What is left of perfect poses is rounding, and holds nothing.
        if is_settled || rounds == MOST_ROUNDS || variance == 0.0 {
            break (inverse, given);
        }
    };
    let covariance = inverse * variance;
    if !covariance.iter().all(|entry| entry.is_finite()) {
        return Err(Refusal::NotFound);
    }
    let estimate = |(k, unknown): (usize, &Unknown)| Estimate {
        unknown: *unknown,
        value: arm.value(unknown),
        standard_uncertainty: covariance[(k, k)].max(0.0).sqrt(),
    };
    Ok(Calibrated {
        estimates: kept.iter().enumerate().map(estimate).collect(),
        unknowns,
        redundant,
        tracker_from_base: arm.tracker_from_base,
        flange_from_point: arm.flange_from_point,
        errors: errors_of(&arm, poses),
        standard_deviation: variance.sqrt(),
        given,
        small: arm.small,
        covariance,
    })
}

fn check(robot: &Robot, poses: &[MeasuredPose]) -> Result<(), Refusal> {
    for (index, pose) in poses.iter().enumerate() {
        let what = if pose.joints.len() != robot.joints().len() {
            "another count of joints than the robot has"
        } else if !pose.is_finite() {
            "a number that is not finite"
        } else if pose.position.norm() > FARTHEST {
            "its position lies beyond 10 km"
        } else {
            continue;
        };
        return Err(Refusal::Pose { index, what });
    }
    Ok(())
}

/// The nominal arm where it stands best: the turn and shift that bring its points nearest to the measured ones (Kabsch 1976).
fn start<'a>(robot: &'a Robot, poses: &[MeasuredPose], flange_from_point: &Isometry) -> Arm<'a> {
    let base_from_point: Vec<Isometry> = poses
        .iter()
        .map(|pose| {
            let flange = forward(robot, &pose.joints).base_from_flange;
            let turn = UnitQuaternion::from_rotation_matrix(&flange.rotation);
            Isometry::from_parts(flange.translation, turn) * flange_from_point
        })
        .collect();
    let count = poses.len() as f64;
    let here = base_from_point
        .iter()
        .map(|frame| frame.translation.vector)
        .sum::<Vector3<f64>>()
        / count;
    let there = poses.iter().map(|pose| pose.position).sum::<Vector3<f64>>() / count;
    let mut spread = Matrix3::zeros();
    for (frame, pose) in base_from_point.iter().zip(poses) {
        spread += (pose.position - there) * (frame.translation.vector - here).transpose();
    }
    let parts = spread.svd(true, true);
    let turn = match (parts.u, parts.v_t) {
        (Some(u), Some(v_t)) => {
            let side = (u * v_t).determinant().signum();
            u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, side)) * v_t
        }
        _ => Matrix3::identity(),
    };
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
    let tracker_from_base = Isometry::from_parts((there - turn * here).into(), turn);
    let mut flange_from_point = *flange_from_point;
    // How a body is turned on the flange nobody knows beforehand: the first pose tells it.
    if let (Some(rotation), Some(frame)) = (poses[0].rotation, base_from_point.first()) {
        flange_from_point.rotation *= (turn * frame.rotation).inverse() * rotation;
    }
    Arm::nominal(robot, tracker_from_base, flange_from_point)
}

/// What an arm is held against.
#[derive(Clone, Copy)]
struct Data<'p> {
    poses: &'p [MeasuredPose],
    /// So many metres count as much as a radian.
    length: f64,
    hold: Hold,
}

fn triangle(arm: &Arm<'_>, unknowns: &[Unknown], data: &Data<'_>) -> Triangle {
    let mut triangle = Triangle::new(unknowns.len());
    for pose in data.poses {
        triangle.take(&arm.rows(unknowns, pose, data.length));
    }
    triangle.take(&data.hold.rows(arm, unknowns));
    triangle
}

/// Sum of squares of all residuals and of what is held, m^2.
fn cost(arm: &Arm<'_>, unknowns: &[Unknown], data: &Data<'_>) -> f64 {
    let of = |pose| {
        let (linear, angular) = arm.residual(pose);
        linear.norm_squared() + angular.map_or(0.0, |turn| turn.norm_squared() * data.length * data.length)
    };
    data.poses.iter().map(of).sum::<f64>() + data.hold.cost(arm, unknowns)
}

/// Those of `unknowns` that the poses can tell apart where `arm` stands, and the others. What is held does not matter.
fn told_apart(arm: &Arm<'_>, unknowns: &[Unknown], free: &Data<'_>) -> (Vec<Unknown>, Vec<Redundant>) {
    let (r, _) = triangle(arm, unknowns, free).whole();
    let (kept, redundant) = select(&r, unknowns);
    (kept.into_iter().map(|k| unknowns[k]).collect(), redundant)
}

/// The arm at the least sum of squares over the unknowns `kept`; an arm that never comes to rest is none.
fn settle<'a>(mut arm: Arm<'a>, kept: &[Unknown], data: &Data<'_>) -> Result<Arm<'a>, Refusal> {
    let mut least = cost(&arm, kept, data);
    let mut damping = DAMPING[0];
    let mut settled = false;
    for _ in 0..MOST_STEPS {
        let (r, z) = triangle(&arm, kept, data).whole();
        settled = true;
        while damping < DAMPING[1] {
            let (step, _) = solve(&r, &z, damping).ok_or(Refusal::NotFound)?;
            let next = arm.changed(kept, step.as_slice());
            let there = cost(&next, kept, data);
            if there <= least {
                settled = least - there <= SETTLED * least;
                (arm, least) = (next, there);
                damping *= 0.1;
                break;
            }
            damping *= 10.0;
        }
        if settled {
            break;
        }
    }
    match settled && least.is_finite() {
        true => Ok(arm),
        false => Err(Refusal::NotFound),
    }
}

fn errors_of(arm: &Arm<'_>, poses: &[MeasuredPose]) -> PoseErrors {
    let (position, turn): (Vec<_>, Vec<_>) = poses.iter().map(|pose| arm.residual(pose)).unzip();
    PoseErrors {
        position,
        turn: turn.into_iter().flatten().collect(),
    }
}
