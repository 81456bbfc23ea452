//! Tool poses to aims: into the arm's axes, block by block.

use nalgebra::{Matrix3, Vector3};

use super::prepared::Prepared;
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, put, vector};

/// Where the tool shall be, in the arm's axes.
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) struct Aim<R> {
    /// The tool centre point.
    pub tcp: Vector<R>,
    /// From the wrist centre to the TCP.
    pub lever: Vector<R>,
    /// Axis 6.
    pub out: Vector<R>,
    /// Axis 5 with joint 6 at zero.
    pub second: Vector<R>,
}

/// Aims of a block: TCP, lever, axis 6, axis 5.
pub(in crate::kernel::lanes) type Aims<T> = Planes<T, 12>;

/// The aim of point `i`. Where the orientation is `STILL` all but the TCP is that of point 0.
#[inline(always)]
pub(in crate::kernel::lanes) fn aim<R: Real, const STILL: bool>(aims: &Aims<R::Float>, i: usize) -> Aim<R> {
    let k = if STILL { 0 } else { i };
    Aim {
        tcp: vector(&aims[0..3], i),
        lever: vector(&aims[3..6], k),
        out: vector(&aims[6..9], k),
        second: vector(&aims[9..12], k),
    }
}

/// Which axis 5 an aim contains.
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) enum Second {
    /// With joint 6 at zero: positions want it.
    AtZero,
    /// With joint 6 in the middle of its range: required for limits as cosines.
    InTheMiddle,
}

/// Base positions of the TCP into the arm's axes; `TURNED` where these are not those of the base.
pub(in crate::kernel::lanes) struct Places<'a, T, const TURNED: bool> {
    pub prepared: &'a Prepared,
    pub at: [&'a Plane<T>; 3],
    pub aims: &'a mut Aims<T>,
}

impl<T: Float, const TURNED: bool> Work<T> for Places<'_, T, TURNED> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let into = IntoArm::<R>::new(self.prepared);
        for i in 0..BLOCK {
            R::step();
            let [x, y, z] = self.at;
            let tcp = Vector::new(R::load(x[i]), R::load(y[i]), R::load(z[i]));
            let turned = if TURNED { into.direction(tcp) } else { tcp };
            put(&mut self.aims[0..3], i, turned + into.origin);
        }
    }
}

/// Lever, axis 6 and axis 5 of each point from its rotation matrix (row by row), in the arm's axes.
pub(in crate::kernel::lanes) struct Orientations<'a, T> {
    pub prepared: &'a Prepared,
    pub rotations: &'a [Plane<T>; 9],
    pub second: &'a Vector3<f64>,
    pub aims: &'a mut Aims<T>,
}

impl<T: Float> Work<T> for Orientations<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let into = IntoArm::<R>::new(self.prepared);
        let arm = &self.prepared.arm;
        let fixed = [
            Vector::<R>::of(&arm.lever),
            Vector::of(&arm.tool_from_axis_6),
            Vector::of(self.second),
        ];
        for i in 0..BLOCK {
            R::step();
            let rows = [
                vector::<R>(&self.rotations[0..3], i),
                vector(&self.rotations[3..6], i),
                vector(&self.rotations[6..9], i),
            ];
            let mut k = 0;
            while k < 3 {
                let in_base = Vector::new(
                    rows[0].dot(fixed[k]),
                    rows[1].dot(fixed[k]),
                    rows[2].dot(fixed[k]),
                );
                put(&mut self.aims[3 * k + 3..3 * k + 6], i, into.direction(in_base));
                k += 1;
            }
        }
    }
}

/// From base into the arm's axes.
#[derive(Clone, Copy)]
struct IntoArm<R> {
    rows: [Vector<R>; 3],
    origin: Vector<R>,
}

impl<R: Real> IntoArm<R> {
    #[inline(always)]
    fn new(prepared: &Prepared) -> Self {
        let m = prepared.arm.arm_from_base_rotation();
        let row = |k: usize| Vector::new(R::of(m[(k, 0)]), R::of(m[(k, 1)]), R::of(m[(k, 2)]));
        IntoArm {
            rows: [row(0), row(1), row(2)],
            origin: Vector::of(&prepared.arm.arm_from_base.translation.vector),
        }
    }

    #[inline(always)]
    fn direction(&self, v: Vector<R>) -> Vector<R> {
        Vector::new(self.rows[0].dot(v), self.rows[1].dot(v), self.rows[2].dot(v))
    }
}

/// The same lever, axis 6 and axis 5 for all points of a block.
pub(in crate::kernel::lanes) fn aim_still<T: Float>(
    prepared: &Prepared,
    base_from_tool: &Matrix3<f64>,
    second: &Vector3<f64>,
    aims: &mut Aims<T>,
) {
    let arm = &prepared.arm;
    let turn = arm.arm_from_base_rotation() * base_from_tool;
    let all = [arm.lever, arm.tool_from_axis_6, *second].map(|v| turn * v);
    for (planes, v) in aims[3..].chunks_exact_mut(3).zip(all) {
        for (plane, value) in planes.iter_mut().zip(v.iter()) {
            plane.fill(T::from_f64(*value));
        }
    }
}
