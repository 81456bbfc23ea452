//! Joint positions of a posture, and how far they are from their limits.
//!
//! Positions cost six arc tangents. Where only inside or outside counts, [`Cosines`] tells it from cosines:
//! `cos(phi - middle) >= cos(half range)`.

use nalgebra::Vector3;

use super::angle::atan2;
use super::arm::Arm;
use super::backend::Work;
use super::block::{Aims, BLOCK, aim};
use super::prepared::Prepared;
use super::real::{Float, Real};
use super::solve::{Aim, Links, Postures, Solved, flag, flagged, turned};
use super::vector::Vector;

/// How the joints count and how far they go, in every lane.
#[derive(Clone, Copy)]
pub(super) struct Counting<R> {
    rows: [Row<R>; 6],
    coupling: [[R; 6]; 6],
}

#[derive(Clone, Copy)]
struct Row<R> {
    gain: R,
    start: R,
    middle: R,
    half: R,
    /// Turns that the middle is away from zero, and a hair.
    middle_turns: R,
}

impl<R: Real> Counting<R> {
    #[inline(always)]
    pub fn new(arm: &Arm) -> Self {
        let row = |i: usize| {
            let joint = arm.joints[i];
            Row {
                gain: R::of(joint.gain),
                start: R::of(joint.start),
                middle: R::of(joint.middle),
                half: R::of(joint.half),
                middle_turns: R::of(
                    joint.middle / std::f64::consts::TAU + <R::Float as Float>::HALF_TURN_SLACK,
                ),
            }
        };
        let coupling = |i: usize| {
            let k = arm.coupling[i];
            [
                R::of(k[0]),
                R::of(k[1]),
                R::of(k[2]),
                R::of(k[3]),
                R::of(k[4]),
                R::of(k[5]),
            ]
        };
        Counting {
            rows: [row(0), row(1), row(2), row(3), row(4), row(5)],
            coupling: [
                coupling(0),
                coupling(1),
                coupling(2),
                coupling(3),
                coupling(4),
                coupling(5),
            ],
        }
    }

    /// Joint positions from the arm's angles, each as near as possible to the middle of its range.
    #[inline(always)]
    pub fn positions<const COUPLED: bool>(&self, phi: [R; 6]) -> [R; 6] {
        use std::f64::consts::TAU;
        let mut q = phi;
        let mut i = 0;
        while i < 6 {
            let row = self.rows[i];
            let mut at = row.gain.mul_add(phi[i], row.start);
            if COUPLED {
                let mut j = 0;
                while j < i {
                    at = (-self.coupling[i][j]).mul_add(q[j], at);
                    j += 1;
                }
            }
            let turns = at.mul_add(R::of(1.0 / TAU), -row.middle_turns).round();
            q[i] = (-turns).mul_add(R::of(TAU), at);
            i += 1;
        }
        q
    }

    /// The arm's angles from joint positions.
    #[inline(always)]
    pub fn angles<const COUPLED: bool>(&self, q: [R; 6]) -> [R; 6] {
        let mut phi = q;
        let mut i = 0;
        while i < 6 {
            let row = self.rows[i];
            let mut at = q[i] - row.start;
            if COUPLED {
                let mut j = 0;
                while j < i {
                    at = self.coupling[i][j].mul_add(q[j], at);
                    j += 1;
                }
            }
            // The gain is 1 or -1: its own inverse.
            phi[i] = row.gain * at;
            i += 1;
        }
        phi
    }

    /// Least distance to a limit, negative outside, and the joint that has it.
    #[inline(always)]
    pub fn room(&self, q: &[R; 6]) -> (R, R) {
        let room = |i: usize| self.rows[i].half - (q[i] - self.rows[i].middle).abs();
        let (mut least, mut joint) = (room(0), R::of(0.0));
        let mut i = 1;
        while i < 6 {
            let this = room(i);
            let less = this < least;
            least = R::either(less, this, least);
            joint = R::either(less, R::of(i as f64), joint);
            i += 1;
        }
        (least, joint)
    }
}

/// The arm's angles with the wrist not flipped: phi1, psi, chi - psi, phi4, bend, phi6.
#[inline(always)]
pub(super) fn angles<R: Real>(links: &Links<R>, aim: &Aim<R>, solved: &Solved<R>) -> [R; 6] {
    let [a5, a3] = links.wrist_axes(solved);
    let [phi1, psi, chi] = atan2(
        [solved.s1, solved.sp, solved.sc],
        [solved.c1, solved.cp, solved.cc],
    );
    let [phi4, bend, phi6] = atan2(
        [
            aim.out.dot(a5),
            solved.n2.sqrt(),
            solved.n.dot(aim.second.cross(aim.out)),
        ],
        [-aim.out.dot(a3), solved.z4.dot(aim.out), solved.n.dot(aim.second)],
    );
    [phi1, psi, chi - psi, phi4, bend, phi6]
}

/// The same posture with the wrist flipped.
#[inline(always)]
pub(super) fn flipped<R: Real>(phi: [R; 6]) -> [R; 6] {
    let half_turn = R::of(std::f64::consts::PI);
    [
        phi[0],
        phi[1],
        phi[2],
        phi[3] + half_turn,
        -phi[4],
        phi[5] + half_turn,
    ]
}

/// Limits told by cosines of the arm's angles.
#[derive(Clone, Debug)]
pub(super) struct CosineLimits {
    rows: [[f64; 3]; 6],
    /// Joint 3 counts from the vertical (its coupling to joint 2 takes that one's turn away).
    third_from_vertical: bool,
    /// Across axis 4 in the upright forearm: where axis 6 points with joint 4 in the middle of its range.
    forearm_middle: Vector3<f64>,
    /// Across axis 6 in the tool's axes: where axis 5 lies with joint 6 in the middle of its range.
    pub tool_middle: Vector3<f64>,
    /// Whether joint 4 or 6 has less than a turn.
    pub swivels: bool,
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
    /// has less than a turn.
    #[inline(always)]
    fn flags<const SWIVELS: bool>(&self, flags: R, aim: &Aim<R>, solved: &Solved<R>) -> R {
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

        let bent = solved.n2.sqrt();
        let along = solved.z4.dot(aim.out);
        let (mut wrist, mut flipped) = (row(4, along, bent), row(4, along, -bent));
        if SWIVELS {
            let middle = turned(self.forearm_middle, cc, sc, solved.c1, solved.s1);
            let (fourth, sixth) = (aim.out.dot(middle), solved.n.dot(aim.second));
            let (least_4, least_6) = (self.rows[3][2] * bent, self.rows[5][2] * bent);
            wrist = wrist.min(fourth - least_4).min(sixth - least_6);
            flipped = flipped.min(-fourth - least_4).min(-sixth - least_6);
        }
        let flags = flagged(flags, arm.min(wrist) < zero, flag::OUTSIDE_LIMITS);
        flagged(flags, arm.min(flipped) < zero, flag::OUTSIDE_LIMITS_FLIPPED)
    }
}

/// Adds the flags of the joint limits, told by cosines. Not checked: the aims' axis 5 must be
/// [`CosineLimits::tool_middle`].
pub(super) struct LimitsByCosines<'a, T, const STILL: bool, const SWIVELS: bool> {
    pub limits: &'a CosineLimits,
    pub aims: &'a Aims<T>,
    pub postures: &'a mut Postures<T>,
}

impl<T: Float, const STILL: bool, const SWIVELS: bool> Work<T> for LimitsByCosines<'_, T, STILL, SWIVELS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let cosines = Cosines::<R>::new(self.limits);
        for i in 0..BLOCK {
            R::step();
            let (aim, solved) = (aim::<R, STILL>(self.aims, i), Solved::load(self.postures, i));
            let flags = R::load(self.postures.flags[i]);
            self.postures.flags[i] = cosines.flags::<SWIVELS>(flags, &aim, &solved).store();
        }
    }
}

/// Adds the flags of the joint limits, told by joint positions: for arms whose coupling cosines do not see.
pub(super) struct LimitsByAngles<'a, T> {
    pub prepared: &'a Prepared,
    pub aims: &'a Aims<T>,
    pub postures: &'a mut Postures<T>,
}

impl<T: Float> Work<T> for LimitsByAngles<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let links = Links::<R>::new(&self.prepared.arm);
        let counting = Counting::<R>::new(&self.prepared.arm);
        let at_limit = R::of(-<T as Float>::AT_LIMIT);
        for i in 0..BLOCK {
            R::step();
            let phi = angles(
                &links,
                &aim::<R, false>(self.aims, i),
                &Solved::load(self.postures, i),
            );
            let (room, _) = counting.room(&counting.positions::<true>(phi));
            let (room_flipped, _) = counting.room(&counting.positions::<true>(flipped(phi)));
            let flags = R::load(self.postures.flags[i]);
            let flags = flagged(flags, room < at_limit, flag::OUTSIDE_LIMITS);
            let flags = flagged(flags, room_flipped < at_limit, flag::OUTSIDE_LIMITS_FLIPPED);
            self.postures.flags[i] = flags.store();
        }
    }
}
