//! Joint positions of all eight branches, with the limits each leaves.

use super::backend::Work;
use super::block::{Aims, BLOCK, Plane, Planes, aim};
use super::joints::{Counting, angles, flipped};
use super::prepared::Prepared;
use super::real::{Float, Real};
use super::solve::{Links, Signs, flag};

/// Positions of the two postures, not flipped and flipped, with these signs: six planes and one of flags each.
pub(super) struct Pair<'a, T, const STILL: bool, const COUPLED: bool> {
    pub prepared: &'a Prepared,
    pub aims: &'a Aims<T>,
    pub signs: [f64; 2],
    pub joints: &'a mut Planes<T, 12>,
    pub flags: &'a mut [Plane<T>; 2],
}

impl<T: Float, const STILL: bool, const COUPLED: bool> Work<T> for Pair<'_, T, STILL, COUPLED> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let links = Links::<R>::new(&self.prepared.arm);
        let counting = Counting::<R>::new(&self.prepared.arm);
        let signs = Signs {
            shoulder: R::of(self.signs[0]),
            elbow: R::of(self.signs[1]),
        };
        let at_limit = R::of(-<T as Float>::AT_LIMIT);
        for i in 0..BLOCK {
            R::step();
            let aim = aim::<R, STILL>(self.aims, i);
            let solved = links.solve(&aim, signs);
            let flags = links.flags(&solved);
            let phi = angles(&links, &aim, &solved);
            let both = [phi, flipped(phi)];
            let mut k = 0;
            while k < 2 {
                let q = counting.positions::<COUPLED>(both[k]);
                let (room, _) = counting.room(&q);
                let outside = R::either(
                    room < at_limit,
                    R::of(f64::from(flag::OUTSIDE_LIMITS)),
                    R::of(0.0),
                );
                let mut j = 0;
                while j < 6 {
                    self.joints[6 * k + j][i] = q[j].store();
                    j += 1;
                }
                self.flags[k][i] = (flags + outside).store();
                k += 1;
            }
        }
    }
}
