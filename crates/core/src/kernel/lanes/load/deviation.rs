//! Deviation of each load case in known postures, the largest of them and its contributions.
//!
//! `delta = sum_i c_i v_i (v_i . F + z_i . M)`; the share of joint i is its term along the in-plane deviation of the deciding case.

use super::worst::{CaseLanes, Worst};
use crate::kernel::lanes::geometry::{BaseAxes, Prepared};
use crate::kernel::lanes::solve::Stances;
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, lanes_of, put, vector};

/// Deviations of one case (base basis), taken into the worst so far.
pub(in crate::kernel::lanes) struct OneCase<'a, T, const MOMENTS: bool> {
    pub prepared: &'a Prepared,
    pub stances: &'a Stances<T>,
    pub case: usize,
    pub deviation: &'a mut Planes<T, 3>,
    pub worst: &'a mut Worst<T>,
}

impl<T: Float, const MOMENTS: bool> Work<T> for OneCase<'_, T, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let [force, moment] = &self.prepared.cases[self.case];
        let case = CaseLanes::<R>::new(
            self.case..self.prepared.cases.len(),
            force,
            moment,
            &self.prepared.plane,
        );
        let compliance = lanes_of::<R>(&self.prepared.compliance);
        let base = BaseAxes::<R>::new(self.prepared);
        for i in 0..BLOCK {
            R::step();
            let zero = R::of(0.0);
            let mut delta = Vector::new(zero, zero, zero);
            let mut k = 0;
            while k < 6 {
                let v = vector::<R>(&self.stances.linear[3 * k..3 * k + 3], i);
                let mut torque = v.dot(case.force);
                if MOMENTS {
                    torque = torque + vector::<R>(&self.stances.axes[3 * k..3 * k + 3], i).dot(case.moment);
                }
                delta = v.mul_add(compliance[k] * torque, delta);
                k += 1;
            }
            put(self.deviation, i, base.of(delta));
            case.take::<MOMENTS>(delta, i, self.worst);
        }
    }
}

#[inline(always)]
fn vector_2<R: Real>(planes: &Planes<R::Float, 2>, i: usize) -> [R; 2] {
    [R::load(planes[0][i]), R::load(planes[1][i])]
}

/// Share of each joint in the in-plane deviation of the worst case, and its standard uncertainty.
pub(in crate::kernel::lanes) struct Shares<'a, T, const MOMENTS: bool> {
    pub prepared: &'a Prepared,
    pub stances: &'a Stances<T>,
    pub worst: &'a Worst<T>,
    pub shares: &'a mut Planes<T, 6>,
    pub uncertainty: &'a mut Plane<T>,
}

impl<T: Float, const MOMENTS: bool> Work<T> for Shares<'_, T, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let compliance = lanes_of::<R>(&self.prepared.compliance);
        let uncertainty = lanes_of::<R>(&self.prepared.uncertainty);
        let [first, second, _] = &self.prepared.plane;
        let (first, second) = (Vector::<R>::of(first), Vector::<R>::of(second));
        let model_error = R::of(self.prepared.model_error);
        let scatter = R::of(self.prepared.repeatability * self.prepared.repeatability);
        for i in 0..BLOCK {
            R::step();
            let (zero, one) = (R::of(0.0), R::of(1.0));
            let in_plane = R::load(self.worst.in_plane[i]);
            let moves = in_plane > zero;
            let per_length = R::either(moves, one, zero) / R::either(moves, in_plane, one);
            let [a, b] = vector_2::<R>(&self.worst.components, i);
            let along = second.mul_add(b * per_length, first.scaled(a * per_length));
            let force = vector::<R>(&self.worst.wrench[0..3], i);
            let missed = model_error * in_plane;
            let mut variance = missed.mul_add(missed, scatter);
            let mut k = 0;
            while k < 6 {
                let v = vector::<R>(&self.stances.linear[3 * k..3 * k + 3], i);
                let mut torque = v.dot(force);
                if MOMENTS {
                    let moment = vector::<R>(&self.worst.wrench[3..6], i);
                    torque = torque + vector::<R>(&self.stances.axes[3 * k..3 * k + 3], i).dot(moment);
                }
                let sensitivity = torque * v.dot(along);
                self.shares[k][i] = (sensitivity * compliance[k]).store();
                let contribution = sensitivity * uncertainty[k];
                variance = contribution.mul_add(contribution, variance);
                k += 1;
            }
            self.uncertainty[i] = variance.sqrt().store();
        }
    }
}
