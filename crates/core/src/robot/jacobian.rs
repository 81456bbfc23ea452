//! Screws and Jacobian at the tool centre point.
//!
//! Joint `i` with unit axis `z` through `o`, TCP `p`, all in base: `s_i = [z x (p - o); z]` for a revolute
//! joint, `s_i = [z; 0]` for a prismatic one. The screws refer to the chain positions `theta`; the Jacobian
//! to the joint positions `q` of the controller: `J = S dtheta/dq`.
//!
//! Reference point: the TCP. Basis: base. m/rad and rad/rad. Source: `docs/theory/chain.md`.

use nalgebra::{DMatrix, Matrix6xX, Point3, Vector3};

use super::chain::{Chain, Motion};
use super::forward::{Frames, chain_axis, forward};
use super::model::Robot;
use crate::spatial::Twist;

/// Screw of every joint at `tcp` (m, base), per unit of chain position.
pub fn screws_at(robot: &Robot, frames: &Frames, tcp: &Point3<f64>) -> Vec<Twist> {
    let mut screws = vec![Twist::ZERO; robot.joints().len()];
    screws_into(robot, frames, tcp, &mut screws);
    screws
}

/// Bend of the wrist at joint positions `q`: the angle between axes 4 and 6, 0 to 90 deg (rad). `None` of an arm
/// without named branches, whose wrist is not defined by two axes.
pub fn wrist_bend(robot: &Robot, q: &[f64]) -> Option<f64> {
    let screws = screws_at(robot, &forward(robot, q), &Point3::origin());
    let [fourth, sixth] = axes_4_and_6(robot, &screws).filter(|_| screws.len() == 6)?;
    let (sine, cosine) = (fourth.cross(&sixth).norm(), fourth.dot(&sixth));
    Some(sine.atan2(cosine.abs()))
}

/// Directions of axes 4 and 6 of an arm with named branches, from the screws of all joints.
pub(crate) fn axes_4_and_6(robot: &Robot, screws: &[Twist]) -> Option<[Vector3<f64>; 2]> {
    let axis = |number| Some(screws.get(robot.joint_of_arm(number))?.angular);
    robot
        .inverse()
        .has_branches()
        .then(|| Some([axis(3)?, axis(5)?]))?
}

/// [`screws_at`] into existing screws, one per joint.
pub fn screws_into(robot: &Robot, frames: &Frames, tcp: &Point3<f64>, screws: &mut [Twist]) {
    chain_screws_into(robot.chain(), frames, tcp, screws);
}

/// [`screws_into`] of a chain.
pub(super) fn chain_screws_into(chain: &Chain, frames: &Frames, tcp: &Point3<f64>, screws: &mut [Twist]) {
    for (index, screw) in screws.iter_mut().enumerate() {
        let z = chain_axis(chain, frames, index);
        *screw = screw_at(&chain.links()[index].motion, z, &frames.origin(index), tcp);
    }
}

/// Screw at `tcp` of a joint with this motion along or about the unit axis `z` through `origin`; m, base.
pub(super) fn screw_at(motion: &Motion, z: Vector3<f64>, origin: &Point3<f64>, tcp: &Point3<f64>) -> Twist {
    let turns = matches!(motion, Motion::About(..));
    // Number by number: a choice between vectors goes through memory, and waits for it.
    let one_of = |turned: f64, slid: f64| if turns { turned } else { slid };
    let v = z.cross(&(tcp - origin));
    Twist {
        linear: Vector3::new(one_of(v.x, z.x), one_of(v.y, z.y), one_of(v.z, z.z)),
        angular: Vector3::new(one_of(z.x, 0.0), one_of(z.y, 0.0), one_of(z.z, 0.0)),
    }
}

/// The Jacobian, 6 x n, translation first: TCP twist per unit of joint position `q`.
pub fn jacobian(robot: &Robot, screws: &[Twist]) -> Matrix6xX<f64> {
    let mut jacobian = Matrix6xX::zeros(screws.len());
    for (index, (joint, screw)) in robot.joints().iter().zip(screws).enumerate() {
        let column = screw.to_vector() * joint.sign.factor();
        let mut own = jacobian.column_mut(index);
        own += column;
        for coupling in &joint.coupling {
            let mut other = jacobian.column_mut(coupling.joint);
            other += column * coupling.factor;
        }
    }
    jacobian
}

/// Product of the singular values of the Jacobian (Yoshikawa 1985): 0 where the arm is singular. SI units, so
/// comparable between postures of one arm only.
pub fn manipulability(jacobian: &Matrix6xX<f64>) -> f64 {
    let joints = jacobian.ncols();
    let tall = if joints < 6 {
        DMatrix::from_fn(6, joints, |i, j| jacobian[(i, j)])
    } else {
        jacobian.transpose().resize(joints, 6, 0.0)
    };
    tall.qr().r().diagonal().product().abs()
}

/// Largest over smallest singular value of the Jacobian with rotations weighted by `length` (m); `None` where the
/// arm is singular or has fewer than six joints. Above 1e7 is singular.
pub fn condition_number(jacobian: &Matrix6xX<f64>, length: f64) -> Option<f64> {
    let mut weighed = jacobian.clone();
    weighed.rows_mut(3, 3).scale_mut(length);
    // Squares of the singular values: nalgebra's own decomposition sometimes loses digits.
    let squares = (&weighed * weighed.transpose()).symmetric_eigenvalues();
    (squares.min() > squares.max() * 36.0 * f64::EPSILON).then(|| (squares.max() / squares.min()).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arms;
    use crate::robot::deflected_arm::twist_between;
    use crate::robot::forward::forward;

    #[test]
    fn two_equal_axes_are_singular_and_six_orthogonal_screws_are_not() {
        let orthogonal = Matrix6xX::identity(6) * 2.0;
        assert!((manipulability(&orthogonal) - 64.0).abs() < 1e-13);
        let two = orthogonal.columns(0, 2).into_owned();
        assert!((manipulability(&two) - 4.0).abs() < 1e-13);
        assert!((condition_number(&orthogonal, 1.0).unwrap() - 1.0).abs() < 1e-13);
        let mut doubled = orthogonal;
        let first = doubled.column(0).into_owned();
        doubled.set_column(1, &first);
        assert!(manipulability(&doubled) < 1e-12);
        assert_eq!(condition_number(&doubled, 1.0), None);
    }

    /// The Jacobian of the flange by central differences in controller coordinates.
    fn by_differences(robot: &Robot, q: &[f64], h: f64) -> Matrix6xX<f64> {
        let columns: Vec<nalgebra::Vector6<f64>> = (0..q.len())
            .map(|joint| {
                let at = |by: f64| {
                    let mut moved = q.to_vec();
                    moved[joint] += by;
                    forward(robot, &moved).base_from_flange
                };
                (twist_between(&at(-h), &at(h)) * (0.5 / h)).to_vector()
            })
            .collect();
        Matrix6xX::from_columns(&columns)
    }

    #[test]
    fn columns_match_differences_also_for_coupled_and_prismatic_joints() {
        let mut stream = arms::Stream(4);
        let arms = [
            arms::r2000ic(),
            arms::hung(),
            arms::other::on_rail(&arms::r2000ic()),
        ];
        for robot in arms {
            for _ in 0..20 {
                let q = stream.joints(&robot);
                let frames = forward(&robot, &q);
                let flange = frames.base_from_flange.translation.vector.into();
                let found = jacobian(&robot, &screws_at(&robot, &frames, &flange));
                // h^2 of the third derivative (some metres), and rounding of some metres over h.
                let away = (found - by_differences(&robot, &q, 1e-5)).amax();
                assert!(away < 1e-9, "{}: {away}", robot.name());
            }
        }
    }

    #[test]
    fn manipulability_is_the_root_of_the_determinant_and_the_product_of_singular_values() {
        let mut stream = arms::Stream(6);
        for robot in [arms::mh12(), arms::other::iiwa14()] {
            for _ in 0..20 {
                let q = stream.joints(&robot);
                let frames = forward(&robot, &q);
                let flange = frames.base_from_flange.translation.vector.into();
                let j = jacobian(&robot, &screws_at(&robot, &frames, &flange));
                let root = (&j * j.transpose()).determinant().abs().sqrt();
                // The determinant loses the square of the condition number: 1e3 squared times eps.
                assert!((manipulability(&j) - root).abs() < 1e-8, "{root}");
                let one_less = j.clone().remove_column(0);
                assert!(manipulability(&one_less) >= 0.0);
            }
        }
    }

    #[test]
    fn the_condition_number_does_not_depend_on_the_base_and_needs_six_joints() {
        let robot = arms::mh12();
        let q = arms::Stream(11).joints(&robot);
        let frames = forward(&robot, &q);
        let flange = frames.base_from_flange.translation.vector.into();
        let j = jacobian(&robot, &screws_at(&robot, &frames, &flange));
        let turn = nalgebra::Rotation3::from_euler_angles(0.4, -0.7, 2.0);
        let mut turned = j.clone();
        for column in 0..6 {
            for half in [0, 3] {
                let v = turn * j.fixed_view::<3, 1>(half, column);
                turned.fixed_view_mut::<3, 1>(half, column).copy_from(&v);
            }
        }
        let (a, b) = (
            condition_number(&j, 1.0).unwrap(),
            condition_number(&turned, 1.0).unwrap(),
        );
        assert!(a >= 1.0 && (a / b - 1.0).abs() < 1e-9, "{a} {b}");
        assert_eq!(condition_number(&j.columns(0, 5).into_owned(), 1.0), None);
    }
}
