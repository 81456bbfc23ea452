//! Elastic deviation: joints twist under the load.
//!
//! `delta = C w = sum_i c_i s_i (s_i . w)`
//!
//! Linear in the compliances, so the parts add up exactly to the whole and the covariance follows:
//! `cov(delta) = A S A^T` with columns `a_i = s_i (s_i . w)` and `S = diag(u_i^2)`.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `s_i` | screw of joint i at the TCP, base basis | m/rad, rad/rad |
//! | `c_i`, `u_i` | joint compliance, its standard uncertainty | rad/(N m) |
//! | `w` | wrench on the tool at the TCP, base basis | N, N m |
//! | `delta` | TCP twist: position of the tool minus its commanded position | m, rad |
//!
//! Valid for deflections small against the arm (below about 1 mm on a metre). Source: Shneor & Chapsky 2021,
//! eq. (10), with the reference point moved to the TCP.

use nalgebra::{Matrix3, Vector3};

use super::deviation::Deviation;
use crate::robot::Posture;
use crate::robot::joint::JointCompliance;
use crate::spatial::{Twist, Wrench};

/// Deviation of the tool by one joint, per unit of its compliance: `a_i = s_i (s_i . w)`.
fn sensitivity(screw: &Twist, wrench: &Wrench) -> Twist {
    *screw * screw.dot(wrench)
}

/// Displacement of the tool by all joints, m, as used by maps.
pub fn displacement(screws: &[Twist], joints: &[JointCompliance], wrench: &Wrench) -> Vector3<f64> {
    screws
        .iter()
        .zip(joints)
        .map(|(s, c)| s.linear * (c.value * s.dot(wrench)))
        .sum()
}

/// Share of each joint in the deviation; they add up to the deviation.
fn shares(screws: &[Twist], joints: &[JointCompliance], wrench: &Wrench) -> Vec<Twist> {
    screws
        .iter()
        .zip(joints)
        .map(|(s, c)| *s * (c.value * s.dot(wrench)))
        .collect()
}

/// Covariance (m^2) of the translational deviation, from the uncertainties of the joint compliances, taken as
/// independent.
fn covariance(screws: &[Twist], joints: &[JointCompliance], wrench: &Wrench) -> Matrix3<f64> {
    let parts = screws.iter().zip(joints).map(|(s, c)| {
        let a = sensitivity(s, wrench).linear * c.standard_uncertainty;
        a * a.transpose()
    });
    parts.sum()
}

/// The simple model on its own: the deviation of a tool in `posture`, with joints of these compliances, under `wrench`.
///
/// ```
/// use armill_core::source::elastic::predict;
/// use armill_core::robot::{Amount, Axis, Joint, JointCompliance, Motion, Robot, inverse::posture_at};
/// use armill_core::{frame::Isometry, spatial::Wrench};
///
/// // One joint, a lever of 1 m, 2 urad/(N m), pushed sideways with 10 N: 20 um.
/// let motions = vec![Motion::About(Axis::Z, Amount::Joint(0)), Motion::Along(Axis::X, Amount::Constant(1.0))];
/// let lever = Robot::new("lever", motions, vec![Joint::plain("A")])?;
/// let posture = posture_at(&lever, &[0.0], &Isometry::identity());
/// let joint = JointCompliance { value: 2e-6, standard_uncertainty: 0.0 };
/// let push = Wrench::from_force(nalgebra::Vector3::new(0.0, 10.0, 0.0));
/// assert!((predict(&posture, &[joint], &push).twist.linear.y - 20e-6).abs() < 1e-18);
/// # Ok::<(), armill_core::robot::RobotError>(())
/// ```
pub fn predict(posture: &Posture, joints: &[JointCompliance], wrench: &Wrench) -> Deviation {
    let shares = shares(&posture.screws, joints, wrench);
    Deviation {
        twist: shares.iter().copied().sum(),
        covariance: covariance(&posture.screws, joints, wrench),
        shares,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arm() -> ([Twist; 2], [JointCompliance; 2]) {
        let screw = |o: Vector3<f64>, z: Vector3<f64>| Twist {
            linear: z.cross(&-o),
            angular: z,
        };
        let screws = [
            screw(Vector3::new(-1.0, 0.0, 0.0), Vector3::z()),
            screw(Vector3::new(-0.5, 0.0, 0.2), Vector3::y()),
        ];
        let compliance = |value: f64| JointCompliance {
            value,
            standard_uncertainty: 0.1 * value,
        };
        (screws, [compliance(2e-6), compliance(4e-5)])
    }

    #[test]
    fn a_lever_of_one_metre_turns_force_into_deviation_by_its_square() {
        // c L^2 F = 2e-6 rad/(N m) x (1 m)^2 x 10 N = 20 um.
        let (screws, joints) = arm();
        let push = Wrench::from_force(Vector3::new(0.0, 10.0, 0.0));
        let delta = shares(&screws[..1], &joints[..1], &push)[0];
        assert!((delta.linear - Vector3::new(0.0, 20e-6, 0.0)).norm() < 1e-18);
        assert!((delta.angular - Vector3::new(0.0, 0.0, 20e-6)).norm() < 1e-18);
        assert_eq!(displacement(&screws[..1], &joints[..1], &push), delta.linear);
    }

    #[test]
    fn standard_uncertainty_of_one_joint_scales_its_share() {
        let (screws, joints) = arm();
        let push = Wrench::from_force(Vector3::new(1.0, 0.0, 10.0));
        let share = shares(&screws[1..], &joints[1..], &push)[0].linear;
        let u = covariance(&screws[1..], &joints[1..], &push);
        assert!((u.trace().sqrt() - 0.1 * share.norm()).abs() < 1e-18);
    }

    #[test]
    fn shares_displacement_and_sensitivity_agree() {
        let (screws, joints) = arm();
        let load = Wrench {
            force: Vector3::new(3.0, -5.0, 5.0),
            moment: Vector3::new(0.1, 0.2, -0.4),
        };
        let shares = shares(&screws, &joints, &load);
        let sum: Twist = shares.iter().copied().sum();
        assert!((sum.linear - displacement(&screws, &joints, &load)).norm() < 1e-19);
        for ((share, screw), joint) in shares.iter().zip(&screws).zip(&joints) {
            let away = *share - sensitivity(screw, &load) * joint.value;
            assert!(away.to_vector().norm() < 1e-19);
        }
    }

    #[test]
    fn a_push_along_a_lever_or_a_rigid_joint_moves_nothing() {
        let (screws, mut joints) = arm();
        // The first axis is along z through (-1, 0, 0): a push along x passes through it.
        assert_eq!(
            shares(&screws[..1], &joints[..1], &Wrench::from_force(Vector3::x()))[0],
            Twist::ZERO
        );
        joints.iter_mut().for_each(|joint| joint.value = 0.0);
        let push = Wrench::from_force(Vector3::new(3.0, -5.0, 5.0));
        assert_eq!(displacement(&screws, &joints, &push), Vector3::zeros());
        assert_eq!(covariance(&[], &[], &push), Matrix3::zeros());
    }

    #[test]
    fn deviations_under_two_loads_add_up_and_work_is_never_negative() {
        let (screws, joints) = arm();
        let loads = [
            Wrench::from_force(Vector3::new(3.0, -5.0, 5.0)),
            Wrench {
                force: Vector3::new(-1.0, 2.0, 0.5),
                moment: Vector3::new(0.1, 0.2, -0.4),
            },
        ];
        let of = |load: &Wrench| shares(&screws, &joints, load).into_iter().sum::<Twist>();
        let both = Wrench {
            force: loads[0].force + loads[1].force,
            moment: loads[0].moment + loads[1].moment,
        };
        assert!((of(&both) - of(&loads[0]) - of(&loads[1])).to_vector().norm() < 1e-18);
        // Maxwell and Betti: the work of one load on the displacement by the other is mutual.
        let (a, b) = (of(&loads[0]).dot(&loads[1]), of(&loads[1]).dot(&loads[0]));
        assert!((a - b).abs() < 1e-18 && of(&loads[0]).dot(&loads[0]) > 0.0);
    }
}
