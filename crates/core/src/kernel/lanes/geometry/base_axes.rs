//! From the arm's axes into base.

use super::prepared::Prepared;
use crate::numbers::{Real, Vector};

/// Turns vectors of the arm's axes into base.
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) struct BaseAxes<R>([Vector<R>; 3]);

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
