//! Full 6 x 6 compliance at the TCP, base basis: the 21 numbers of its upper triangle, row by row.

use super::backend::Work;
use super::block::{Aims, BLOCK, Planes, aim};
use super::envelope::lanes_of;
use super::prepared::Prepared;
use super::real::{Float, Real};
use super::screws::Screws;
use super::solve::{Links, Postures, Solved};
use super::vector::Vector;

/// Upper triangles; `TURNED` where the arm's axes are not those of the base.
pub(super) struct Compliances<'a, T, const TURNED: bool> {
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

/// Turns vectors of the arm's axes into base.
#[derive(Clone, Copy)]
pub(super) struct BaseAxes<R>([Vector<R>; 3]);

impl<R: Real> BaseAxes<R> {
    #[inline(always)]
    pub fn new(prepared: &Prepared) -> Self {
        // Rows of base_from_arm are columns of arm_from_base.
        let m = prepared.arm.arm_from_base_rotation();
        let column = |k: usize| Vector::new(R::of(m[(0, k)]), R::of(m[(1, k)]), R::of(m[(2, k)]));
        BaseAxes([column(0), column(1), column(2)])
    }

    #[inline(always)]
    pub fn of(&self, v: Vector<R>) -> Vector<R> {
        Vector::new(self.0[0].dot(v), self.0[1].dot(v), self.0[2].dot(v))
    }
}
