//! `J J^T + lambda I` in lanes, and its inverse applied to a vector.
//!
//! ```text
//! J J^T = [A B; B^T D]     D = L D' L^T     S = A - B D^-1 B^T     x = S^-1 (e_v - B D^-1 e_w), y = D^-1 (e_w - B^T x)
//! ```
//!
//! Linear rows first. Factors without pivots, as of Cholesky: the matrix is symmetric and, damped, positive definite.

use super::real::Real;
use super::vector::Vector;

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

    /// `L D L^T` of it.
    #[inline(always)]
    fn factors(self) -> Factors<R> {
        let Symmetric {
            xx,
            xy,
            xz,
            yy,
            yz,
            zz,
        } = self;
        let one = R::of(1.0);
        let per_x = one / xx;
        let (yx, zx) = (xy * per_x, xz * per_x);
        let second = (-yx).mul_add(xy, yy);
        let mixed = (-zx).mul_add(xy, yz);
        let per_y = one / second;
        let zy = mixed * per_y;
        let third = (-zy).mul_add(mixed, (-zx).mul_add(xz, zz));
        Factors {
            yx,
            zx,
            zy,
            per: Vector::new(per_x, per_y, one / third),
            least: xx.min(second).min(third),
        }
    }
}

/// `L D L^T` of a symmetric matrix.
#[derive(Clone, Copy)]
struct Factors<R> {
    yx: R,
    zx: R,
    zy: R,
    /// `D^-1`.
    per: Vector<R>,
    /// The least of `D`: above zero where the matrix is positive definite.
    least: R,
}

impl<R: Real> Factors<R> {
    /// `L^-1 v`.
    #[inline(always)]
    fn forward(self, v: Vector<R>) -> Vector<R> {
        let y = (-self.yx).mul_add(v.x, v.y);
        Vector::new(v.x, y, (-self.zy).mul_add(y, (-self.zx).mul_add(v.x, v.z)))
    }

    /// `D^-1 v`.
    #[inline(always)]
    fn divided(self, v: Vector<R>) -> Vector<R> {
        Vector::new(v.x * self.per.x, v.y * self.per.y, v.z * self.per.z)
    }

    /// `L^-T v`.
    #[inline(always)]
    fn back(self, v: Vector<R>) -> Vector<R> {
        let y = (-self.zy).mul_add(v.z, v.y);
        Vector::new((-self.zx).mul_add(v.z, (-self.yx).mul_add(y, v.x)), y, v.z)
    }
}

/// `J J^T`.
#[derive(Clone, Copy)]
pub(crate) struct Gram<R> {
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

    /// The two parts of the solution for the right side (`linear`, `angular`), and the least pivot: above zero where the
    /// matrix is positive definite.
    #[inline(always)]
    pub fn solve(self, linear: Vector<R>, angular: Vector<R>) -> ([Vector<R>; 2], R) {
        let [b1, b2, b3] = self.mixed;
        let factors = self.angular.factors();
        // Rows of B L^-T, and those of B L^-T D^-1.
        let (w1, w2, w3) = (factors.forward(b1), factors.forward(b2), factors.forward(b3));
        let (d1, d2, d3) = (factors.divided(w1), factors.divided(w2), factors.divided(w3));
        let complement = Symmetric {
            xx: self.linear.xx - d1.dot(w1),
            xy: self.linear.xy - d1.dot(w2),
            xz: self.linear.xz - d1.dot(w3),
            yy: self.linear.yy - d2.dot(w2),
            yz: self.linear.yz - d2.dot(w3),
            zz: self.linear.zz - d3.dot(w3),
        };
        let reduced = factors.forward(angular);
        let right = Vector::new(
            linear.x - d1.dot(reduced),
            linear.y - d2.dot(reduced),
            linear.z - d3.dot(reduced),
        );
        let of_linear = complement.factors();
        let x = of_linear.back(of_linear.divided(of_linear.forward(right)));
        let rest = reduced - w1.mul_add(x.x, w2.mul_add(x.y, w3.scaled(x.z)));
        let y = factors.back(factors.divided(rest));
        ([x, y], factors.least.min(of_linear.least))
    }
}
