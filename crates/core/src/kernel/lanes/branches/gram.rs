//! `J J^T` of a block of points as 3 x 3 blocks, and its inverse applied to a vector: see `newton`.

use crate::numbers::{Real, Vector};

/// A symmetric 3 x 3 matrix.
#[derive(Clone, Copy)]
struct Symmetric<R> {
    xx: R,
    xy: R,
    xz: R,
    yy: R,
    yz: R,
    zz: R,
}

impl<R: Real> Symmetric<R> {
    #[inline(always)]
    fn all(value: R) -> Self {
        Symmetric {
            xx: value,
            xy: value,
            xz: value,
            yy: value,
            yz: value,
            zz: value,
        }
    }

    /// With `v v^T` added.
    #[inline(always)]
    fn with(self, v: Vector<R>) -> Self {
        Symmetric {
            xx: v.x.mul_add(v.x, self.xx),
            xy: v.x.mul_add(v.y, self.xy),
            xz: v.x.mul_add(v.z, self.xz),
            yy: v.y.mul_add(v.y, self.yy),
            yz: v.y.mul_add(v.z, self.yz),
            zz: v.z.mul_add(v.z, self.zz),
        }
    }

    #[inline(always)]
    fn plus_diagonal(self, value: R) -> Self {
        Symmetric {
            xx: self.xx + value,
            yy: self.yy + value,
            zz: self.zz + value,
            ..self
        }
    }

    #[inline(always)]
    fn trace(self) -> R {
        self.xx + self.yy + self.zz
    }

    #[inline(always)]
    fn times(self, v: Vector<R>) -> Vector<R> {
        Vector::new(
            self.xx.mul_add(v.x, self.xy.mul_add(v.y, self.xz * v.z)),
            self.xy.mul_add(v.x, self.yy.mul_add(v.y, self.yz * v.z)),
            self.xz.mul_add(v.x, self.yz.mul_add(v.y, self.zz * v.z)),
        )
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        let Symmetric {
            xx,
            xy,
            xz,
            yy,
            yz,
            zz,
        } = self;
        let (a, b, c) = (
            yy.mul_add(zz, -(yz * yz)),
            xz.mul_add(yz, -(xy * zz)),
            xy.mul_add(yz, -(xz * yy)),
        );
        let determinant = xx.mul_add(a, xy.mul_add(b, xz * c));
        let per = R::of(1.0) / determinant;
        Symmetric {
            xx: a * per,
            xy: b * per,
            xz: c * per,
            yy: xx.mul_add(zz, -(xz * xz)) * per,
            yz: xy.mul_add(xz, -(xx * yz)) * per,
            zz: xx.mul_add(yy, -(xy * xy)) * per,
        }
    }
}

/// `J J^T`.
#[derive(Clone, Copy)]
pub(super) struct Gram<R> {
    linear: Symmetric<R>,
    /// Rows of B.
    mixed: [Vector<R>; 3],
    angular: Symmetric<R>,
}

impl<R: Real> Gram<R> {
    #[inline(always)]
    pub fn new(zero: R) -> Self {
        let none = Vector::new(zero, zero, zero);
        Gram {
            linear: Symmetric::all(zero),
            mixed: [none, none, none],
            angular: Symmetric::all(zero),
        }
    }

    /// With a column of J, linear and angular part.
    #[inline(always)]
    pub fn with(self, [v, w]: [Vector<R>; 2]) -> Self {
        let [x, y, z] = self.mixed;
        Gram {
            linear: self.linear.with(v),
            mixed: [w.mul_add(v.x, x), w.mul_add(v.y, y), w.mul_add(v.z, z)],
            angular: self.angular.with(w),
        }
    }

    #[inline(always)]
    pub fn damped(self, damping: R) -> Self {
        Gram {
            linear: self.linear.plus_diagonal(damping),
            mixed: self.mixed,
            angular: self.angular.plus_diagonal(damping),
        }
    }

    #[inline(always)]
    pub fn trace(self) -> R {
        self.linear.trace() + self.angular.trace()
    }

    /// The two parts of the solution for the right side (`linear`, `angular`).
    #[inline(always)]
    pub fn solve(self, linear: Vector<R>, angular: Vector<R>) -> [Vector<R>; 2] {
        let [b1, b2, b3] = self.mixed;
        let inverse = self.angular.inverse();
        // Rows of B D^-1.
        let (d1, d2, d3) = (inverse.times(b1), inverse.times(b2), inverse.times(b3));
        let complement = Symmetric {
            xx: self.linear.xx - d1.dot(b1),
            xy: self.linear.xy - d1.dot(b2),
            xz: self.linear.xz - d1.dot(b3),
            yy: self.linear.yy - d2.dot(b2),
            yz: self.linear.yz - d2.dot(b3),
            zz: self.linear.zz - d3.dot(b3),
        };
        let right = Vector::new(
            linear.x - d1.dot(angular),
            linear.y - d2.dot(angular),
            linear.z - d3.dot(angular),
        );
        let x = complement.inverse().times(right);
        let rest = angular - b1.mul_add(x.x, b2.mul_add(x.y, b3.scaled(x.z)));
        [x, inverse.times(rest)]
    }
}
