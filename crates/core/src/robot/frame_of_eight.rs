//! A frame of eight postures at once, moved along a chain.

use super::chain::{Axis, Fixed, Motion};
use crate::numbers::{Eight, Real, Vector, put_eight, sin_cos, vector_of_eight};

/// A frame of each posture, in base: its axes, then its origin (m).
pub(super) type FrameOfEight = [[Eight; 3]; 4];

/// The base.
pub(super) fn base() -> FrameOfEight {
    let (zero, one) = (Eight::default(), Eight([1.0; 8]));
    [[one, zero, zero], [zero, one, zero], [zero, zero, one], [zero; 3]]
}

/// Moves the frame by a constant displacement.
#[inline(always)]
pub(super) fn advance<R: Real<Float = f64>>(displacement: &Fixed, frame: &mut FrameOfEight) {
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
fn load<R: Real<Float = f64>>(frame: &FrameOfEight, i: usize) -> [Vector<R>; 4] {
    let [x, y, z, origin] = frame;
    [
        vector_of_eight(x, i),
        vector_of_eight(y, i),
        vector_of_eight(z, i),
        vector_of_eight(origin, i),
    ]
}

/// Moves the frame by the motion of a joint at these chain positions (rad, m); the axis of the motion.
#[inline(always)]
pub(super) fn displace<R: Real<Float = f64>>(motion: &Motion, by: &Eight, frame: &mut FrameOfEight) -> Axis {
    match *motion {
        Motion::Along(axis, _) => {
            slide::<R>(axis, by, frame);
            axis
        }
        Motion::About(axis, _) => {
            match axis {
                Axis::X => turn::<R, 1, 2>(by, frame),
                Axis::Y => turn::<R, 2, 0>(by, frame),
                Axis::Z => turn::<R, 0, 1>(by, frame),
            }
            axis
        }
    }
}

/// Moves the frame along its own axis.
#[inline(always)]
fn slide<R: Real<Float = f64>>(axis: Axis, by: &Eight, frame: &mut FrameOfEight) {
    let direction = frame[axis.index()];
    for i in 0..8 {
        R::step();
        let moved = vector_of_eight::<R>(&direction, i).mul_add(by.at(i), vector_of_eight(&frame[3], i));
        put_eight(&mut frame[3], i, moved);
    }
}

/// Turns the axes `A` and `B` into each other.
#[inline(always)]
fn turn<R: Real<Float = f64>, const A: usize, const B: usize>(angle: &Eight, frame: &mut FrameOfEight) {
    for i in 0..8 {
        R::step();
        let (sin, cos) = sin_cos(angle.at::<R>(i));
        let (first, second) = (vector_of_eight(&frame[A], i), vector_of_eight(&frame[B], i));
        put_eight(&mut frame[A], i, second.mul_add(sin, first.scaled(cos)));
        put_eight(&mut frame[B], i, first.mul_add(-sin, second.scaled(cos)));
    }
}
