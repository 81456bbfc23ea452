//! Name and singularity of a posture of a calibrated arm from its chain positions: the formulas of `robot::inverse` for
//! closed forms.
//!
//! ```text
//! r = a1 + l2 sin psi + l3 sin chi + hand        front where r >= 0
//! elbow up where sin(chi - psi) and r - a1 - hand have one sign         no flip where sin(bend) >= 0
//! ```

use super::found::state;
use crate::numbers::{BLOCK, Float, Plane, Real, Work, sin_cos};
use crate::robot::inverse::ClosedForm;
use crate::robot::inverse::two_links::NEAR_SINGULAR;
use crate::robot::{Branch, Elbow, Shoulder, Wrist};

/// Constants of a closed form that name its branches. Lengths m, angles rad.
#[derive(Clone, Debug)]
pub(super) struct NameConstants {
    pub sense: [f64; 6],
    pub upper_arm_at_zero: f64,
    pub forearm_at_zero: f64,
    pub bend_at_zero: f64,
    pub a1: f64,
    pub l2: f64,
    pub l3: f64,
    /// From axis 4 to the wrist centre at chain zero, forwards and up: of arms with three parallel axes.
    pub hand: Option<[f64; 2]>,
}

impl NameConstants {
    pub fn of(form: &ClosedForm) -> NameConstants {
        match form {
            ClosedForm::OrthoParallel(arm) => NameConstants {
                sense: arm.sense,
                upper_arm_at_zero: arm.upper_arm_at_zero,
                forearm_at_zero: arm.forearm_at_zero,
                bend_at_zero: arm.bend_at_zero,
                a1: arm.a1,
                l2: arm.links.l2,
                l3: arm.links.l3,
                hand: None,
            },
            ClosedForm::ThreeParallel(arm) => NameConstants {
                sense: arm.sense,
                upper_arm_at_zero: arm.upper_arm_at_zero,
                forearm_at_zero: arm.forearm_at_zero,
                bend_at_zero: arm.bend_at_zero,
                a1: arm.a1,
                l2: arm.links.l2,
                l3: arm.links.l3,
                hand: Some([arm.hand.x, arm.hand.z]),
            },
        }
    }
}

/// Fills the singularities; makes points undecided whose posture is not in `branch`.
pub(super) struct CheckNames<'a, T> {
    pub names: &'a NameConstants,
    pub branch: Branch,
    pub theta: &'a [Plane<T>],
    pub state: &'a mut Plane<T>,
    pub singularity: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for CheckNames<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let names = self.names;
        let sense = |k: usize| R::of(names.sense[k]);
        let (s2, s3, s4, s5) = (sense(1), sense(2), sense(3), sense(4));
        let (upper, fore) = (R::of(names.upper_arm_at_zero), R::of(names.forearm_at_zero));
        let bend_at_zero = R::of(names.bend_at_zero);
        let (a1, l2, l3) = (R::of(names.a1), R::of(names.l2), R::of(names.l3));
        let [hand_x, hand_z] = names.hand.unwrap_or_default();
        let (hand_x, hand_z, has_hand) = (R::of(hand_x), R::of(hand_z), names.hand.is_some());
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let near = R::of(NEAR_SINGULAR);
        let near_shoulder = R::of(NEAR_SINGULAR * (names.l2 + names.l3));
        let branch = self.branch;
        let sign = |positive: bool| R::of(if positive { 1.0 } else { -1.0 });
        let front = sign(branch.shoulder == Shoulder::Front);
        let up = sign(branch.elbow == Elbow::Up);
        let plain = sign(branch.wrist == Wrist::NoFlip);
        let (reached, undecided) = (R::of(state::REACHED), R::of(state::UNDECIDED));
        let mut u = [T::default(); BLOCK];
        let (mut sin_elbow, mut turned) = (u, u);
        for i in 0..BLOCK {
            R::step();
            let first = s2 * R::load(self.theta[1][i]);
            let both = s3.mul_add(R::load(self.theta[2][i]), first);
            let (sp, cp) = sin_cos(upper + first);
            let (sc, cc) = sin_cos(fore + both);
            u[i] = l2.mul_add(sp, l3 * sc).store();
            sin_elbow[i] = sc.mul_add(cp, -(cc * sp)).store();
            turned[i] = both.store();
        }
        let mut r = u;
        for i in 0..BLOCK {
            R::step();
            r[i] = (a1 + R::load(u[i])).store();
        }
        if has_hand {
            for i in 0..BLOCK {
                R::step();
                let (sh, ch) = sin_cos(s4.mul_add(R::load(self.theta[3][i]), R::load(turned[i])));
                let hand = hand_x.mul_add(ch, hand_z * sh);
                r[i] = (R::load(r[i]) + hand).store();
            }
        }
        let mut sin_bend = u;
        for i in 0..BLOCK {
            R::step();
            let (sin, _) = sin_cos(s5.mul_add(R::load(self.theta[4][i]), bend_at_zero));
            sin_bend[i] = sin.store();
        }
        for i in 0..BLOCK {
            R::step();
            let (r, u) = (R::load(r[i]), R::load(u[i]));
            let (sin_elbow, sin_bend) = (R::load(sin_elbow[i]), R::load(sin_bend[i]));
            // Least sign of the three: -1 where one differs.
            let (side, lift) = (r.sign() * front, sin_elbow.sign() * u.sign() * up);
            let same = side.min(lift).min(sin_bend.sign() * plain);
            let before = R::load(self.state[i]);
            let renamed = R::either(same < zero, undecided, before);
            self.state[i] = R::either(before > reached, before, renamed).store();
            let found = R::either(r.abs() < near_shoulder, R::of(3.0), zero);
            let found = R::either(sin_elbow.abs() < near, R::of(2.0), found);
            self.singularity[i] = R::either(sin_bend.abs() < near, one, found).store();
        }
    }
}
