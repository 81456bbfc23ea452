//! Backlash: positions of the links within the backlash of their joints.
//!
//! ```text
//! u_i(k) = clamp(u_i(k-1) - (theta_i(k) - theta_i(k-1)), -b_i/2, b_i/2)        friction: the link stays until contact
//! u_i    = (b_i/2) sign(tau_i)                                                side given by the torque
//! u_i    = +- b_i/2, the signs with which |P (d + sum u_i s_i)| is largest     side unknown: the worst case
//! delta  = sum u_i s_i
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `u` | link minus motor | rad (m) |
//! | `b` | the whole backlash | rad (m) |
//! | `theta` | position of the motor, in the coordinates of the chain | rad (m) |
//! | `tau` | torque of load and gravity on the link | N m (N) |
//! | `s` | screw of the joint at the TCP | |
//! | `d`, `P` | displacement of the tool by all other sources, m; the projection across the normal | |
//!
//! Once a joint has moved on by its backlash, `u = -(b/2) sigma` with `sigma` the sign of its speed: the link lags
//! behind the motor.
//!
//! Source: the play operator of backlash, as in Nordin and Gutman, Controlling mechanical systems with backlash: a
//! survey, Automatica 38, 2002 \[recalled\]; `docs/theory/unloaded.md`.

use nalgebra::Vector2;

use crate::robot::{Backlash, BacklashSide, STANDSTILL};
use crate::spatial::{Twist, Wrench};

/// Offset of a link from its motor (rad, m) after the motor has moved by `moved`; `before` is the offset before.
pub fn kept_by_friction(before: f64, moved: f64, gap: f64) -> f64 {
    (before - moved).clamp(-0.5 * gap, 0.5 * gap)
}

/// Torques below this do not decide the side, N m (N): rounding, far below the friction of any joint.
pub(crate) const NO_TORQUE: f64 = 1e-6;

/// Offset of a link (rad, m) after each of these moves of its motor, after a run-in: at first on the side that its
/// first real move gives, or in the middle of its backlash if it does not move at all.
pub fn along<M: Iterator<Item = f64> + Clone>(moves: M, gap: f64) -> impl Iterator<Item = f64> {
    let mut gone = moves.clone().scan(0.0, |gone, by| {
        *gone += by;
        Some(*gone)
    });
    let first = gone.find(|gone| gone.abs() > STANDSTILL);
    let mut offset = first.map_or(0.0, |gone| -0.5 * gap * gone.signum());
    moves.map(move |by| {
        offset = kept_by_friction(offset, by, gap);
        offset
    })
}

/// Offset of the link of a joint with this screw from its motor, rad (m): `kept`, where friction keeps it, or on the
/// side given by `torque` (N m, N; of the weight on it) and `wrench`.
pub fn link_offset(backlash: &Backlash, kept: f64, screw: &Twist, wrench: &Wrench, torque: f64) -> f64 {
    let torque = torque + screw.dot(wrench);
    match backlash.side {
        BacklashSide::Torque if torque.abs() > NO_TORQUE => 0.5 * backlash.gap * torque.signum(),
        BacklashSide::Torque | BacklashSide::Motion => kept,
    }
}

/// Writes the signs with which `from + sum sign_i halves_i` is longest (in a plane, m); 0 for a zero half.
///
/// The sums fill a zonotope, and the farthest is one of its corners: at the two ends of the edge along a half every
/// other half has the sign of its side of that edge. Of corners that are equally far the first.
pub fn farthest(from: Vector2<f64>, halves: &[Vector2<f64>], signs: &mut [f64]) {
    signs.fill(0.0);
    let corner = |edge: &Vector2<f64>, side: f64, end: f64, half: &Vector2<f64>| {
        let across = edge.perp(half);
        // Halves along the edge have the sign of its end.
        let leans = if across == 0.0 {
            end * edge.dot(half)
        } else {
            side * across
        };
        if leans == 0.0 { 0.0 } else { leans.signum() }
    };
    let mut most = f64::NEG_INFINITY;
    for edge in halves.iter().filter(|edge| **edge != Vector2::zeros()) {
        for (side, end) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let sum: Vector2<f64> = halves
                .iter()
                .map(|half| half * corner(edge, side, end, half))
                .sum();
            let far = (from + sum).norm();
            if far > most {
                most = far;
                for (sign, half) in signs.iter_mut().zip(halves) {
                    *sign = corner(edge, side, end, half);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_other_combination_of_sides_is_farther(
            from in prop::array::uniform2(-1.0_f64..1.0),
            halves in prop::collection::vec(prop::array::uniform2(-3_i8..4), 0..7),
        ) {
            // Whole numbers: many halves are parallel, equal, or zero.
            let from = Vector2::from(from);
            let halves: Vec<Vector2<f64>> = halves.iter().map(|half| Vector2::from(half.map(f64::from))).collect();
            let far = |signs: &[f64]| {
                let sum: Vector2<f64> = halves.iter().zip(signs).map(|(half, sign)| half * *sign).sum();
                (from + sum).norm()
            };
            let mut signs = vec![f64::NAN; halves.len()];
            farthest(from, &halves, &mut signs);
            for (sign, half) in signs.iter().zip(&halves) {
                prop_assert_eq!(sign.abs(), f64::from(*half != Vector2::zeros()));
            }
            let all = 1_usize << halves.len();
            let every = (0..all).map(|sides| {
                let sign = |joint: usize| if sides >> joint & 1 == 0 { 1.0 } else { -1.0 };
                far(&(0..halves.len()).map(sign).collect::<Vec<f64>>())
            });
            prop_assert!((far(&signs) - every.fold(0.0, f64::max)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_link_lags_by_half_its_backlash_and_stays_while_the_backlash_is_crossed() {
        let gap = 2e-4;
        let moves = [
            1e-3, 1e-3, -5e-5, -5e-5, -5e-5, -5e-5, -1e-3, 3e-5, 0.0, -3e-5, 1e-3,
        ];
        let (mut lag, mut motor, mut links) = (-0.5 * gap, 0.0, Vec::new());
        for by in moves {
            lag = kept_by_friction(lag, by, gap);
            motor += by;
            links.push(motor + lag);
        }
        // Forwards: half the backlash behind; then the link waits for the whole backlash; then half the other way.
        let given = [
            0.9e-3, 1.9e-3, 1.9e-3, 1.9e-3, 1.9e-3, 1.9e-3, 0.9e-3, 0.9e-3, 0.9e-3, 0.9e-3, 1.7e-3,
        ];
        for (link, given) in links.iter().zip(given) {
            assert!((link - given).abs() < 1e-15, "{links:?}");
        }
    }

    #[test]
    fn a_run_in_takes_the_side_of_the_first_real_move() {
        let after = |moves: &[f64]| along(moves.iter().copied(), 2e-4).collect::<Vec<f64>>();
        assert_eq!(after(&[0.0, -0.1, 0.3]), [1e-4, 1e-4, -1e-4]);
        // Moves within rounding are ignored; a slow joint moves in the end.
        assert!(after(&[1e-16, -2e-16]).iter().all(|offset| offset.abs() < 1e-15));
        assert_eq!(after(&[0.0, 4e-7, 4e-7, 4e-7]), [-1e-4; 4]);
        assert_eq!(after(&[]), [0.0; 0]);
    }

    #[test]
    fn a_torque_decides_the_side_and_without_a_torque_friction_does() {
        let screw = Twist {
            linear: Vector3::x(),
            angular: Vector3::z(),
        };
        let push = |x: f64| Wrench::from_force(Vector3::new(x, 0.0, 0.0));
        let offset = |side, wrench: &Wrench, torque| {
            let backlash = Backlash {
                gap: 2e-4,
                standard_uncertainty: 0.0,
                side,
            };
            link_offset(&backlash, -3e-5, &screw, wrench, torque)
        };
        assert_eq!(offset(BacklashSide::Torque, &push(5.0), 0.0), 1e-4);
        assert_eq!(offset(BacklashSide::Torque, &push(5.0), -6.0), -1e-4);
        assert_eq!(offset(BacklashSide::Torque, &Wrench::ZERO, 0.0), -3e-5);
        assert_eq!(offset(BacklashSide::Torque, &Wrench::ZERO, 1e-12), -3e-5);
        assert_eq!(offset(BacklashSide::Motion, &push(5.0), 7.0), -3e-5);
    }
}
