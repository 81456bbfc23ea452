//! Joint positions of the postures of a block, flipped and not, and their margins to the limits.
//!
//! Loop after loop over one joint: few numbers at a time stay in registers.

use super::closed_form::{Links, Postures, Solved, flag, flagged};
use crate::kernel::lanes::geometry::{Aims, JointRow, Prepared, aim};
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Work, atan2, planes};

/// Joint positions and their margins to the limits; of each pair first the posture not flipped, then the flipped one.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct Positions<T> {
    /// Sines and cosines of joints 4, 5, 6, each times any positive number.
    tangents: Planes<T, 6>,
    /// The arm's angles: phi1, psi, chi - psi, phi4, bend, phi6.
    pub phi: Planes<T, 6>,
    /// Joint positions, rad, each as near as possible to the middle of its range.
    pub joints: [Planes<T, 6>; 2],
    /// Least distance to a limit, negative outside; and the joint that has it.
    pub room: Planes<T, 2>,
    pub nearest: Planes<T, 2>,
    /// The postures' flags with [`flag::OUTSIDE_LIMITS`].
    pub flags: Planes<T, 2>,
}

impl<T: Float> Positions<T> {
    /// Allocates a block.
    pub fn new() -> Positions<T> {
        Positions {
            tangents: planes(),
            phi: planes(),
            joints: [planes(), planes()],
            room: planes(),
            nearest: planes(),
            flags: planes(),
        }
    }
}

/// Fills [`Positions`].
pub(in crate::kernel::lanes) struct Position<'a, T> {
    pub prepared: &'a Prepared,
    pub aims: &'a Aims<T>,
    pub postures: &'a Postures<T>,
    /// Whether phi1 is there from the posture with the other elbow.
    pub same_shoulder: bool,
    pub positions: &'a mut Positions<T>,
}

impl<T: Float> Work<T> for Position<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let Positions {
            tangents,
            phi,
            joints,
            room,
            nearest,
            flags,
        } = self.positions;
        let links = Links::<R>::new(&self.prepared.arm);
        for i in 0..BLOCK {
            R::step();
            let (aim, solved) = (aim::<R, false>(self.aims, i), Solved::load(self.postures, i));
            let [a5, a3] = links.wrist_axes(&solved);
            tangents[0][i] = aim.out.dot(a5).store();
            tangents[1][i] = (-aim.out.dot(a3)).store();
            tangents[2][i] = solved.n2.sqrt().store();
            tangents[3][i] = solved.z4.dot(aim.out).store();
            tangents[4][i] = solved.n.dot(aim.second.cross(aim.out)).store();
            tangents[5][i] = solved.n.dot(aim.second).store();
        }
        let [c1, s1, cp, sp, cc, sc] = self.postures.turns();
        let [first, upper, fore, fourth, bend, sixth] = phi;
        if !self.same_shoulder {
            angle_of::<R>(s1, c1, first);
        }
        angle_of::<R>(sp, cp, upper);
        angle_of::<R>(sc, cc, fore);
        angle_of::<R>(&tangents[0], &tangents[1], fourth);
        angle_of::<R>(&tangents[2], &tangents[3], bend);
        angle_of::<R>(&tangents[4], &tangents[5], sixth);
        for i in 0..BLOCK {
            R::step();
            fore[i] = (R::load(fore[i]) - R::load(upper[i])).store();
        }
        // First the joints of the arm: they are the same whether the wrist is flipped or not.
        let [plain, flipped] = joints;
        for joint in 0..3 {
            let row = Counting::<R>::new(self.prepared, joint, false);
            row.set(&phi[joint], &mut plain[..=joint], [&mut room[0], &mut nearest[0]]);
        }
        flipped[..3].copy_from_slice(&plain[..3]);
        (room[1], nearest[1]) = (room[0], nearest[0]);
        let at_limit = R::of(-<T as Float>::AT_LIMIT);
        for (flip, joints) in [plain, flipped].into_iter().enumerate() {
            let (room, nearest) = (&mut room[flip], &mut nearest[flip]);
            for joint in 3..6 {
                let row = Counting::<R>::new(self.prepared, joint, flip == 1);
                row.set(&phi[joint], &mut joints[..=joint], [room, nearest]);
            }
            for i in 0..BLOCK {
                R::step();
                let before = R::load(self.postures.flags[i]);
                let outside = R::load(room[i]) < at_limit;
                flags[flip][i] = flagged(before, outside, flag::OUTSIDE_LIMITS).store();
            }
        }
    }
}

#[inline(always)]
fn angle_of<R: Real>(y: &Plane<R::Float>, x: &Plane<R::Float>, to: &mut Plane<R::Float>) {
    for i in 0..BLOCK {
        R::step();
        to[i] = atan2(R::load(y[i]), R::load(x[i])).store();
    }
}

/// Subtracts the coupling of another joint.
#[inline(always)]
fn uncouple<R: Real>(factor: f64, other: &Plane<R::Float>, joint: &mut Plane<R::Float>) {
    let factor = R::of(-factor);
    for i in 0..BLOCK {
        R::step();
        joint[i] = factor.mul_add(R::load(other[i]), R::load(joint[i])).store();
    }
}

/// Coupling and range of one joint, in every lane.
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) struct Counting<'a, R> {
    /// What earlier joints add.
    coupling: &'a [f64],
    index: R,
    gain: R,
    start: R,
    middle: R,
    half: R,
    /// Turns that the middle is away from zero, and a hair.
    middle_turns: R,
}

impl<'a, R: Real> Counting<'a, R> {
    /// Joint `index`; with the wrist flipped joints 4 and 6 differ by half a turn, and joint 5 bends the other way.
    #[inline(always)]
    fn new(prepared: &'a Prepared, index: usize, flipped: bool) -> Self {
        use std::f64::consts::PI;
        let joint = prepared.arm.joints[index];
        let turned = if flipped && (index == 3 || index == 5) {
            PI
        } else {
            0.0
        };
        let sense = if flipped && index == 4 { -1.0 } else { 1.0 };
        let row = JointRow {
            gain: sense * joint.gain,
            start: joint.gain.mul_add(turned, joint.start),
            ..joint
        };
        Counting::of(row, &prepared.arm.coupling[index], index)
    }

    /// Joint `index` of this row, with the factors of the earlier joints.
    #[inline(always)]
    pub fn of(row: JointRow, coupling: &'a [f64], index: usize) -> Self {
        use std::f64::consts::TAU;
        Counting {
            coupling,
            index: R::of(index as f64),
            gain: R::of(row.gain),
            start: R::of(row.start),
            middle: R::of(row.middle),
            half: R::of(row.half),
            middle_turns: R::of(row.middle / TAU + <R::Float as Float>::HALF_TURN_SLACK),
        }
    }

    /// Positions of the last of `joints` from its angle; keeps the least room of the joints so far and whose it is.
    #[inline(always)]
    pub fn set(
        &self,
        phi: &Plane<R::Float>,
        joints: &mut [Plane<R::Float>],
        [room, nearest]: [&mut Plane<R::Float>; 2],
    ) {
        let Some((joint, before)) = joints.split_last_mut() else {
            return;
        };
        if self.coupling.iter().all(|factor| *factor == 0.0) {
            for i in 0..BLOCK {
                R::step();
                let q = self.near_the_middle(self.gain.mul_add(R::load(phi[i]), self.start));
                joint[i] = q.store();
                let kept = self.least(q, [R::load(room[i]), R::load(nearest[i])]);
                (room[i], nearest[i]) = (kept[0].store(), kept[1].store());
            }
            return;
        }
        for i in 0..BLOCK {
            R::step();
            joint[i] = self.gain.mul_add(R::load(phi[i]), self.start).store();
        }
        for (factor, other) in self.coupling.iter().zip(before) {
            if *factor != 0.0 {
                uncouple::<R>(*factor, other, joint);
            }
        }
        for i in 0..BLOCK {
            R::step();
            let q = self.near_the_middle(R::load(joint[i]));
            joint[i] = q.store();
            let kept = self.least(q, [R::load(room[i]), R::load(nearest[i])]);
            (room[i], nearest[i]) = (kept[0].store(), kept[1].store());
        }
    }

    /// Takes whole turns away until the joint is within half a turn of the middle of its range.
    #[inline(always)]
    fn near_the_middle(&self, at: R) -> R {
        use std::f64::consts::TAU;
        let turns = at.mul_add(R::of(1.0 / TAU), -self.middle_turns).round();
        (-turns).mul_add(R::of(TAU), at)
    }

    /// The lesser of the room that this joint leaves and the room so far, with its joint; the first joint starts.
    #[inline(always)]
    fn least(&self, q: R, [so_far, whose]: [R; 2]) -> [R; 2] {
        let room = self.half - (q - self.middle).abs();
        let less = (room < so_far) | (self.index == R::of(0.0));
        [R::either(less, room, so_far), R::either(less, self.index, whose)]
    }
}

/// Adds the flags of the joint limits from joint positions: for arms with a coupling that the cosines do not support.
pub(in crate::kernel::lanes) struct LimitsByPositions<'a, T> {
    pub positions: &'a Positions<T>,
    pub postures: &'a mut Postures<T>,
}

impl<T: Float> Work<T> for LimitsByPositions<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let at_limit = R::of(-<T as Float>::AT_LIMIT);
        let [room, room_flipped] = &self.positions.room;
        for i in 0..BLOCK {
            R::step();
            let flags = R::load(self.postures.flags[i]);
            let flags = flagged(flags, R::load(room[i]) < at_limit, flag::OUTSIDE_LIMITS);
            let outside = R::load(room_flipped[i]) < at_limit;
            self.postures.flags[i] = flagged(flags, outside, flag::OUTSIDE_LIMITS_FLIPPED).store();
        }
    }
}
