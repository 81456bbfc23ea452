//! Chain positions to joint positions: signs, zeros, coupling and whole turns; of one posture, and of eight at once.

use std::f64::consts::TAU;

use super::super::super::forward_of_eight::JointsOfEight;
use super::super::super::model::Robot;
use crate::numbers::{Eight, Lanes, Real};

/// What eight postures are made from.
pub(super) struct ChainPositions<'a> {
    /// Chain positions of each joint of the arm.
    pub theta: &'a [Eight],
    /// Joint positions of its rail.
    pub rail: &'a [f64],
    /// Joint positions of the pose before.
    pub near: Option<&'a [f64]>,
    /// A joint that stays at this position.
    pub fixed: Option<(usize, f64)>,
}

/// Where whole turns bring a revolute joint: as near as possible to the previous position within its limits, otherwise
/// to the middle of its range. An ortho-parallel arm always takes the middle, as the lanes of the kernel do.
#[derive(Clone, Copy)]
pub(crate) struct WholeTurns {
    near: f64,
    middle: f64,
    lower: f64,
    upper: f64,
}

impl WholeTurns {
    /// Those of joint `joint`; `near` are the joint positions before.
    pub fn of(robot: &Robot, joint: usize, near: Option<&[f64]>) -> WholeTurns {
        let limits = robot.joints()[joint].limits;
        let middle = limits.map_or(0.0, |limits| limits.middle());
        let near = near.filter(|_| robot.ortho_parallel().is_none());
        WholeTurns {
            near: near.map_or(middle, |near| near[joint]),
            middle,
            lower: limits.map_or(f64::NEG_INFINITY, |limits| limits.lower),
            upper: limits.map_or(f64::INFINITY, |limits| limits.upper),
        }
    }

    /// `position` (rad) after these whole turns.
    #[inline(always)]
    pub fn applied<R: Real>(&self, position: R) -> R {
        let close = nearest_turn(position, self.near);
        let inside = (close >= R::of(self.lower)) & (close <= R::of(self.upper));
        R::either(inside, close, nearest_turn(position, self.middle))
    }
}

/// `angle` plus whole turns, in (middle - pi, middle + pi].
#[inline(always)]
fn nearest_turn<R: Real>(angle: R, middle: f64) -> R {
    // Slightly below -half a turn is half a turn: -180 deg and 180 deg are one posture.
    let turns = angle
        .mul_add(R::of(1.0 / TAU), R::of(-middle / TAU - 1e-12))
        .round();
    (-turns).mul_add(R::of(TAU), angle)
}

/// Joint positions of eight postures.
#[inline(always)]
pub(super) fn find_joints<R: Real<Float = f64>>(
    robot: &Robot,
    from: &ChainPositions<'_>,
    joints: &mut [Eight],
) {
    for (i, theta) in from.theta.iter().enumerate() {
        let index = from.rail.len() + i;
        if let Some((_, place)) = from.fixed.filter(|(fixed, _)| *fixed == index) {
            joints[i] = Lanes([place; 8]);
            continue;
        }
        let joint = &robot.joints()[index];
        let before = JointsOfEight {
            rail: from.rail,
            arm: &joints[..i],
        };
        let coupled = before.coupled::<R>(joint);
        let turns = WholeTurns::of(robot, index, from.near);
        let (sign, zero) = (R::of(joint.sign.factor()), R::of(joint.zero_offset));
        let mut position = Eight::default();
        for i in 0..8 {
            R::step();
            let uncoupled = sign * (theta.at::<R>(i) - zero);
            position.set(i, turns.applied(uncoupled - coupled.at(i)));
        }
        joints[i] = position;
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::arms::Stream;

    #[test]
    fn the_nearest_turn_is_within_half_a_turn_and_half_a_turn_is_positive() {
        let mut stream = Stream(45);
        for _ in 0..500 {
            let (angle, middle) = (stream.between(-20.0, 20.0), stream.between(-3.0, 3.0));
            let turned = nearest_turn(angle, middle);
            assert!((-PI - 1e-11..=PI + 1e-11).contains(&(turned - middle)));
            assert!((0.5 * (turned - angle)).sin().abs() < 1e-14);
        }
        // -180 deg, 180 deg, and values next to them, are one posture.
        for angle in [-PI, PI, -PI - 1e-13, PI - 1e-13, -PI + 1e-13] {
            assert!((nearest_turn(angle, 0.0) - PI).abs() < 1e-11, "{angle}");
        }
        assert!(nearest_turn(-PI + 1e-9, 0.0) < 0.0);
    }
}
