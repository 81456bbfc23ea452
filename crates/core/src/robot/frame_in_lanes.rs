//! A frame of a few postures at once, one lane each, moved along a chain.

use nalgebra::Vector3;

use super::chain::{Axis, Fixed, Motion};
use crate::numbers::{Lanes, Real, Vector, put_in_lane, sin_cos, vector_in_lane};

/// A frame of each posture, in base: its axes, then its origin (m).
pub(super) type FrameInLanes<const N: usize> = [[Lanes<N>; 3]; 4];

/// The base.
pub(super) fn base<const N: usize>() -> FrameInLanes<N> {
    let (zero, one) = (Lanes::default(), Lanes([1.0; N]));
    [[one, zero, zero], [zero, one, zero], [zero, zero, one], [zero; 3]]
}

/// Moves the frame by a constant displacement.
#[inline(always)]
pub(super) fn advance<R: Real<Float = f64>, const N: usize>(
    displacement: &Fixed,
    frame: &mut FrameInLanes<N>,
) {
    let (translation, rotation) = displacement.parts();
    translate::<R, N>(&translation, frame);
    let Some(rotation) = rotation else { return };
    let columns: [Vector<R>; 3] = [
        Vector::of(&rotation.column(0).into_owned()),
        Vector::of(&rotation.column(1).into_owned()),
        Vector::of(&rotation.column(2).into_owned()),
    ];
    for i in 0..N {
        R::step();
        let [x, y, z, _] = load::<R, N>(frame, i);
        put_in_lane(&mut frame[0], i, combined([x, y, z], columns[0]));
        put_in_lane(&mut frame[1], i, combined([x, y, z], columns[1]));
        put_in_lane(&mut frame[2], i, combined([x, y, z], columns[2]));
    }
}

/// Moves the frame by a constant translation (m) along its axes; most are along one of them.
#[inline(always)]
pub(super) fn translate<R: Real<Float = f64>, const N: usize>(
    by: &Vector3<f64>,
    frame: &mut FrameInLanes<N>,
) {
    for axis in 0..3 {
        if by[(axis + 1) % 3] == 0.0 && by[(axis + 2) % 3] == 0.0 {
            let (direction, length) = (frame[axis], R::of(by[axis]));
            for i in 0..N {
                R::step();
                let along = vector_in_lane::<R, N>(&direction, i).scaled(length);
                let origin = vector_in_lane(&frame[3], i);
                put_in_lane(&mut frame[3], i, along + origin);
            }
            return;
        }
    }
    let along = Vector::<R>::of(by);
    for i in 0..N {
        R::step();
        let [x, y, z, origin] = load::<R, N>(frame, i);
        put_in_lane(&mut frame[3], i, combined([x, y, z], along) + origin);
    }
}

/// A vector with these components along the axes.
#[inline(always)]
fn combined<R: Real>([x, y, z]: [Vector<R>; 3], along: Vector<R>) -> Vector<R> {
    z.mul_add(along.z, y.mul_add(along.y, x.scaled(along.x)))
}

#[inline(always)]
fn load<R: Real<Float = f64>, const N: usize>(frame: &FrameInLanes<N>, i: usize) -> [Vector<R>; 4] {
    let [x, y, z, origin] = frame;
    [
        vector_in_lane(x, i),
        vector_in_lane(y, i),
        vector_in_lane(z, i),
        vector_in_lane(origin, i),
    ]
}

/// Moves the frame by the motion of a joint at these chain positions (rad, m); the axis of the motion.
#[inline(always)]
pub(super) fn displace<R: Real<Float = f64>, const N: usize>(
    motion: &Motion,
    by: &Lanes<N>,
    frame: &mut FrameInLanes<N>,
) -> Axis {
    match *motion {
        Motion::Along(axis, _) => {
            slide::<R, N>(axis, by, frame);
            axis
        }
        Motion::About(axis, _) => {
            match axis {
                Axis::X => turn::<R, 1, 2, N>(by, frame),
                Axis::Y => turn::<R, 2, 0, N>(by, frame),
                Axis::Z => turn::<R, 0, 1, N>(by, frame),
            }
            axis
        }
    }
}

/// Moves the frame along its own axis.
#[inline(always)]
fn slide<R: Real<Float = f64>, const N: usize>(axis: Axis, by: &Lanes<N>, frame: &mut FrameInLanes<N>) {
    let direction = frame[axis.index()];
    for i in 0..N {
        R::step();
        let moved = vector_in_lane::<R, N>(&direction, i).mul_add(by.at(i), vector_in_lane(&frame[3], i));
        put_in_lane(&mut frame[3], i, moved);
    }
}

/// Turns the axes `A` and `B` into each other.
#[inline(always)]
fn turn<R: Real<Float = f64>, const A: usize, const B: usize, const N: usize>(
    angle: &Lanes<N>,
    frame: &mut FrameInLanes<N>,
) {
    for i in 0..N {
        R::step();
        let (sin, cos) = sin_cos(angle.at::<R>(i));
        let (first, second) = (vector_in_lane(&frame[A], i), vector_in_lane(&frame[B], i));
        put_in_lane(&mut frame[A], i, second.mul_add(sin, first.scaled(cos)));
        put_in_lane(&mut frame[B], i, first.mul_add(-sin, second.scaled(cos)));
    }
}
