//! Three numbers of one lane that are a vector.

use std::ops::{Add, Sub};

use super::real::Real;

/// A vector in the arm's axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector<R> {
    pub x: R,
    pub y: R,
    pub z: R,
}

impl<R: Real> Vector<R> {
    #[inline(always)]
    pub fn new(x: R, y: R, z: R) -> Self {
        Vector { x, y, z }
    }

    /// The same in every lane.
    #[inline(always)]
    pub fn of(v: &nalgebra::Vector3<f64>) -> Self {
        Vector::new(R::of(v.x), R::of(v.y), R::of(v.z))
    }

    #[inline(always)]
    pub fn dot(self, other: Self) -> R {
        self.x.mul_add(other.x, self.y.mul_add(other.y, self.z * other.z))
    }

    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Vector::new(
            self.y.mul_add(other.z, -(self.z * other.y)),
            self.z.mul_add(other.x, -(self.x * other.z)),
            self.x.mul_add(other.y, -(self.y * other.x)),
        )
    }

    #[inline(always)]
    pub fn scaled(self, factor: R) -> Self {
        Vector::new(self.x * factor, self.y * factor, self.z * factor)
    }

    /// `self factor + other`.
    #[inline(always)]
    pub fn mul_add(self, factor: R, other: Self) -> Self {
        Vector::new(
            self.x.mul_add(factor, other.x),
            self.y.mul_add(factor, other.y),
            self.z.mul_add(factor, other.z),
        )
    }
}

impl<R: Real> Add for Vector<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Vector::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<R: Real> Sub for Vector<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Vector::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}
