//! Screws of the six joints at the TCP, arm axes; joint 5's as a multiple, so that no root is needed.
//!
//! `C = sum_i c_i s_i s_i^T` needs axis 5 only as `z5 z5^T = n n^T / |n|^2`: one division.

use super::closed_form::{Links, Solved};
use crate::kernel::lanes::geometry::Aim;
use crate::numbers::{Real, Vector};

/// Linear parts `v_i = z_i x (p - o_i)` and axes `z_i`; number 5 times the sine of the wrist's bend.
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) struct Screws<R> {
    pub linear: [Vector<R>; 6],
    pub axes: [Vector<R>; 6],
    /// What joint 5's products must be multiplied with.
    pub per_n2: R,
}

impl<R: Real> Screws<R> {
    #[inline(always)]
    pub fn new(links: &Links<R>, aim: &Aim<R>, solved: &Solved<R>) -> Self {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let (c1, s1) = (solved.c1, solved.s1);
        let [elbow_out, elbow_up] = links.elbow(solved);
        let t = aim.tcp;
        let outwards = c1.mul_add(t.x, s1 * t.y);
        // y x (lever in the arm's plane): what is up moves outwards, what is outwards moves down.
        let about_y = |out: R, up: R| Vector::new(c1 * up, s1 * up, out);
        let across = Vector::new(-s1, c1, zero);
        Screws {
            linear: [
                Vector::new(-t.y, t.x, zero),
                about_y(links.a1() - outwards, t.z),
                about_y(elbow_out - outwards, t.z - elbow_up),
                solved.z4.cross(aim.lever),
                solved.n.cross(aim.lever),
                aim.out.cross(aim.lever),
            ],
            axes: [
                Vector::new(zero, zero, one),
                across,
                across,
                solved.z4,
                solved.n,
                aim.out,
            ],
            per_n2: solved.per_n2,
        }
    }
}
