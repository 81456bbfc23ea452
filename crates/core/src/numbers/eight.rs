//! Eight numbers, one of each branch of the inverse kinematics.

use super::real::Real;
use super::vector::Vector;

/// A number of each posture; a vector of the widest instruction set.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(crate) struct Eight(pub [f64; 8]);

impl Eight {
    /// That of posture `lane`.
    #[inline(always)]
    pub fn at<R: Real<Float = f64>>(&self, lane: usize) -> R {
        R::load(self.0[lane])
    }

    /// Sets that of posture `lane`.
    #[inline(always)]
    pub fn set<R: Real<Float = f64>>(&mut self, lane: usize, value: R) {
        self.0[lane] = value.store();
    }

    /// Adds `factor` times `other`.
    #[inline(always)]
    pub fn add<R: Real<Float = f64>>(&mut self, factor: f64, other: &Eight) {
        let factor = R::of(factor);
        for i in 0..8 {
            R::step();
            self.set(i, factor.mul_add(other.at::<R>(i), self.at(i)));
        }
    }
}

/// The vector of posture `lane`.
#[inline(always)]
pub(crate) fn vector_of_eight<R: Real<Float = f64>>(from: &[Eight; 3], lane: usize) -> Vector<R> {
    let [x, y, z] = from;
    Vector::new(x.at(lane), y.at(lane), z.at(lane))
}

/// Sets the vector of posture `lane`.
#[inline(always)]
pub(crate) fn put_eight<R: Real<Float = f64>>(to: &mut [Eight; 3], lane: usize, v: Vector<R>) {
    let [x, y, z] = to;
    x.set(lane, v.x);
    y.set(lane, v.y);
    z.set(lane, v.z);
}
