//! The gravity compensator of a joint (`robot/compensator.rs`): its torque adds to gravity's, and its slope makes the
//! joint softer or stiffer from posture to posture.
//!
//! ```text
//! tau_g += M(theta)        c(theta) = c / q        q = 1 - c dM/dtheta        d c(theta) / dc = 1 / q^2
//! ```
//!
//! In one posture the displacement is still proportional to the load: the joint is added to the response of the tool.
//! Where `q` is not positive the arm is unstable, and lanes do not decide.

use super::chain::FramePlanes;
use super::model::{CompensatorConstants, ModelConstants};
use super::parts::{PartPlanes, ResponsePlanes, Sum, angular};
use crate::kernel::lanes::load::Worst;
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, sin_cos, vector};
use crate::robot::Compensator;

/// A joint with a compensator at each point.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct CompensatorPlanes<T> {
    /// N m.
    torque: Plane<T>,
    /// rad/(N m), and the change of that with the compliance of the drive.
    pub compliance: Plane<T>,
    growth: Plane<T>,
    /// 1 where the arm has no stable equilibrium, otherwise 0.
    pub unstable: Plane<T>,
}

impl<T: Float> CompensatorPlanes<T> {
    /// A joint of which nothing is known yet.
    pub fn unknown() -> CompensatorPlanes<T> {
        CompensatorPlanes {
            torque: [T::default(); BLOCK],
            compliance: [T::default(); BLOCK],
            growth: [T::default(); BLOCK],
            unstable: [T::default(); BLOCK],
        }
    }
}

/// Fills torque and compliance from the joint positions, rad (m).
pub(in crate::kernel::lanes) struct FindCompensation<'a, T> {
    pub model: &'a ModelConstants,
    pub constants: &'a CompensatorConstants,
    pub joints: &'a [Plane<T>],
    pub out: &'a mut CompensatorPlanes<T>,
}

impl<T: Float> Work<T> for FindCompensation<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let (constants, out) = (self.constants, self.out);
        let Compensator {
            joint,
            fixed_radius,
            arm_radius,
            angle,
            free_length,
            stiffness,
        } = constants.compensator;
        let theta = self.model.chain.theta::<R>(self.joints, joint);
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let squares = R::of(fixed_radius * fixed_radius + arm_radius * arm_radius);
        let al = R::of(fixed_radius * arm_radius);
        let twice = R::of(2.0 * fixed_radius * arm_radius);
        let (angle, free, stiffness) = (R::of(angle), R::of(free_length), R::of(stiffness));
        let weighs = R::of(if constants.weighs { 1.0 } else { 0.0 });
        let c = R::of(constants.compliance);
        for i in 0..BLOCK {
            R::step();
            let (sin, cos) = sin_cos(angle + R::load(theta[i]));
            let length = twice.mul_add(cos, squares).sqrt();
            let relaxed = free / length;
            let stretched = one - relaxed;
            let lever = stiffness * al;
            out.torque[i] = (lever * stretched * sin * weighs).store();
            let bent = relaxed * al * sin * sin / (length * length);
            let slope = lever * cos.mul_add(stretched, -bent);
            let left = one - c * slope;
            let stable = left > zero;
            let per = one / R::either(stable, left, one);
            out.compliance[i] = (c * per).store();
            out.growth[i] = (per * per).store();
            out.unstable[i] = R::either(stable, zero, one).store();
        }
    }
}

/// Adds the joint to the response of the tool, and the torque of the compensator to that of gravity; the response to
/// moments only if `MOMENTS`.
pub(in crate::kernel::lanes) struct AddCompensated<'a, T, const MOMENTS: bool> {
    pub model: &'a ModelConstants,
    pub constants: &'a CompensatorConstants,
    pub compensated: &'a CompensatorPlanes<T>,
    pub frames: &'a [FramePlanes<T>],
    pub parts: &'a mut [PartPlanes<T>],
    pub response: &'a mut ResponsePlanes<T>,
}

impl<T: Float, const MOMENTS: bool> Work<T> for AddCompensated<'_, T, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let (k, compensated) = (self.constants.part, self.compensated);
        let weight = &mut self.parts[k].weight;
        for i in 0..BLOCK {
            R::step();
            weight[i] = (R::load(weight[i]) + R::load(compensated.torque[i])).store();
        }
        let axis = angular(self.model, self.frames, self.parts, k);
        let part = &self.parts[k];
        for i in 0..BLOCK {
            R::step();
            let (linear, axis) = (vector::<R>(&part.linear, i), vector::<R>(axis, i));
            let (c, weight) = (R::load(compensated.compliance[i]), R::load(part.weight[i]));
            let mut sum = Sum::load::<MOMENTS>(self.response, i);
            sum.add::<MOMENTS>(linear, axis, c, weight);
            sum.store::<MOMENTS>(self.response, i);
        }
    }
}

/// A joint with a compensator in one posture at each point, under the wrench of the worst case.
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) struct Compensated<'a, T> {
    pub model: &'a ModelConstants,
    pub constants: &'a CompensatorConstants,
    pub compensated: &'a CompensatorPlanes<T>,
    pub frames: &'a [FramePlanes<T>],
    pub parts: &'a [PartPlanes<T>],
    pub worst: &'a Worst<T>,
}

impl<T: Float> Compensated<'_, T> {
    /// Adds its part along a direction to the share of its contributor and to `sums`: deviation by load and gravity,
    /// and variance of independent compliances. Fills the displacement per unit of its compliance.
    #[inline(always)]
    pub fn share<R: Real<Float = T>, const MOMENTS: bool>(
        &self,
        along: &Planes<T, 3>,
        by_unit: &mut [Plane<T>],
        shares: &mut [Plane<T>],
        sums: &mut Planes<T, 2>,
    ) {
        let k = self.constants.part;
        let (constants, part) = (&self.model.parts[k], &self.parts[k]);
        let axis = angular(self.model, self.frames, self.parts, k);
        let (by_unit, share) = (&mut by_unit[k], &mut shares[constants.contributor]);
        let there = Vector::<R>::of(&self.constants.reference);
        let there_by_unit = Vector::<R>::of(&constants.reference);
        let u = R::of(self.constants.uncertainty);
        for i in 0..BLOCK {
            R::step();
            let (along, linear) = (vector::<R>(along, i), vector::<R>(&part.linear, i));
            let force = vector::<R>(&self.worst.wrench[0..3], i);
            let mut torque = linear.dot(force) + R::load(part.weight[i]);
            if MOMENTS {
                torque = torque + vector::<R>(axis, i).dot(vector::<R>(&self.worst.wrench[3..6], i));
            }
            let work = linear.dot(along) * torque;
            let own = work.mul_add(R::load(self.compensated.compliance[i]), -there.dot(along));
            let per_unit = work.mul_add(R::load(self.compensated.growth[i]), -there_by_unit.dot(along));
            by_unit[i] = per_unit.store();
            share[i] = (R::load(share[i]) + own).store();
            sums[0][i] = (R::load(sums[0][i]) + own).store();
            let by_u = per_unit * u;
            sums[1][i] = by_u.mul_add(by_u, R::load(sums[1][i])).store();
        }
    }
}
