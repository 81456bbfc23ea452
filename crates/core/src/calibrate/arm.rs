//! The chain with a small displacement after each joint, from the tracker to the measured point.
//!
//! ```text
//! tracker_from_point = tracker_from_base  A_1 E_1 A_2 E_2 ... A_n  flange_from_point
//! E_i = Tx Ty Tz Rx Ry Rz of joint i
//! ```
//!
//! A step along or about the axis `z` through `o` moves the point `p` by `z` or `z x (p - o)`, and turns it by 0 or
//! `z`, exactly, whatever its size: these are the columns. Base and tool are changed by twists in their own axes.

use nalgebra::{DMatrix, Matrix3, UnitQuaternion, Vector3};

use super::pose::MeasuredPose;
use super::unknown::{ParameterLocation, Unknown};
use crate::frame::{Isometry, turn_between};
use crate::robot::Robot;
use crate::robot::chain::{Amount, Motion};

/// The state of the fit.
#[derive(Clone, Debug)]
pub(crate) struct Arm<'a> {
    robot: &'a Robot,
    /// The unknowns after joints, m or rad: six per joint.
    pub small: Vec<[f64; 6]>,
    pub tracker_from_base: Isometry,
    pub flange_from_point: Isometry,
}

/// A step of the chain from the tracker to the point.
struct Step {
    axis: Vector3<f64>,
    origin: Vector3<f64>,
    turns: bool,
}

/// Where the point is, and the steps of all small motions on the way, by joint.
struct Reached {
    position: Vector3<f64>,
    axes: Matrix3<f64>,
    steps: Vec<Step>,
}

impl<'a> Arm<'a> {
    /// The nominal arm, between these two frames.
    pub fn nominal(robot: &'a Robot, tracker_from_base: Isometry, flange_from_point: Isometry) -> Arm<'a> {
        Arm {
            robot,
            small: vec![[0.0; 6]; robot.joints().len().saturating_sub(1)],
            tracker_from_base,
            flange_from_point,
        }
    }

    /// The position (m) and the axes of the point with these joints, in the tracker frame.
    pub fn predicted(&self, joints: &[f64]) -> (Vector3<f64>, Matrix3<f64>) {
        let reached = self.reached(joints);
        (reached.position, reached.axes)
    }

    fn reached(&self, joints: &[f64]) -> Reached {
        let mut axes = self.tracker_from_base.rotation.to_rotation_matrix().into_inner();
        let mut origin = self.tracker_from_base.translation.vector;
        let mut steps = Vec::with_capacity(6 * self.small.len());
        for motion in self.robot.chain().motions() {
            match motion.amount() {
                Amount::Constant(by) => motion.advance(by, &mut axes, &mut origin),
                Amount::Joint(joint) => {
                    motion.advance(self.robot.theta(joint, joints), &mut axes, &mut origin);
                    let Some(small) = self.small.get(joint) else {
                        continue;
                    };
                    for (component, by) in small.iter().enumerate() {
                        let unknown = Unknown {
                            place: ParameterLocation::After(joint),
                            component,
                        };
                        let step = unknown.motion(*by);
                        steps.push(Step {
                            axis: axes.column(unknown.axis().index()).into_owned(),
                            origin,
                            turns: matches!(step, Motion::About(..)),
                        });
                        step.advance(*by, &mut axes, &mut origin);
                    }
                }
            }
        }
        let point = &self.flange_from_point;
        Reached {
            position: origin + axes * point.translation.vector,
            axes: axes * point.rotation.to_rotation_matrix().into_inner(),
            steps,
        }
    }

    /// Measured less predicted: position (m), and rotation (rad) where that was measured, in the axes of the tracker.
    pub fn residual(&self, pose: &MeasuredPose) -> (Vector3<f64>, Option<Vector3<f64>>) {
        let (position, axes) = self.predicted(&pose.joints);
        let turn =
            |rotation: UnitQuaternion<f64>| turn_between(&axes, &rotation.to_rotation_matrix().into_inner());
        (pose.position - position, pose.rotation.map(turn))
    }

    /// The rows of a pose: one column per unknown, the residual last. Rotations are weighted by `length` (m).
    pub fn rows(&self, unknowns: &[Unknown], pose: &MeasuredPose, length: f64) -> DMatrix<f64> {
        let reached = self.reached(&pose.joints);
        let (linear, angular) = self.residual(pose);
        let height = if angular.is_some() { 6 } else { 3 };
        let mut rows = DMatrix::zeros(height, unknowns.len() + 1);
        let mut put = |column: usize, linear: Vector3<f64>, angular: Vector3<f64>| {
            rows.fixed_view_mut::<3, 1>(0, column).copy_from(&linear);
            if height == 6 {
                rows.fixed_view_mut::<3, 1>(3, column)
                    .copy_from(&(angular * length));
            }
        };
        let base_axes = self.tracker_from_base.rotation.to_rotation_matrix().into_inner();
        for (column, unknown) in unknowns.iter().enumerate() {
            let axis = unknown.axis().index();
            let step = match unknown.place {
                ParameterLocation::After(joint) => &reached.steps[6 * joint + unknown.component],
                ParameterLocation::Base => &Step {
                    axis: base_axes.column(axis).into_owned(),
                    origin: self.tracker_from_base.translation.vector,
                    turns: unknown.turns(),
                },
                ParameterLocation::Tool => &Step {
                    axis: reached.axes.column(axis).into_owned(),
                    origin: reached.position,
                    turns: unknown.turns(),
                },
            };
            match step.turns {
                true => put(
                    column,
                    step.axis.cross(&(reached.position - step.origin)),
                    step.axis,
                ),
                false => put(column, step.axis, Vector3::zeros()),
            }
        }
        put(unknowns.len(), linear, angular.unwrap_or_default());
        rows
    }

    /// Value of a small motion of the chain, m or rad; 0 of base and tool, whose frames include it.
    pub fn value(&self, unknown: &Unknown) -> f64 {
        match unknown.place {
            ParameterLocation::After(joint) => self.small[joint][unknown.component],
            ParameterLocation::Base | ParameterLocation::Tool => 0.0,
        }
    }

    /// This arm with its unknowns changed by these amounts.
    pub fn changed(&self, unknowns: &[Unknown], by: &[f64]) -> Arm<'a> {
        let mut arm = self.clone();
        let mut twists = [[0.0; 6]; 2];
        for (unknown, by) in unknowns.iter().zip(by) {
            match unknown.place {
                ParameterLocation::After(joint) => arm.small[joint][unknown.component] += by,
                ParameterLocation::Base => twists[0][unknown.component] += by,
                ParameterLocation::Tool => twists[1][unknown.component] += by,
            }
        }
        arm.tracker_from_base *= displacement(twists[0]);
        arm.flange_from_point *= displacement(twists[1]);
        arm
    }
}

/// The screw motion by a twist `(v, w)` over unit time: rotation `exp [w]`, translation `(1 + b [w] + c [w]^2) v` with
/// `b = (1 - cos a)/a^2`, `c = (a - sin a)/a^3`, `a = |w|` (Murray, Li and Sastry 1994, section 2.3.2). A rotation about a
/// line far from the origin keeps its points however large it is: poses near a line leave that rotation almost free.
fn displacement([x, y, z, a, b, c]: [f64; 6]) -> Isometry {
    let (linear, angular) = (Vector3::new(x, y, z), Vector3::new(a, b, c));
    let angle = angular.norm();
    let half = (0.5 * angle).sin();
    let [first, second] = match angle < SMALL_ANGLE {
        true => [0.5, 1.0 / 6.0],
        false => [
            2.0 * (half / angle).powi(2),
            (angle - angle.sin()) / angle.powi(3),
        ],
    };
    let once = angular.cross(&linear);
    Isometry::from_parts(
        (linear + first * once + second * angular.cross(&once)).into(),
        UnitQuaternion::from_scaled_axis(angular),
    )
}

/// Below this angle the series of the screw motion is exact to rounding, rad.
const SMALL_ANGLE: f64 = 1e-5;

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::super::unknown::{ParameterSet, unknowns};
    use super::*;
    use crate::arms;

    #[test]
    fn columns_match_finite_differences() {
        let mut stream = arms::Stream(11);
        for robot in [arms::mh12(), arms::other::on_rail(&arms::mh12())] {
            let frame = Isometry::new(Vector3::new(1.0, -2.0, 0.3), Vector3::new(0.4, 1.1, -2.0));
            let tool = Isometry::new(Vector3::new(0.02, 0.03, 0.2), Vector3::new(0.2, -0.4, 0.9));
            let requested = unknowns(&robot, ParameterSet::Geometry, true);
            let some: Vec<f64> = (0..requested.len())
                .map(|k| 1e-2 * (k as f64 * 1.7).sin())
                .collect();
            let arm = Arm::nominal(&robot, frame, tool).changed(&requested, &some);
            let joints = stream.joints(&robot);
            let (position, axes) = arm.predicted(&joints);
            let turned = nalgebra::Rotation3::from_matrix_unchecked(axes);
            let pose = MeasuredPose {
                joints,
                position,
                rotation: Some(UnitQuaternion::from_rotation_matrix(&turned)),
            };
            let rows = arm.rows(&requested, &pose, 0.5);
            for column in 0..requested.len() {
                let step = 1e-5;
                let mut by = vec![0.0; requested.len()];
                by[column] = step;
                // The residual decreases as the prediction increases.
                let side = |sign: f64| {
                    let by: Vec<f64> = by.iter().map(|b| sign * b).collect();
                    arm.changed(&requested, &by).rows(&[], &pose, 0.5)
                };
                let slope = (side(-1.0) - side(1.0)) / (2.0 * step);
                // Rounding of metres over the step, and its square.
                assert!(
                    (slope - rows.columns(column, 1)).norm() < 1e-9,
                    "{:?}",
                    requested[column]
                );
            }
        }
    }

    #[test]
    fn a_twist_about_a_line_keeps_its_points_and_is_the_limit_of_many_small_ones() {
        let (through, turn) = (Point3::new(0.4, -2.0, 1.1), Vector3::new(0.3, 0.8, -0.5));
        let moment = through.coords.cross(&turn);
        let about = displacement([moment.x, moment.y, moment.z, turn.x, turn.y, turn.z]);
        for along in [0.0, 1.0, -3.0] {
            let point = through + turn * along;
            assert!((about * point - point).norm() < 1e-14);
        }
        let twist = [0.2, -0.1, 0.4, 0.3, 0.8, -0.5];
        let small = displacement(twist.map(|part| part / 1e5));
        let many = (0..100_000).fold(Isometry::identity(), |frame, _| frame * small);
        let once = displacement(twist);
        assert!((many.translation.vector - once.translation.vector).norm() < 1e-9);
        assert!(many.rotation.angle_to(&once.rotation) < 1e-9);
    }
}
