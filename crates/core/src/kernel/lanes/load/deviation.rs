//! Deviation of each load case in known postures, the largest of them and its contributions.
//!
//! `delta = sum_i c_i v_i (v_i . F + z_i . M)`; the share of joint i is its term along the in-plane deviation of the deciding case.

use nalgebra::Vector3;

use crate::kernel::lanes::geometry::{BaseAxes, Prepared};
use crate::kernel::lanes::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, lanes_of, put, vector};
use crate::kernel::lanes::solve::Stances;

/// The largest deviations of the cases so far, and the case that decides; `in_plane` and `full` are squares until the last
/// case is taken.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct Worst<T> {
    pub in_plane: Plane<T>,
    /// Along the normal, of the case where it is largest in size.
    pub normal: Plane<T>,
    pub full: Plane<T>,
    pub case: Plane<T>,
    /// In-plane components of the deciding case, along the plane's two directions.
    pub components: Planes<T, 2>,
    /// Its force and moment, arm axes.
    pub wrench: Planes<T, 6>,
}

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
        let [force, moment]: [Vector3<f64>; 2] = self.prepared.cases[self.case];
        let (force, moment) = (Vector::<R>::of(&force), Vector::<R>::of(&moment));
        let index = R::of(self.case as f64);
        let compliance = lanes_of::<R>(&self.prepared.compliance);
        let base = BaseAxes::<R>::new(self.prepared);
        let [first, second, normal] = &self.prepared.plane;
        let (first, second, normal) = (Vector::of(first), Vector::of(second), Vector::of(normal));
        // Nothing is smaller in size than the first case's.
        let start = R::of(if self.case == 0 { -1.0 } else { 0.0 });
        let last = self.case + 1 == self.prepared.cases.len();
        let worst = self.worst;
        for i in 0..BLOCK {
            R::step();
            let zero = R::of(0.0);
            let mut delta = Vector::new(zero, zero, zero);
            let mut k = 0;
            while k < 6 {
                let v = vector::<R>(&self.stances.linear[3 * k..3 * k + 3], i);
                let mut torque = v.dot(force);
                if MOMENTS {
                    torque = torque + vector::<R>(&self.stances.axes[3 * k..3 * k + 3], i).dot(moment);
                }
                delta = v.mul_add(compliance[k] * torque, delta);
                k += 1;
            }
            put(self.deviation, i, base.of(delta));

            let (a, b, n) = (delta.dot(first), delta.dot(second), delta.dot(normal));
            let in_plane = a.mul_add(a, b * b);
            let full = n.mul_add(n, in_plane);
            let begin = start < zero;
            let most = R::either(begin, start, R::load(worst.in_plane[i]));
            let more = in_plane > most;
            let most = R::either(more, in_plane, most);
            worst.in_plane[i] = if last { most.sqrt() } else { most }.store();
            worst.case[i] = R::either(more, index, R::load(worst.case[i])).store();
            let normal_so_far = R::either(begin, zero, R::load(worst.normal[i]));
            worst.normal[i] = R::either(n.abs() > normal_so_far.abs(), n, normal_so_far).store();
            let full = full.max(R::either(begin, zero, R::load(worst.full[i])));
            worst.full[i] = if last { full.sqrt() } else { full }.store();
            let components = vector_2::<R>(&worst.components, i);
            worst.components[0][i] = R::either(more, a, components[0]).store();
            worst.components[1][i] = R::either(more, b, components[1]).store();
            let so_far = vector::<R>(&worst.wrench[0..3], i);
            put(&mut worst.wrench[0..3], i, choose(more, force, so_far));
            if MOMENTS {
                let so_far = vector::<R>(&worst.wrench[3..6], i);
                put(&mut worst.wrench[3..6], i, choose(more, moment, so_far));
            }
        }
    }
}

#[inline(always)]
fn vector_2<R: Real>(planes: &Planes<R::Float, 2>, i: usize) -> [R; 2] {
    [R::load(planes[0][i]), R::load(planes[1][i])]
}

#[inline(always)]
fn choose<R: Real>(condition: bool, yes: Vector<R>, no: Vector<R>) -> Vector<R> {
    Vector::new(
        R::either(condition, yes.x, no.x),
        R::either(condition, yes.y, no.y),
        R::either(condition, yes.z, no.z),
    )
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
