//! Joint limits of a posture, tested without its angles: `cos(phi - middle) >= cos(half range)`.

use super::closed_form::{Postures, Solved, flag, flagged, turned};
use crate::kernel::lanes::geometry::{Aim, Aims, CosineLimits, aim};
use crate::numbers::{BLOCK, Float, Real, Vector, Work};

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
pub(in crate::kernel::lanes) struct LimitsByCosines<
    'a,
    T,
    const STILL: bool,
    const SWIVELS: bool,
    const ASKEW: bool,
> {
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
