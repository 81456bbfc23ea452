//! Forward kinematics of eight postures at once, one lane each.

use nalgebra::{IsometryMatrix3, Matrix3, Rotation3, Vector3};

use super::chain::{Axis, Fixed, Motion};
use super::forward::Frames;
use super::model::Robot;
use crate::numbers::{Eight, Real, Vector, put_eight, sin_cos, vector_of_eight};

/// One frame of each posture, in base: its axes, then its origin (m).
pub(super) type Frame = [[Eight; 3]; 4];

/// Frames of every joint and the flange.
#[derive(Clone, Debug)]
pub(super) struct FramesOfEight {
    joints: Vec<Frame>,
    flange: Frame,
}

impl FramesOfEight {
    /// Working memory for a chain with this many joints.
    pub fn for_joints(count: usize) -> FramesOfEight {
        FramesOfEight {
            joints: vec![Frame::default(); count],
            flange: Frame::default(),
        }
    }

    /// The flange.
    pub fn flange(&self) -> &Frame {
        &self.flange
    }

    /// The frames of posture `lane`.
    pub fn get(&self, lane: usize, frames: &mut Frames) {
        for (to, from) in frames.base_from_joint.iter_mut().zip(&self.joints) {
            *to = isometry(from, lane);
        }
        frames.base_from_flange = isometry(&self.flange, lane);
    }

    /// Forward kinematics of `robot` from joint positions (rad, m), one entry per joint.
    #[inline(always)]
    pub fn find<R: Real<Float = f64>>(&mut self, robot: &Robot, joints: &[Eight]) {
        let chain = robot.chain();
        // Apart from the frames: so short a loop is vectorised only where its results cannot overlap what it reads.
        let mut frame = base();
        for (index, (link, found)) in chain.links().iter().zip(&mut self.joints).enumerate() {
            let theta = theta_of::<R>(robot, index, joints);
            advance::<R>(&link.before, &mut frame);
            match link.motion {
                Motion::Along(axis, _) => slide::<R>(axis, &theta, &mut frame),
                Motion::About(Axis::X, _) => turn::<R, 1, 2>(&theta, &mut frame),
                Motion::About(Axis::Y, _) => turn::<R, 2, 0>(&theta, &mut frame),
                Motion::About(Axis::Z, _) => turn::<R, 0, 1>(&theta, &mut frame),
            }
            *found = frame;
        }
        advance::<R>(chain.last_joint_from_flange(), &mut frame);
        self.flange = frame;
    }
}

/// [`Robot::theta`] of eight postures.
#[inline(always)]
fn theta_of<R: Real<Float = f64>>(robot: &Robot, index: usize, joints: &[Eight]) -> Eight {
    let joint = &robot.joints()[index];
    let mut theta = joints[index];
    for coupling in &joint.coupling {
        theta.add::<R>(coupling.factor, &joints[coupling.joint]);
    }
    let (sign, zero) = (R::of(joint.sign.factor()), R::of(joint.zero_offset));
    for i in 0..8 {
        R::step();
        theta.set(i, sign.mul_add(theta.at(i), zero));
    }
    theta
}

fn isometry([x, y, z, origin]: &Frame, lane: usize) -> IsometryMatrix3<f64> {
    let of = |[x, y, z]: &[Eight; 3]| Vector3::new(x.0[lane], y.0[lane], z.0[lane]);
    let axes = Matrix3::from_columns(&[of(x), of(y), of(z)]);
    IsometryMatrix3::from_parts(of(origin).into(), Rotation3::from_matrix_unchecked(axes))
}

/// The base.
fn base() -> Frame {
    let (zero, one) = (Eight::default(), Eight([1.0; 8]));
    [[one, zero, zero], [zero, one, zero], [zero, zero, one], [zero; 3]]
}

/// Moves the frame by a constant displacement.
#[inline(always)]
fn advance<R: Real<Float = f64>>(displacement: &Fixed, frame: &mut Frame) {
    let (translation, rotation) = displacement.parts();
    let along = Vector::<R>::of(&translation);
    for i in 0..8 {
        R::step();
        let [x, y, z, origin] = load::<R>(frame, i);
        put_eight(&mut frame[3], i, combined([x, y, z], along) + origin);
    }
    let Some(rotation) = rotation else { return };
    let columns: [Vector<R>; 3] = [
        Vector::of(&rotation.column(0).into_owned()),
        Vector::of(&rotation.column(1).into_owned()),
        Vector::of(&rotation.column(2).into_owned()),
    ];
    for i in 0..8 {
        R::step();
        let [x, y, z, _] = load::<R>(frame, i);
        put_eight(&mut frame[0], i, combined([x, y, z], columns[0]));
        put_eight(&mut frame[1], i, combined([x, y, z], columns[1]));
        put_eight(&mut frame[2], i, combined([x, y, z], columns[2]));
    }
}

/// A vector with these components along the axes.
#[inline(always)]
fn combined<R: Real>([x, y, z]: [Vector<R>; 3], along: Vector<R>) -> Vector<R> {
    z.mul_add(along.z, y.mul_add(along.y, x.scaled(along.x)))
}

#[inline(always)]
fn load<R: Real<Float = f64>>(frame: &Frame, i: usize) -> [Vector<R>; 4] {
    let [x, y, z, origin] = frame;
    [
        vector_of_eight(x, i),
        vector_of_eight(y, i),
        vector_of_eight(z, i),
        vector_of_eight(origin, i),
    ]
}

/// Moves the frame along its own axis.
#[inline(always)]
fn slide<R: Real<Float = f64>>(axis: Axis, by: &Eight, frame: &mut Frame) {
    let direction = frame[axis.index()];
    for i in 0..8 {
        R::step();
        let moved = vector_of_eight::<R>(&direction, i).mul_add(by.at(i), vector_of_eight(&frame[3], i));
        put_eight(&mut frame[3], i, moved);
    }
}

/// Turns the axes `A` and `B` into each other.
#[inline(always)]
fn turn<R: Real<Float = f64>, const A: usize, const B: usize>(angle: &Eight, frame: &mut Frame) {
    for i in 0..8 {
        R::step();
        let (sin, cos) = sin_cos(angle.at::<R>(i));
        let (first, second) = (vector_of_eight(&frame[A], i), vector_of_eight(&frame[B], i));
        put_eight(&mut frame[A], i, second.mul_add(sin, first.scaled(cos)));
        put_eight(&mut frame[B], i, first.mul_add(-sin, second.scaled(cos)));
    }
}
