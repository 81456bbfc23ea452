//! Joint limits of a posture, tested without its angles: `cos(phi - middle) >= cos(half range)`.

use nalgebra::Vector3;

use super::arm::Arm;
use super::backend::Work;
use super::block::{Aims, BLOCK, aim};
use super::real::{Float, Real};
use super::solve::{Aim, Postures, Solved, flag, flagged, turned};
use super::vector::Vector;

/// Limits as cosines of the arm's angles.
#[derive(Clone, Debug)]
pub(super) struct CosineLimits {
    rows: [[f64; 3]; 6],
    /// Joint 3 is measured from the vertical (its coupling to joint 2 removes the turn of joint 2).
    third_from_vertical: bool,
    /// Across axis 4 in the upright forearm: where axis 6 points with joint 4 in the middle of its range.
    forearm_middle: Vector3<f64>,
    /// Across axis 6 in the tool's axes: direction of axis 5 with joint 6 in the middle of its range.
    pub tool_middle: Vector3<f64>,
    /// Whether joint 4 or 6 has less than a turn.
    pub swivels: bool,
    /// Whether the range of joint 5 is not the same to both sides of the straight wrist.
    pub askew: bool,
}

impl CosineLimits {
    /// `None` where joints are coupled in a way that cosines do not see.
    pub fn new(arm: &Arm) -> Option<CosineLimits> {
        let mut alone = arm.coupling;
        let third = std::mem::take(&mut alone[2][1]);
        // q3 = g3 (chi - psi) - k g2 psi: psi cancels where k g2 = -g3.
        let third_from_vertical = third * arm.joints[1].gain == -arm.joints[2].gain;
        if alone.iter().flatten().any(|k| *k != 0.0) || (third != 0.0 && !third_from_vertical) {
            return None;
        }
        let mut counting = arm.clone();
        counting.joints[2].start -= third * arm.joints[1].start;
        let row = |i: usize| counting.cosine_limit(i).unwrap_or([0.0, 0.0, -1.0]);
        let [_, a5, a3] = arm.forearm;
        let (fourth, sixth) = (row(3), row(5));
        let (out, second) = (arm.tool_from_axis_6, arm.tool_from_axis_5);
        Some(CosineLimits {
            rows: [row(0), row(1), row(2), fourth, row(4), sixth],
            third_from_vertical,
            swivels: counting.cosine_limit(3).is_some() || counting.cosine_limit(5).is_some(),
            // A middle that a file rounds to 1e-12 rad from zero is at zero.
            askew: row(4)[1].abs() > 1e-12,
            forearm_middle: a5 * fourth[1] - a3 * fourth[0],
            tool_middle: second * sixth[0] + second.cross(&out) * sixth[1],
        })
    }
}

/// [`CosineLimits`] in every lane.
#[derive(Clone, Copy)]
pub(super) struct Cosines<R> {
    rows: [[R; 3]; 6],
    third_from_elbow: [R; 2],
    third_from_vertical: [R; 2],
    forearm_middle: Vector<R>,
}

impl<R: Real> Cosines<R> {
    #[inline(always)]
    pub fn new(limits: &CosineLimits) -> Self {
        let row = |i: usize| {
            let row = limits.rows[i];
            [R::of(row[0]), R::of(row[1]), R::of(row[2])]
        };
        let third = [R::of(limits.rows[2][0]), R::of(limits.rows[2][1])];
        let none = [R::of(0.0), R::of(0.0)];
        Cosines {
            rows: [row(0), row(1), row(2), row(3), row(4), row(5)],
            third_from_elbow: if limits.third_from_vertical { none } else { third },
            third_from_vertical: if limits.third_from_vertical { third } else { none },
            forearm_middle: Vector::of(&limits.forearm_middle),
        }
    }

    /// `flags` with the bits of the joint limits, for the wrist not flipped and flipped; `SWIVELS` where joint 4 or 6
    /// has less than a turn, `ASKEW` where joint 5 goes farther to one side.
    #[inline(always)]
    fn flags<const SWIVELS: bool, const ASKEW: bool>(&self, flags: R, aim: &Aim<R>, solved: &Solved<R>) -> R {
        let zero = R::of(0.0);
        let Solved { cc, sc, cp, sp, .. } = *solved;
        let row = |i: usize, c: R, s: R| {
            let [to_cos, to_sin, least] = self.rows[i];
            c.mul_add(to_cos, s.mul_add(to_sin, -least))
        };
        let (ce, se) = (cc.mul_add(cp, sc * sp), sc.mul_add(cp, -(cc * sp)));
        let from_elbow = ce.mul_add(self.third_from_elbow[0], se * self.third_from_elbow[1]);
        let third = cc.mul_add(
            self.third_from_vertical[0],
            sc.mul_add(self.third_from_vertical[1], from_elbow - self.rows[2][2]),
        );
        let arm = row(0, solved.c1, solved.s1).min(row(1, cp, sp)).min(third);

        let along = solved.z4.dot(aim.out);
        let (mut wrist, mut flipped) = if ASKEW {
            let bent = solved.n2.sqrt();
            (row(4, along, bent), row(4, along, -bent))
        } else {
            let [to_cos, _, least] = self.rows[4];
            let both = along.mul_add(to_cos, -least);
            (both, both)
        };
        if SWIVELS {
            // Cosines times the sine of the bend; squared with their sign, for the sine is known as a square.
            let squared = |x: R| x * x.abs();
            let middle = turned(self.forearm_middle, cc, sc, solved.c1, solved.s1);
            let fourth = squared(aim.out.dot(middle));
            let sixth = squared(solved.n.dot(aim.second));
            let least_4 = squared(self.rows[3][2]) * solved.n2;
            let least_6 = squared(self.rows[5][2]) * solved.n2;
            wrist = wrist.min(fourth - least_4).min(sixth - least_6);
            flipped = flipped.min(-fourth - least_4).min(-sixth - least_6);
        }
        let flags = flagged(flags, arm.min(wrist) < zero, flag::OUTSIDE_LIMITS);
        flagged(flags, arm.min(flipped) < zero, flag::OUTSIDE_LIMITS_FLIPPED)
    }
}

/// Adds the flags of the joint limits, tested by cosines. Not checked: the aims' axis 5 must be
/// [`CosineLimits::tool_middle`].
pub(super) struct LimitsByCosines<'a, T, const STILL: bool, const SWIVELS: bool, const ASKEW: bool> {
    pub limits: &'a CosineLimits,
    pub aims: &'a Aims<T>,
    pub postures: &'a mut Postures<T>,
}

impl<T: Float, const STILL: bool, const SWIVELS: bool, const ASKEW: bool> Work<T>
    for LimitsByCosines<'_, T, STILL, SWIVELS, ASKEW>
{
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let cosines = Cosines::<R>::new(self.limits);
        for i in 0..BLOCK {
            R::step();
            let (aim, solved) = (aim::<R, STILL>(self.aims, i), Solved::load(self.postures, i));
            let flags = R::load(self.postures.flags[i]);
            self.postures.flags[i] = cosines.flags::<SWIVELS, ASKEW>(flags, &aim, &solved).store();
        }
    }
}
