//! Posture of each point in detail: joint positions, margins to the limits, screws.

use super::closed_form::{Links, Postures, Solved};
use super::positions::Positions;
use super::screws::Screws;
use crate::kernel::lanes::geometry::{Aims, Prepared, aim};
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Work, put};

/// Details of the postures of a block.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct Stances<T> {
    /// Joint positions, rad.
    pub joints: Planes<T, 6>,
    /// Smallest distance to a joint limit, and the joint.
    pub room: Plane<T>,
    pub joint: Plane<T>,
    /// 1 where the wrist is flipped, otherwise 0.
    pub flip: Plane<T>,
    /// Screws at the TCP, arm axes: linear parts, and axes (written only where moments act).
    pub linear: Planes<T, 18>,
    pub axes: Planes<T, 18>,
}

/// Which flip of a posture is taken: the one with more room, after these lengths are added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::kernel::lanes) struct Preference {
    pub plain: f64,
    pub flipped: f64,
}

/// Fills [`Stances`].
pub(in crate::kernel::lanes) struct FindStances<'a, T, const MOMENTS: bool> {
    pub prepared: &'a Prepared,
    pub aims: &'a Aims<T>,
    pub postures: &'a Postures<T>,
    pub positions: &'a Positions<T>,
    pub preference: Preference,
    pub stances: &'a mut Stances<T>,
}

impl<T: Float, const MOMENTS: bool> Work<T> for FindStances<'_, T, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let (plain, flipped) = (R::of(self.preference.plain), R::of(self.preference.flipped));
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let (positions, stances) = (self.positions, self.stances);
        for i in 0..BLOCK {
            R::step();
            let (room, room_flipped) = (R::load(positions.room[0][i]), R::load(positions.room[1][i]));
            let flip = room_flipped + flipped > room + plain;
            let take = |of: [R; 2]| R::either(flip, of[1], of[0]).store();
            stances.room[i] = take([room, room_flipped]);
            stances.joint[i] = take(positions.nearest.each_ref().map(|plane| R::load(plane[i])));
            stances.flip[i] = take([zero, one]);
            let mut k = 0;
            while k < 6 {
                stances.joints[k][i] = take([
                    R::load(positions.joints[0][k][i]),
                    R::load(positions.joints[1][k][i]),
                ]);
                k += 1;
            }
        }
        let links = Links::<R>::new(&self.prepared.arm);
        for i in 0..BLOCK {
            R::step();
            let (aim, solved) = (aim::<R, false>(self.aims, i), Solved::load(self.postures, i));
            let screws = Screws::new(&links, &aim, &solved);
            let per_bent = screws.per_n2.sqrt();
            let mut k = 0;
            while k < 6 {
                let (mut linear, mut axis) = (screws.linear[k], screws.axes[k]);
                if k == 4 {
                    (linear, axis) = (linear.scaled(per_bent), axis.scaled(per_bent));
                }
                put(&mut stances.linear[3 * k..3 * k + 3], i, linear);
                if MOMENTS {
                    put(&mut stances.axes[3 * k..3 * k + 3], i, axis);
                }
                k += 1;
            }
        }
    }
}
