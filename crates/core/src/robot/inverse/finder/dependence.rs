//! How nearly the joints of eight postures are dependent, one lane each: the condition number of their Jacobian.
//!
//! ```text
//! G = J J^T = [A B; B^T C]        M = A^-1 B        S = C - B^T M
//! trace G^-1 = trace A^-1 + trace S^-1 + trace M S^-1 M^T
//! ```
//!
//! `J` has the screws of the joints at the flange, their linear rows over a length of the arm; `A` and `C` are the 3x3
//! blocks of its linear and angular rows. `trace G trace G^-1` is the square of the Frobenius condition number, as in
//! [`Descent::dependent`](super::super::descent::Descent::dependent).

use super::super::descent::DEPENDENT;
use crate::numbers::{Eight, Real, Vector, Work, put_in_lane, vector_in_lane};

/// Whether joints with this square of the condition number are nearly dependent; of a singular Jacobian it is no
/// positive number.
pub(super) fn is_dependent(squared: f64) -> bool {
    !(squared > 0.0 && squared <= DEPENDENT * DEPENDENT)
}

/// Computes the square of the condition number of revolute joints.
pub(super) struct FindDependence<'a> {
    /// Of each joint the unit direction of its axis, and a point on it (m).
    pub axes: &'a [[[Eight; 3]; 2]],
    /// Origin of the flange, m.
    pub flange: &'a [Eight; 3],
    /// Makes translations and rotations comparable, m.
    pub length: f64,
    pub found: &'a mut Eight,
}

/// `J J^T` of each lane: its symmetric blocks as `[xx yy zz]` and `[yz zx xy]`, the mixed block by columns.
#[derive(Default)]
struct Gram {
    linear: [[Eight; 3]; 2],
    angular: [[Eight; 3]; 2],
    mixed: [[Eight; 3]; 3],
}

impl Work<f64> for FindDependence<'_> {
    #[inline(always)]
    fn run<R: Real<Float = f64>>(self) {
        let mut gram = Gram::default();
        let per_length = R::of(1.0 / self.length);
        for [axis, point] in self.axes {
            let mut linear = [Eight::default(); 3];
            for i in 0..8 {
                R::step();
                let away = vector_in_lane::<R, 8>(self.flange, i) - vector_in_lane(point, i);
                let v = vector_in_lane(axis, i).cross(away);
                put_in_lane(&mut linear, i, v.scaled(per_length));
            }
            add_square::<R>(&mut gram.linear, &linear);
            add_square::<R>(&mut gram.angular, axis);
            for (mixed, w) in gram.mixed.iter_mut().zip(axis) {
                add_scaled::<R>(mixed, &linear, w);
            }
        }
        // A separate value: so short a loop is vectorised only where its results cannot overlap what it reads.
        let mut found = Eight::default();
        for i in 0..8 {
            R::step();
            let (a, c) = (
                Symmetric::<R>::at(&gram.linear, i),
                Symmetric::at(&gram.angular, i),
            );
            let a_inverse = a.inverse();
            let [b1, b2, b3] = [
                vector_in_lane(&gram.mixed[0], i),
                vector_in_lane(&gram.mixed[1], i),
                vector_in_lane(&gram.mixed[2], i),
            ];
            let (m1, m2, m3) = (a_inverse.times(b1), a_inverse.times(b2), a_inverse.times(b3));
            let s_inverse = Symmetric {
                squares: c.squares - Vector::new(b1.dot(m1), b2.dot(m2), b3.dot(m3)),
                products: c.products - Vector::new(b2.dot(m3), b3.dot(m1), b1.dot(m2)),
            }
            .inverse();
            let squares = Vector::new(m1.dot(m1), m2.dot(m2), m3.dot(m3));
            let products = Vector::new(m2.dot(m3), m3.dot(m1), m1.dot(m2));
            let through = s_inverse.squares.dot(squares) + R::of(2.0) * s_inverse.products.dot(products);
            let trace_of_inverse = a_inverse.trace() + s_inverse.trace() + through;
            found.set(i, (a.trace() + c.trace()) * trace_of_inverse);
        }
        *self.found = found;
    }
}

/// Adds the vectors `v`, each `factor` times.
#[inline(always)]
fn add_scaled<R: Real<Float = f64>>(sum: &mut [Eight; 3], v: &[Eight; 3], factor: &Eight) {
    for i in 0..8 {
        R::step();
        let added = vector_in_lane::<R, 8>(v, i).mul_add(factor.at(i), vector_in_lane(sum, i));
        put_in_lane(sum, i, added);
    }
}

/// Adds the squares `v v^T`.
#[inline(always)]
fn add_square<R: Real<Float = f64>>([squares, products]: &mut [[Eight; 3]; 2], v: &[Eight; 3]) {
    for i in 0..8 {
        R::step();
        let (v, s, p) = (
            vector_in_lane::<R, 8>(v, i),
            vector_in_lane::<R, 8>(squares, i),
            vector_in_lane::<R, 8>(products, i),
        );
        let added = Vector::new(
            v.x.mul_add(v.x, s.x),
            v.y.mul_add(v.y, s.y),
            v.z.mul_add(v.z, s.z),
        );
        put_in_lane(squares, i, added);
        let added = Vector::new(
            v.y.mul_add(v.z, p.x),
            v.z.mul_add(v.x, p.y),
            v.x.mul_add(v.y, p.z),
        );
        put_in_lane(products, i, added);
    }
}

/// A symmetric 3x3 matrix: `[xx yy zz]` and `[yz zx xy]`.
#[derive(Clone, Copy)]
struct Symmetric<R> {
    squares: Vector<R>,
    products: Vector<R>,
}

impl<R: Real<Float = f64>> Symmetric<R> {
    #[inline(always)]
    fn at([squares, products]: &[[Eight; 3]; 2], lane: usize) -> Symmetric<R> {
        Symmetric {
            squares: vector_in_lane(squares, lane),
            products: vector_in_lane(products, lane),
        }
    }

    #[inline(always)]
    fn trace(self) -> R {
        self.squares.x + self.squares.y + self.squares.z
    }

    #[inline(always)]
    fn times(self, v: Vector<R>) -> Vector<R> {
        let (s, p) = (self.squares, self.products);
        Vector::new(
            Vector::new(s.x, p.z, p.y).dot(v),
            Vector::new(p.z, s.y, p.x).dot(v),
            Vector::new(p.y, p.x, s.z).dot(v),
        )
    }

    /// By cofactors; not finite where it is singular.
    #[inline(always)]
    fn inverse(self) -> Symmetric<R> {
        let (s, p) = (self.squares, self.products);
        let squares = Vector::new(
            s.y.mul_add(s.z, -(p.x * p.x)),
            s.z.mul_add(s.x, -(p.y * p.y)),
            s.x.mul_add(s.y, -(p.z * p.z)),
        );
        let products = Vector::new(
            p.y.mul_add(p.z, -(s.x * p.x)),
            p.z.mul_add(p.x, -(s.y * p.y)),
            p.x.mul_add(p.y, -(s.z * p.z)),
        );
        let determinant = Vector::new(s.x, p.z, p.y).dot(Vector::new(squares.x, products.z, products.y));
        let per_determinant = R::of(1.0) / determinant;
        Symmetric {
            squares: squares.scaled(per_determinant),
            products: products.scaled(per_determinant),
        }
    }
}
