//! Joint positions of all eight branches, with the limits each leaves.

use super::backend::Work;
use super::block::{Aims, BLOCK, Plane, Planes, aim};
use super::joints::{Counting, angles, flipped};
use super::prepared::Prepared;
use super::real::{Float, Real};
use super::solve::{Links, Postures, Solved, flag, flagged};

/// Positions of the two postures, not flipped and flipped, of a block: six planes and one of flags each.
pub(super) struct Pair<'a, T, const COUPLED: bool> {
    pub prepared: &'a Prepared,
    pub aims: &'a Aims<T>,
    pub postures: &'a Postures<T>,
    pub joints: &'a mut Planes<T, 12>,
    pub flags: &'a mut [Plane<T>; 2],
}

impl<T: Float, const COUPLED: bool> Work<T> for Pair<'_, T, COUPLED> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let links = Links::<R>::new(&self.prepared.arm);
        let counting = Counting::<R>::new(&self.prepared.arm);
        let at_limit = R::of(-<T as Float>::AT_LIMIT);
        for i in 0..BLOCK {
            R::step();
            let aim = aim::<R, false>(self.aims, i);
            let solved = Solved::load(self.postures, i);
            let flags = R::load(self.postures.flags[i]);
            let phi = angles(&links, &aim, &solved);
            let both = [phi, flipped(phi)];
            let mut k = 0;
            while k < 2 {
                let q = counting.positions::<COUPLED>(both[k]);
                let (room, _) = counting.room(&q);
                let mut j = 0;
                while j < 6 {
                    self.joints[6 * k + j][i] = q[j].store();
                    j += 1;
                }
                self.flags[k][i] = flagged(flags, room < at_limit, flag::OUTSIDE_LIMITS).store();
                k += 1;
            }
        }
    }
}
