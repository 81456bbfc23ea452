//! Six-vectors: twist and wrench, and their transformation between points and bases.
//!
//! Translation (force) first, rotation (moment) second. Unless a name says otherwise the reference point
//! is the TCP and the basis is the base frame.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `linear`, `angular` | small displacement of the reference point, small rotation | m, rad |
//! | `force`, `moment` | acting *on the tool*, moment about the reference point | N, N m |

use std::ops::{Add, Mul, Sub};

use nalgebra::{Matrix6, Point3, Rotation3, Vector3, Vector6};

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

    /// A rotation about `axis` (unit), per radian, at a point of it.
    pub fn about(axis: Vector3<f64>) -> Twist {
        Twist {
            angular: axis,
            ..Twist::ZERO
        }
    }

    /// A translation along `axis` (unit), per metre.
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

    /// The same motion in other axes: its components turned by `rotation`.
    pub fn turned(&self, rotation: &Rotation3<f64>) -> Twist {
        Twist {
            linear: rotation * self.linear,
            angular: rotation * self.angular,
        }
    }

    /// The same motion, at a reference point `by` further away (m, same basis).
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

    /// The same load, about a reference point `by` further away (m, same basis).
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

/// A load multiplied by a number.
impl Mul<f64> for Wrench {
    type Output = Wrench;
    fn mul(self, factor: f64) -> Wrench {
        Wrench {
            force: self.force * factor,
            moment: self.moment * factor,
        }
    }
}

/// The 6 x 6 matrix that takes a twist in the frame `local` (its origin, its axes) to point `p` in
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

    fn some_wrench() -> Wrench {
        Wrench {
            force: Vector3::new(3.0, -5.0, 5.0),
            moment: Vector3::new(0.1, 0.2, -0.4),
        }
    }

    const STEPS: [Vector3<f64>; 2] = [Vector3::new(0.2, -0.3, 0.9), Vector3::new(-1.4, 0.7, 0.05)];

    #[test]
    fn moving_twice_is_moving_by_the_sum() {
        let [a, b] = STEPS;
        let (twist, load) = (some_twist(), some_wrench());
        let away = twist.moved(a).moved(b).to_vector() - twist.moved(a + b).to_vector();
        assert!(away.norm() < 1e-15);
        let away = load.moved(a).moved(b).to_vector() - load.moved(a + b).to_vector();
        // Levers of 1 m and forces of 5 N: some ulps of 10 N m.
        assert!(away.norm() < 1e-14);
        assert_eq!(twist.moved(Vector3::zeros()), twist);
        assert_eq!(load.moved(Vector3::zeros()), load);
    }

    #[test]
    fn a_rotation_keeps_points_of_its_axis_and_moves_others_by_their_lever() {
        let z = Vector3::z();
        assert_eq!(Twist::about(z).moved(z * 3.0).linear, Vector3::zeros());
        assert_eq!(
            Twist::about(z).moved(Vector3::x() * 2.0).linear,
            Vector3::y() * 2.0
        );
        assert_eq!(Twist::along(z).moved(STEPS[0]), Twist::along(z));
    }

    #[test]
    fn a_force_at_a_lever_is_a_moment_by_the_right_hand() {
        // At 2 m along x away from its point, a push along y has the moment -2 N m about z.
        let push = Wrench::from_force(Vector3::y());
        assert_eq!(push.moved(Vector3::x() * 2.0).moment, Vector3::z() * -2.0);
        assert_eq!(Wrench::ZERO.moved(STEPS[1]), Wrench::ZERO);
    }

    #[test]
    fn sums_differences_and_multiples_are_those_of_the_columns() {
        let (a, b) = (some_twist(), some_twist().moved(STEPS[0]) * 0.7);
        assert_eq!((a + b).to_vector(), a.to_vector() + b.to_vector());
        assert_eq!((a - b).to_vector(), a.to_vector() - b.to_vector());
        assert_eq!((a * -2.5).to_vector(), a.to_vector() * -2.5);
        assert_eq!([a, b, a].into_iter().sum::<Twist>(), Twist::ZERO + a + b + a);
        assert_eq!(a - a, Twist::ZERO);
        assert_eq!((some_wrench() * 3.0).to_vector(), some_wrench().to_vector() * 3.0);
    }

    #[test]
    fn work_does_not_depend_on_the_basis_and_is_linear_in_both() {
        let turn = from_xyz_and_fixed_angles(Vector3::zeros(), Vector3::new(0.4, -1.2, 2.2)).rotation;
        let (twist, load) = (some_twist(), some_wrench());
        let turned = Twist {
            linear: turn * twist.linear,
            angular: turn * twist.angular,
        };
        let pushed = Wrench {
            force: turn * load.force,
            moment: turn * load.moment,
        };
        assert!((turned.dot(&pushed) - twist.dot(&load)).abs() < 1e-14);
        assert!(((twist * 2.0).dot(&(load * 3.0)) - 6.0 * twist.dot(&load)).abs() < 1e-13);
        assert_eq!(twist.to_vector().dot(&load.to_vector()), twist.dot(&load));
    }

    #[test]
    fn adjoints_multiply_like_their_frames_and_undo_each_other() {
        let a = from_xyz_and_fixed_angles(Vector3::new(0.4, 0.1, -0.2), Vector3::new(0.3, -0.8, 2.0));
        let b = from_xyz_and_fixed_angles(Vector3::new(-1.0, 0.6, 0.3), Vector3::new(-1.3, 0.2, 0.5));
        let at_origin = |frame: &Isometry| adjoint(frame, &Point3::origin());
        let product = at_origin(&a) * at_origin(&b);
        assert!((product - at_origin(&(a * b))).norm() < 1e-14);
        assert!((at_origin(&a) * at_origin(&a.inverse()) - Matrix6::identity()).norm() < 1e-14);
        assert_eq!(at_origin(&Isometry::identity()), Matrix6::identity());
    }

    #[test]
    fn the_transposed_adjoint_takes_a_wrench_to_the_local_frame() {
        let frame = from_xyz_and_fixed_angles(Vector3::new(0.4, 0.1, -0.2), Vector3::new(0.3, -0.8, 2.0));
        let p = Point3::new(1.0, 0.2, 0.8);
        let load = some_wrench();
        // By hand: to the origin of the frame, then into its axes.
        let at_origin = load.moved(frame.translation.vector - p.coords);
        let into = frame.rotation.inverse();
        let expected = Wrench {
            force: into * at_origin.force,
            moment: into * at_origin.moment,
        };
        let found = adjoint(&frame, &p).transpose() * load.to_vector();
        assert!((found - expected.to_vector()).norm() < 1e-14);
    }
}
