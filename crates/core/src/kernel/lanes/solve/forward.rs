//! Tool pose and screws from joint positions.

use super::closed_form::{Links, Solved};
use super::screws::Screws;
use crate::kernel::lanes::geometry::{Aim, BaseAxes, Prepared};
use crate::numbers::{BLOCK, Float, Planes, Real, Vector, Work, lanes_of, put, sin_cos};

/// Planes of a pose: rotation row by row, then position.
pub(in crate::kernel::lanes) const POSE: usize = 12;
/// Planes of the six screws: linear part, then axis, of each.
pub(in crate::kernel::lanes) const SCREWS: usize = 36;

/// Poses, then screws at the TCP, base basis, per unit of chain position.
pub(in crate::kernel::lanes) struct Forward<'a, T> {
    pub prepared: &'a Prepared,
    /// Joint positions in; the arm's angles out.
    pub joints: &'a mut Planes<T, 6>,
    pub out: &'a mut Planes<T, { POSE + SCREWS }>,
}

impl<T: Float> Work<T> for Forward<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let arm = &self.prepared.arm;
        let links = Links::<R>::new(arm);
        angles::<R>(self.prepared, self.joints);
        let base = BaseAxes::<R>::new(self.prepared);
        let sense = lanes_of::<R>(&arm.sense);
        let origin = Vector::of(&arm.arm_from_base.translation.vector);
        let (t6, t5) = (arm.tool_from_axis_6, arm.tool_from_axis_5);
        // Rows: axis 6, axis 5 and their cross product; columns: the tool's axes.
        let wrist_from_tool: [Vector<R>; 3] = [Vector::of(&t6), Vector::of(&t5), Vector::of(&t6.cross(&t5))];
        let lever = Vector::of(&arm.lever);
        for i in 0..BLOCK {
            R::step();
            let phi = |k: usize| R::load(self.joints[k][i]);
            let (phi1, psi, eps) = (phi(0), phi(1), phi(2));
            let (phi4, bend, phi6) = (phi(3), phi(4), phi(5));
            let (s1, c1) = sin_cos(phi1);
            let (sp, cp) = sin_cos(psi);
            let (sc, cc) = sin_cos(psi + eps);
            let (s4, c4) = sin_cos(phi4);
            let (s5, c5) = sin_cos(bend);
            let (s6, c6) = sin_cos(phi6);

            let mut solved = Solved::turned(&links, [c1, s1], [cp, sp], [cc, sc]);
            let [a5, a3] = links.wrist_axes(&solved);
            let z5 = a3.mul_add(s4, a5.scaled(c4));
            solved.n = z5;
            let out = z5.cross(solved.z4).mul_add(s5, solved.z4.scaled(c5));
            let second = out.cross(z5).mul_add(s6, z5.scaled(c6));
            let wrist_axes = [out, second, out.cross(second)];
            let of_tool = |x: R, y: R, z: R| {
                wrist_axes[2].mul_add(z, wrist_axes[1].mul_add(y, wrist_axes[0].scaled(x)))
            };
            let [row6, row5, row65] = wrist_from_tool;
            let lever = of_tool(row6.dot(lever), row5.dot(lever), row65.dot(lever));
            let aim = Aim {
                tcp: links.wrist_centre(&solved) + lever,
                lever,
                out,
                second,
            };

            let x = base.of(of_tool(row6.x, row5.x, row65.x));
            let y = base.of(of_tool(row6.y, row5.y, row65.y));
            let z = base.of(of_tool(row6.z, row5.z, row65.z));
            put(&mut self.out[0..3], i, Vector::new(x.x, y.x, z.x));
            put(&mut self.out[3..6], i, Vector::new(x.y, y.y, z.y));
            put(&mut self.out[6..9], i, Vector::new(x.z, y.z, z.z));
            put(&mut self.out[9..12], i, base.of(aim.tcp - origin));

            let screws = Screws::new(&links, &aim, &solved);
            let mut k = 0;
            while k < 6 {
                let at = POSE + 6 * k;
                let (v, z) = (base.of(screws.linear[k]), base.of(screws.axes[k]));
                put(&mut self.out[at..at + 3], i, v.scaled(sense[k]));
                put(&mut self.out[at + 3..at + 6], i, z.scaled(sense[k]));
                k += 1;
            }
        }
    }
}

/// Joint positions to the arm's angles, in place.
#[inline(always)]
fn angles<R: Real>(prepared: &Prepared, joints: &mut Planes<R::Float, 6>) {
    // The last joint first: those before it are still positions.
    for joint in (0..6).rev() {
        let (before, from) = joints.split_at_mut(joint);
        for (other, factor) in before.iter().zip(&prepared.arm.coupling[joint]) {
            if *factor != 0.0 {
                let factor = R::of(*factor);
                for i in 0..BLOCK {
                    R::step();
                    from[0][i] = factor.mul_add(R::load(other[i]), R::load(from[0][i])).store();
                }
            }
        }
        // The gain is 1 or -1: its own inverse.
        let row = prepared.arm.joints[joint];
        let (gain, start) = (R::of(row.gain), R::of(-row.gain * row.start));
        for i in 0..BLOCK {
            R::step();
            from[0][i] = gain.mul_add(R::load(from[0][i]), start).store();
        }
    }
}
