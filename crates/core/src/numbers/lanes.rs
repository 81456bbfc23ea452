//! A few numbers at once: those of the eight branches of a pose, or of the descents of a search.

use super::real::Real;
use super::vector::Vector;

/// A number of each lane; whole vectors of the widest instruction set.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Lanes<const N: usize>(pub [f64; N]);

/// A number of each branch of the inverse kinematics.
pub(crate) type Eight = Lanes<8>;

impl<const N: usize> Default for Lanes<N> {
    fn default() -> Lanes<N> {
        Lanes([0.0; N])
    }
}

impl<const N: usize> Lanes<N> {
    /// That of lane `lane`.
    #[inline(always)]
    pub fn at<R: Real<Float = f64>>(&self, lane: usize) -> R {
        R::load(self.0[lane])
    }

    /// Sets that of lane `lane`.
    #[inline(always)]
    pub fn set<R: Real<Float = f64>>(&mut self, lane: usize, value: R) {
        self.0[lane] = value.store();
    }

    /// Adds `factor` times `other`.
    #[inline(always)]
    pub fn add<R: Real<Float = f64>>(&mut self, factor: f64, other: &Lanes<N>) {
        let factor = R::of(factor);
        for i in 0..N {
            R::step();
            self.set(i, factor.mul_add(other.at::<R>(i), self.at(i)));
        }
    }
}

/// The vector of lane `lane`.
#[inline(always)]
pub(crate) fn vector_in_lane<R: Real<Float = f64>, const N: usize>(
    from: &[Lanes<N>; 3],
    lane: usize,
) -> Vector<R> {
    let [x, y, z] = from;
    Vector::new(x.at(lane), y.at(lane), z.at(lane))
}

/// Sets the vector of lane `lane`.
#[inline(always)]
pub(crate) fn put_in_lane<R: Real<Float = f64>, const N: usize>(
    to: &mut [Lanes<N>; 3],
    lane: usize,
    v: Vector<R>,
) {
    let [x, y, z] = to;
    x.set(lane, v.x);
    y.set(lane, v.y);
    z.set(lane, v.z);
}
