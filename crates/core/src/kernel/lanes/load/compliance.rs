//! Full 6 x 6 compliance at the TCP, base basis: the 21 numbers of its upper triangle, row by row.

use crate::kernel::lanes::geometry::{Aims, BaseAxes, Prepared, aim};
use crate::kernel::lanes::solve::{Links, Postures, Screws, Solved};
use crate::numbers::{BLOCK, Float, Planes, Real, Work, lanes_of};

/// Upper triangles; `TURNED` where the arm's axes are not those of the base.
pub(in crate::kernel::lanes) struct Compliances<'a, T, const TURNED: bool> {
    pub prepared: &'a Prepared,
    pub aims: &'a Aims<T>,
    pub postures: &'a Postures<T>,
    pub out: &'a mut Planes<T, 21>,
}

impl<T: Float, const TURNED: bool> Work<T> for Compliances<'_, T, TURNED> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let links = Links::<R>::new(&self.prepared.arm);
        let compliance = lanes_of::<R>(&self.prepared.compliance);
        let base = BaseAxes::<R>::new(self.prepared);
        for i in 0..BLOCK {
            R::step();
            let aim = aim::<R, false>(self.aims, i);
            let solved = Solved::load(self.postures, i);
            let screws = Screws::new(&links, &aim, &solved);
            let mut sum = [R::of(0.0); 21];
            let mut k = 0;
            while k < 6 {
                let c = if k == 4 {
                    compliance[4] * screws.per_n2
                } else {
                    compliance[k]
                };
                let (mut v, mut z) = (screws.linear[k], screws.axes[k]);
                if TURNED {
                    (v, z) = (base.of(v), base.of(z));
                }
                let s = [v.x, v.y, v.z, z.x, z.y, z.z];
                let mut at = 0;
                let mut row = 0;
                while row < 6 {
                    let scaled = s[row] * c;
                    let mut column = row;
                    while column < 6 {
                        sum[at] = scaled.mul_add(s[column], sum[at]);
                        at += 1;
                        column += 1;
                    }
                    row += 1;
                }
                k += 1;
            }
            let mut at = 0;
            while at < 21 {
                self.out[at][i] = sum[at].store();
                at += 1;
            }
        }
    }
}
