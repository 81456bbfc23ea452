//! Compliance of the TCP in one lane: `A = sum c_i v_i v_i^T` for forces, `D = sum c_i v_i z_i^T` for moments.

use crate::kernel::lanes::solve::Screws;
use crate::numbers::{Real, Vector};

/// Displacement per force (symmetric: xx, xy, xz, yy, yz, zz) and, if requested, per moment (rows).
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) struct Flexibility<R> {
    pub a: [R; 6],
    pub d: [Vector<R>; 3],
}

impl<R: Real> Flexibility<R> {
    /// Of joints with these compliances; `d` is zero unless `MOMENTS`.
    #[inline(always)]
    pub fn new<const MOMENTS: bool>(screws: &Screws<R>, compliance: &[R; 6]) -> Self {
        let zero = R::of(0.0);
        let nothing = Vector::new(zero, zero, zero);
        // Joint 1 turns about z and moves nothing along it.
        let v = screws.linear[0];
        let w = v.scaled(compliance[0]);
        let mut a = [w.x * v.x, w.x * v.y, zero, w.y * v.y, zero, zero];
        let mut d = [nothing; 3];
        if MOMENTS {
            d[0].z = w.x;
            d[1].z = w.y;
        }
        let mut i = 1;
        while i < 6 {
            let c = if i == 4 {
                compliance[4] * screws.per_n2
            } else {
                compliance[i]
            };
            let v = screws.linear[i];
            let w = v.scaled(c);
            a = [
                w.x.mul_add(v.x, a[0]),
                w.x.mul_add(v.y, a[1]),
                w.x.mul_add(v.z, a[2]),
                w.y.mul_add(v.y, a[3]),
                w.y.mul_add(v.z, a[4]),
                w.z.mul_add(v.z, a[5]),
            ];
            if MOMENTS {
                let z = screws.axes[i];
                d = [z.mul_add(w.x, d[0]), z.mul_add(w.y, d[1]), z.mul_add(w.z, d[2])];
            }
            i += 1;
        }
        Flexibility { a, d }
    }

    /// `A v`.
    #[inline(always)]
    pub fn times(&self, v: Vector<R>) -> Vector<R> {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        Vector::new(
            xx.mul_add(v.x, xy.mul_add(v.y, xz * v.z)),
            xy.mul_add(v.x, yy.mul_add(v.y, yz * v.z)),
            xz.mul_add(v.x, yz.mul_add(v.y, zz * v.z)),
        )
    }

    /// `D^T v`.
    #[inline(always)]
    pub fn transposed_d_times(&self, v: Vector<R>) -> Vector<R> {
        let [x, y, z] = self.d;
        z.mul_add(v.z, y.mul_add(v.y, x.scaled(v.x)))
    }
}
