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

    /// The two parts of the solution for the right side (`linear`, `angular`), and the least pivot: above zero where
    /// the matrix is positive definite.
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

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix6, Vector6};

    use super::*;
    use crate::arms::Stream;

    #[test]
    fn the_solution_is_that_of_the_whole_matrix() {
        let mut stream = Stream(61);
        for columns in [3, 6, 8] {
            for _ in 0..200 {
                let (mut gram, mut whole) = (Gram::new(0.0), Matrix6::zeros());
                for _ in 0..columns {
                    let (v, w) = (stream.vector(1.0), stream.vector(1.0));
                    gram = gram.with([Vector::of(&v), Vector::of(&w)]);
                    let column = Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z);
                    whole += column * column.transpose();
                }
                assert!((gram.trace() - whole.trace()).abs() < 1e-14);
                let (e, f) = (stream.vector(1.0), stream.vector(1.0));
                let ([x, y], pivot) = gram.damped(1e-3).solve(Vector::of(&e), Vector::of(&f));
                let solution = Vector6::new(x.x, x.y, x.z, y.x, y.y, y.z);
                let right = (whole + Matrix6::identity() * 1e-3) * solution;
                // The matrix is up to some units, the solution up to a thousand.
                assert!((right - Vector6::new(e.x, e.y, e.z, f.x, f.y, f.z)).norm() < 1e-11);
                assert!(pivot > 0.0);
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_has_no_positive_pivot() {
        let e = Vector::new(1.0, 0.0, 0.0);
        let indefinite: Gram<f64> = Gram::new(0.0).with([e, e]).damped(-0.5);
        assert!(indefinite.solve(e, e).1 <= 0.0);
        let nothing: Gram<f64> = Gram::new(0.0);
        let pivot = nothing.solve(e, e).1;
        assert!(pivot.is_nan() || pivot <= 0.0);
    }
}
