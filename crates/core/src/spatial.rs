//! Six-vectors: twist and wrench, and how they move between points and bases.
//!
//! Translation (force) first, rotation (moment) second. Unless a name says otherwise the reference point
//! is the TCP and the basis is the base frame.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `linear`, `angular` | small displacement of the reference point, small rotation | m, rad |
//! | `force`, `moment` | acting *on the tool*, moment about the reference point | N, N m |

use std::ops::{Add, Mul, Sub};

use nalgebra::{Matrix6, Point3, Vector3, Vector6};

use crate::frame::Isometry;

/// A small displacement of a body: of its reference point, and its rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Displacement of the reference point, m.
    pub linear: Vector3<f64>,
    /// Rotation vector, rad.
    pub angular: Vector3<f64>,
}

impl Twist {
    /// The twist of no motion.
    pub const ZERO: Twist = Twist {
        linear: Vector3::new(0.0, 0.0, 0.0),
        angular: Vector3::new(0.0, 0.0, 0.0),
    };

    /// A turn about `axis` (unit), per radian, told at a point of it.
    pub fn about(axis: Vector3<f64>) -> Twist {
        Twist {
            angular: axis,
            ..Twist::ZERO
        }
    }

    /// A slide along `axis` (unit), per metre.
    pub fn along(axis: Vector3<f64>) -> Twist {
        Twist {
            linear: axis,
            ..Twist::ZERO
        }
    }

    /// Work (J) that `wrench` does on this displacement; both at the same point and basis.
    pub fn dot(&self, wrench: &Wrench) -> f64 {
        self.linear.dot(&wrench.force) + self.angular.dot(&wrench.moment)
    }

    /// `[linear; angular]` as one column.
    pub fn to_vector(&self) -> Vector6<f64> {
        Vector6::new(
            self.linear.x,
            self.linear.y,
            self.linear.z,
            self.angular.x,
            self.angular.y,
            self.angular.z,
        )
    }

    /// The same motion, told at a reference point `by` further away (m, same basis).
    pub fn moved(&self, by: Vector3<f64>) -> Twist {
        Twist {
            linear: self.linear + self.angular.cross(&by),
            angular: self.angular,
        }
    }
}

impl Add for Twist {
    type Output = Twist;
    fn add(self, other: Twist) -> Twist {
        Twist {
            linear: self.linear + other.linear,
            angular: self.angular + other.angular,
        }
    }
}

impl Sub for Twist {
    type Output = Twist;
    fn sub(self, other: Twist) -> Twist {
        Twist {
            linear: self.linear - other.linear,
            angular: self.angular - other.angular,
        }
    }
}

/// A twist times a number, for example a screw times a joint angle.
impl Mul<f64> for Twist {
    type Output = Twist;
    fn mul(self, factor: f64) -> Twist {
        Twist {
            linear: self.linear * factor,
            angular: self.angular * factor,
        }
    }
}

impl std::iter::Sum for Twist {
    fn sum<I: Iterator<Item = Twist>>(parts: I) -> Twist {
        parts.fold(Twist::ZERO, |sum, part| sum + part)
    }
}

/// A force and a moment that act on the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Force on the tool, N. A dynamometer under the part reads the opposite sign.
    pub force: Vector3<f64>,
    /// Moment on the tool about the reference point, N m.
    pub moment: Vector3<f64>,
}

impl Wrench {
    /// No load.
    pub const ZERO: Wrench = Wrench {
        force: Vector3::new(0.0, 0.0, 0.0),
        moment: Vector3::new(0.0, 0.0, 0.0),
    };

    /// A wrench with no moment about its reference point.
    pub fn from_force(force: Vector3<f64>) -> Wrench {
        Wrench {
            force,
            moment: Vector3::zeros(),
        }
    }

    /// The same load, told about a reference point `by` further away (m, same basis).
    pub fn moved(&self, by: Vector3<f64>) -> Wrench {
        Wrench {
            force: self.force,
            moment: self.moment - by.cross(&self.force),
        }
    }

    /// `[force; moment]` as one column.
    pub fn to_vector(&self) -> Vector6<f64> {
        let (f, m) = (&self.force, &self.moment);
        Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
    }
}

/// A load so many times as large.
impl Mul<f64> for Wrench {
    type Output = Wrench;
    fn mul(self, factor: f64) -> Wrench {
        Wrench {
            force: self.force * factor,
            moment: self.moment * factor,
        }
    }
}

/// The 6 x 6 matrix that takes a twist told in the frame `local` (its origin, its axes) to point `p` in
/// the base basis: `[[R, -[p - o] R], [0, R]]`.
///
/// Its transpose takes a wrench at `p` in base to the local frame, and `Ad C Ad^T` moves a compliance.
pub fn adjoint(base_from_local: &Isometry, p: &Point3<f64>) -> Matrix6<f64> {
    let r = base_from_local.rotation.to_rotation_matrix().into_inner();
    let lever = p.coords - base_from_local.translation.vector;
    let mut ad = Matrix6::zeros();
    ad.fixed_view_mut::<3, 3>(0, 0).copy_from(&r);
    ad.fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&(-lever.cross_matrix() * r));
    ad.fixed_view_mut::<3, 3>(3, 3).copy_from(&r);
    ad
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::from_xyz_and_fixed_angles;

    fn some_twist() -> Twist {
        Twist {
            linear: Vector3::new(1.0, -2.0, 0.5),
            angular: Vector3::new(0.3, 0.7, -1.1),
        }
    }

    #[test]
    fn work_does_not_depend_on_the_reference_point() {
        let load = Wrench {
            force: Vector3::new(3.0, -5.0, 5.0),
            moment: Vector3::new(0.1, 0.2, -0.4),
        };
        let by = Vector3::new(0.2, -0.3, 0.9);
        let here = some_twist().dot(&load);
        let there = some_twist().moved(by).dot(&load.moved(by));
        assert!((here - there).abs() < 1e-14, "{here} J here, {there} J there");
    }

    #[test]
    fn adjoint_moves_a_twist_like_moved_does() {
        let base_from_local =
            from_xyz_and_fixed_angles(Vector3::new(0.4, 0.1, -0.2), Vector3::new(0.3, -0.8, 2.0));
        let p = Point3::new(1.0, 0.2, 0.8);
        let local = some_twist();
        let in_base = Twist {
            linear: base_from_local.rotation * local.linear,
            angular: base_from_local.rotation * local.angular,
        };
        let expected = in_base
            .moved(p.coords - base_from_local.translation.vector)
            .to_vector();
        assert!((adjoint(&base_from_local, &p) * local.to_vector() - expected).norm() < 1e-14);
    }
}
