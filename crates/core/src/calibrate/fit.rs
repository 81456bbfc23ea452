//! The most likely geometry of an arm, from measured poses.
//!
//! Levenberg and Marquardt in two rounds: base and tool only, from the best rotation of the flange positions onto the
//! measured ones; then all unknowns that `select` keeps there. All poses have equal weight. With `m` rows, `p` unknowns
//! kept and residuals `r` at the end:
//!
//! ```text
//! s^2 = |r|^2 / (m - p)        cov = s^2 (J'J)^-1        standard uncertainty = sqrt(diagonal)
//! ```
//!
//! With a [prior](super::prior) small motions are pulled towards zero, and `p` is the effective number of parameters.
//!
//! These uncertainties treat the remaining error of the geometry (gravity, gears, tracker) as noise that is independent
//! between poses.
//!
//! Source: Mooring, Roth and Driels 1991; Everett, Driels and Mooring 1987; `docs/theory/calibration.md`.

use nalgebra::{DMatrix, Matrix3, Matrix3xX, Unit, UnitQuaternion, Vector3};

use super::arm::Arm;
use super::errors::PoseErrors;
use super::pose::MeasuredPose;
use super::prior::{Prior, PriorWeights};
use super::select::{Redundant, select};
use super::unknown::{ParameterLocation, ParameterSet, Unknown, uncertain_motions, unknowns};
use crate::frame::Isometry;
use crate::least_squares::{Problem, Triangle, descend, solve, superposed};
use crate::robot::chain::{Amount, Motion};
use crate::robot::forward::forward;
use crate::robot::{Robot, RobotError, UncertainGeometry};

/// Rounds of scatter and geometry with a prior, and the change of the variance that ends them.
const MOST_ROUNDS: usize = 40;
const SAME_SCATTER: f64 = 1e-6;
/// Minimum number of poses: with fewer, base and tool alone fit any measurement.
const FEWEST_POSES: usize = 4;
/// Greatest coordinate that a tracker measures, m.
const FARTHEST: f64 = 1e4;

/// Input of a calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// The unknowns of the chain.
    pub requested: ParameterSet,
    /// Approximate position of the measured point on the flange; its position if the base alone is unknown.
    pub flange_from_point: Isometry,
    /// Weight of rotations: metres per radian.
    pub turn_length: f64,
    /// Prior knowledge of the small motions of the chain; `None` for none.
    pub prior: Option<Prior>,
}

/// Why a calibration is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// Too few poses.
    #[error("{poses} poses with {rows} readings are not sufficient for {unknowns} unknowns")]
    TooFew {
        /// Poses given.
        poses: usize,
        /// Numbers measured.
        rows: usize,
        /// Unknowns.
        unknowns: usize,
    },
    /// A pose with another number of joints than the robot, or with a number that is not valid.
    #[error("pose number {}: {what}", .index + 1)]
    Pose {
        /// From 0.
        index: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// Some poses with a rotation and others without.
    #[error("{with} of {poses} poses have a measured rotation: measure it in all of them or in none")]
    TurnsMissing {
        /// Poses with it.
        with: usize,
        /// All.
        poses: usize,
    },
    /// A weight of rotations that is not above 0.
    #[error("the weight of rotations, {0} m per radian, must be above 0")]
    TurnLength(f64),
    /// A prior that is not positive and finite.
    #[error("the prior of {} m and {} rad is not valid: both must be above 0", .0.length, .0.angle)]
    Prior(Prior),
    /// The search diverged or found no independent unknown.
    #[error("no geometry near the nominal one was found; do these poses belong to this robot?")]
    NotFound,
}

/// An estimated unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The unknown.
    pub unknown: Unknown,
    /// m or rad; 0 of base and tool, whose frames include it.
    pub value: f64,
    /// Same unit.
    pub standard_uncertainty: f64,
}

/// The estimated geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibrated {
    /// The estimates, in the order of the unknowns.
    pub estimates: Vec<Estimate>,
    /// Covariance of the estimates, in their order, m and rad.
    pub covariance: DMatrix<f64>,
    /// All unknowns.
    pub unknowns: Vec<Unknown>,
    /// Unknowns that stay at their nominal value; indices are of `unknowns`.
    pub redundant: Vec<Redundant>,
    /// The base in the tracker frame.
    pub tracker_from_base: Isometry,
    /// The point on the flange; rotated only if rotations were measured.
    pub flange_from_point: Isometry,
    /// Errors at the poses of the fit.
    pub errors: PoseErrors,
    /// `s`, m: standard deviation of a single reading about the estimated geometry.
    pub standard_deviation: f64,
    /// Effective number of parameters: that of the estimates without a prior.
    pub effective_parameters: f64,
    /// Of each joint but the last, m and rad.
    small: Vec<[f64; 6]>,
}

impl Calibrated {
    /// The estimated motions right after joint `index`.
    pub fn motions_after(&self, index: usize) -> Vec<Motion> {
        let here = self
            .estimates
            .iter()
            .filter(|estimate| estimate.unknown.place == ParameterLocation::After(index));
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

    /// `robot` with only this geometry: no compliance, no frames.
    ///
    /// # Errors
    /// A chain that exceeds the range of a robot.
    pub fn bare_robot(&self, robot: &Robot) -> Result<Robot, RobotError> {
        Robot::new(robot.name(), self.motions(robot), robot.joints().to_vec())
    }

    /// Uncertainty of the small motions of the chain; `None` if none was estimated.
    pub fn uncertainty(&self) -> Option<UncertainGeometry> {
        let unknowns = self.estimates.iter().map(|estimate| estimate.unknown);
        uncertain_motions(unknowns.enumerate(), &self.covariance)
    }

    /// Derivatives of the measured position (axes of the tracker) by each of the estimates at these joint positions, one column each.
    pub(crate) fn derivatives(&self, robot: &Robot, joints: &[f64]) -> Matrix3xX<f64> {
        let unknowns: Vec<Unknown> = self.estimates.iter().map(|estimate| estimate.unknown).collect();
        let pose = MeasuredPose {
            joints: joints.to_vec(),
            position: Vector3::zeros(),
            rotation: None,
        };
        let rows = self.arm(robot).rows(&unknowns, &pose, 1.0);
        Matrix3xX::from_fn(unknowns.len(), |row, column| rows[(row, column)])
    }

    /// The calibrated arm between its frames.
    fn arm<'a>(&self, robot: &'a Robot) -> Arm<'a> {
        let mut arm = Arm::nominal(robot, self.tracker_from_base, self.flange_from_point);
        arm.small.clone_from(&self.small);
        arm
    }

    /// Errors of other poses of `robot`, predicted by this geometry.
    ///
    /// # Errors
    /// A pose of another robot, or with a number that is not valid.
    pub fn errors_of(&self, robot: &Robot, poses: &[MeasuredPose]) -> Result<PoseErrors, Refusal> {
        check(robot, poses)?;
        Ok(errors_of(&self.arm(robot), poses))
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
        prior: PriorWeights::NONE,
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
    let frames = match question.requested {
        ParameterSet::Base => ParameterSet::Base,
        _ => ParameterSet::BaseAndTool,
    };
    let frames = unknowns(robot, frames, with > 0);
    if poses.len() < FEWEST_POSES {
        enough(frames.len())?;
    }
    let start = start(robot, poses, question);
    let (in_frames, _) = identifiable(&start, &frames, &free);
    let mut arm = settle(start, &in_frames, &free)?;
    enough(in_frames.len())?;
    let unknowns = unknowns(robot, question.requested, with > 0);
    let mut variance = cost(&arm, &in_frames, &free) / (rows - in_frames.len()) as f64;
    // Once for all rounds: an unknown kept in one and not in the next would retain a value without information.
    let (kept, redundant) = identifiable(&arm, &unknowns, &free);
    enough(kept.len())?;
    let (mut rounds, mut is_settled) = (0, false);
    // Without a prior nothing depends on the scatter, and one round is enough.
    let (inverse, effective_parameters) = loop {
        let data = Data {
            prior: question.prior.map_or(PriorWeights::NONE, |prior| {
                PriorWeights::of(&prior, variance.sqrt())
            }),
            ..free
        };
        arm = settle(arm, &kept, &data)?;
        let (r, z) = triangle(&arm, &kept, &data).whole();
        let (_, inverse) = solve(&r, &z, 0.0).ok_or(Refusal::NotFound)?;
        let effective_parameters = data.prior.effective_parameters(&kept, &inverse);
        let next = cost(&arm, &kept, &free) / (rows as f64 - effective_parameters);
        is_settled |= question.prior.is_none() || (next / variance - 1.0).abs() < SAME_SCATTER;
        variance = next;
        rounds += 1;
        // The residual of perfect poses is rounding, and gives no weight to the prior.
        if is_settled || rounds == MOST_ROUNDS || variance == 0.0 {
            break (inverse, effective_parameters);
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
        effective_parameters,
        small: arm.small,
        covariance,
    })
}

fn check(robot: &Robot, poses: &[MeasuredPose]) -> Result<(), Refusal> {
    for (index, pose) in poses.iter().enumerate() {
        let what = if pose.joints.len() != robot.joints().len() {
            "it has another number of joints than the robot"
        } else if !pose.is_finite() {
            "it contains a number that is not finite"
        } else if pose.position.norm() > FARTHEST {
            "its position is beyond 10 km"
        } else {
            continue;
        };
        return Err(Refusal::Pose { index, what });
    }
    Ok(())
}

/// The nominal arm, placed by the rotation and shift that bring its points nearest to the measured ones (Kabsch 1976), and by the rotation about the line in which
/// these spread most that fits best.
fn start<'a>(robot: &'a Robot, poses: &[MeasuredPose], question: &Question) -> Arm<'a> {
    let flange_from_point = &question.flange_from_point;
    let base_from_point: Vec<Isometry> = poses
        .iter()
        .map(|pose| {
            let flange = forward(robot, &pose.joints).base_from_flange;
            let turn = UnitQuaternion::from_rotation_matrix(&flange.rotation);
            Isometry::from_parts(flange.translation, turn) * flange_from_point
        })
        .collect();
    let here: Vec<Vector3<f64>> = base_from_point
        .iter()
        .map(|frame| frame.translation.vector)
        .collect();
    let there: Vec<Vector3<f64>> = poses.iter().map(|pose| pose.position).collect();
    let nearest = superposed(&here, &there, &vec![1.0; poses.len()]);
    let middle = there.iter().sum::<Vector3<f64>>() / there.len() as f64;
    let along = principal_direction(&there, middle);
    // Points near a line leave the rotation about it open: the orientations decide, or the rest of the positions.
    let rotated = (0..ROTATIONS).map(|k| {
        let angle = std::f64::consts::TAU * k as f64 / ROTATIONS as f64;
        let about = UnitQuaternion::from_axis_angle(&along, angle);
        let shift = about * (nearest.translation.vector - middle) + middle;
        let tracker_from_base = Isometry::from_parts(shift.into(), about * nearest.rotation);
        let mut flange_from_point = *flange_from_point;
        // The rotation of the body on the flange is not known beforehand: it is taken from the first pose.
        if question.requested != ParameterSet::Base
            && let (Some(rotation), Some(frame)) = (poses[0].rotation, base_from_point.first())
        {
            flange_from_point.rotation *= (tracker_from_base.rotation * frame.rotation).inverse() * rotation;
        }
        Arm::nominal(robot, tracker_from_base, flange_from_point)
    });
    let data = Data {
        poses,
        length: question.turn_length,
        prior: PriorWeights::NONE,
    };
    let costed = rotated.map(|arm| (cost(&arm, &[], &data), arm));
    let least = costed.min_by(|a, b| a.0.total_cmp(&b.0));
    least.map_or_else(
        || Arm::nominal(robot, nearest, *flange_from_point),
        |(_, arm)| arm,
    )
}

/// Rotations about the line of the points that are tried at the start.
const ROTATIONS: usize = 24;

/// The direction in which points spread most.
fn principal_direction(points: &[Vector3<f64>], middle: Vector3<f64>) -> Unit<Vector3<f64>> {
    let spread: Matrix3<f64> = points
        .iter()
        .map(|point| (point - middle) * (point - middle).transpose())
        .sum();
    let parts = spread.symmetric_eigen();
    Unit::new_normalize(parts.eigenvectors.column(parts.eigenvalues.imax()).into_owned())
}

/// The data of the fit.
#[derive(Clone, Copy)]
struct Data<'p> {
    poses: &'p [MeasuredPose],
    /// Weight of rotations: metres per radian.
    length: f64,
    prior: PriorWeights,
}

fn triangle(arm: &Arm<'_>, unknowns: &[Unknown], data: &Data<'_>) -> Triangle {
    let mut triangle = Triangle::new(unknowns.len());
    for pose in data.poses {
        triangle.take(&arm.rows(unknowns, pose, data.length));
    }
    triangle.take(&data.prior.rows(arm, unknowns));
    triangle
}

/// Sum of squares of all residuals and of the prior, m^2.
fn cost(arm: &Arm<'_>, unknowns: &[Unknown], data: &Data<'_>) -> f64 {
    let of = |pose| {
        let (linear, angular) = arm.residual(pose);
        linear.norm_squared() + angular.map_or(0.0, |turn| turn.norm_squared() * data.length * data.length)
    };
    data.poses.iter().map(of).sum::<f64>() + data.prior.cost(arm, unknowns)
}

/// The identifiable unknowns of `unknowns` at `arm`, and the others. The prior has no effect on this.
fn identifiable(arm: &Arm<'_>, unknowns: &[Unknown], free: &Data<'_>) -> (Vec<Unknown>, Vec<Redundant>) {
    let (r, _) = triangle(arm, unknowns, free).whole();
    let (kept, redundant) = select(&r, unknowns);
    (kept.into_iter().map(|k| unknowns[k]).collect(), redundant)
}

/// The arm with the least sum of squares over the unknowns `kept`; an error if it does not converge.
fn settle<'a>(arm: Arm<'a>, kept: &[Unknown], data: &Data<'_>) -> Result<Arm<'a>, Refusal> {
    let robot = std::marker::PhantomData;
    descend(&Geometry { kept, data, robot }, arm).ok_or(Refusal::NotFound)
}

/// The geometry of an arm as a problem of least squares.
struct Geometry<'p, 'a> {
    kept: &'p [Unknown],
    data: &'p Data<'p>,
    robot: std::marker::PhantomData<&'a Robot>,
}

impl<'a> Problem for Geometry<'_, 'a> {
    type State = Arm<'a>;

    fn triangle(&self, arm: &Arm<'a>) -> Triangle {
        triangle(arm, self.kept, self.data)
    }

    fn cost(&self, arm: &Arm<'a>) -> f64 {
        cost(arm, self.kept, self.data)
    }

    fn changed(&self, arm: &Arm<'a>, by: &[f64]) -> Arm<'a> {
        arm.changed(self.kept, by)
    }
}

fn errors_of(arm: &Arm<'_>, poses: &[MeasuredPose]) -> PoseErrors {
    let (position, turn): (Vec<_>, Vec<_>) = poses.iter().map(|pose| arm.residual(pose)).unzip();
    PoseErrors {
        position,
        turn: turn.into_iter().flatten().collect(),
    }
}
