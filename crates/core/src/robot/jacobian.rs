//! Screws and Jacobian at the tool centre point.
//!
//! Joint `i` with unit axis `z` through `o`, TCP `p`, all in base: `s_i = [z x (p - o); z]` for a turning
//! joint, `s_i = [z; 0]` for a sliding one. The screws belong to the chain positions `theta`; the Jacobian
//! to the joint positions `q` that a user types: `J = S dtheta/dq`.
//!
//! Reference point: the TCP. Basis: base. m/rad and rad/rad. Source: `docs/theory/chain.md`.

use nalgebra::{DMatrix, Matrix6xX, Point3};

use super::chain::{Chain, Motion};
use super::forward::{Frames, chain_axis};
use super::model::Robot;
use crate::spatial::Twist;

/// Screw of every joint at `tcp` (m, base), per unit of chain position.
pub fn screws_at(robot: &Robot, frames: &Frames, tcp: &Point3<f64>) -> Vec<Twist> {
    let mut screws = vec![Twist::ZERO; robot.joints().len()];
    screws_into(robot, frames, tcp, &mut screws);
    screws
}

/// [`screws_at`] into screws that exist already, one a joint.
pub fn screws_into(robot: &Robot, frames: &Frames, tcp: &Point3<f64>, screws: &mut [Twist]) {
    chain_screws_into(robot.chain(), frames, tcp, screws);
}

/// [`screws_into`] of a chain.
pub(super) fn chain_screws_into(chain: &Chain, frames: &Frames, tcp: &Point3<f64>, screws: &mut [Twist]) {
    for (index, screw) in screws.iter_mut().enumerate() {
        let z = chain_axis(chain, frames, index);
        *screw = match chain.links()[index].motion {
            Motion::About(..) => Twist {
                linear: z.cross(&(tcp - frames.origin(index))),
                angular: z,
            },
            Motion::Along(..) => Twist::along(z),
        };
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

/// Largest over smallest singular value of the Jacobian with rotations weighed by `length` (m); `None` where the
/// arm is singular or has fewer than six joints. Above 1e7 counts as singular.
pub fn condition_number(jacobian: &Matrix6xX<f64>, length: f64) -> Option<f64> {
    let mut weighed = jacobian.clone();
    weighed.rows_mut(3, 3).scale_mut(length);
    // Squares of the singular values: those of nalgebra's own decomposition lose digits now and then.
    let squares = (&weighed * weighed.transpose()).symmetric_eigenvalues();
    (squares.min() > squares.max() * 36.0 * f64::EPSILON).then(|| (squares.max() / squares.min()).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
