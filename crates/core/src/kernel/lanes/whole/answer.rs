//! The largest in-plane deviation of the load cases, the share of each contributor in it, and its uncertainty.
//!
//! With `a` the direction of the in-plane deviation of the worst case, `x_k` the deflection and `s_k` the screw of part k:
//!
//! ```text
//! share of a contributor = sum over its parts of a . s_k x_k  (gravity relative to tool setting)   + a . geometry, a . thermal
//! u^2 = sum_k (u_k a . d delta / d c_k)^2 + (m a . elastic and gravity)^2 + u_thermal^2
//! ```

use nalgebra::Vector3;

use super::model::ModelConstants;
use super::parts::PartPlanes;
use super::sum::StillPlanes;
use crate::kernel::lanes::load::Worst;
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, put, vector};

/// Takes the deviation of one case (base) into the worst so far.
pub(in crate::kernel::lanes) struct TakeCase<'a, T> {
    pub case: usize,
    pub force: Vector3<f64>,
    pub moment: Vector3<f64>,
    /// Two directions across the normal, then the normal, base.
    pub plane: &'a [Vector3<f64>; 3],
    pub deviation: &'a Planes<T, 3>,
    pub worst: &'a mut Worst<T>,
}

impl<T: Float> Work<T> for TakeCase<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let (force, moment) = (Vector::<R>::of(&self.force), Vector::<R>::of(&self.moment));
        let index = R::of(self.case as f64);
        let [first, second, normal] = self.plane;
        let (first, second, normal) = (Vector::of(first), Vector::of(second), Vector::of(normal));
        let zero = R::of(0.0);
        // Nothing is smaller in size than the deviation of the first case.
        let start = R::of(if self.case == 0 { -1.0 } else { 0.0 });
        let begin = self.case == 0;
        let worst = self.worst;
        for i in 0..BLOCK {
            R::step();
            let delta = vector::<R>(self.deviation, i);
            let (a, b, n) = (delta.dot(first), delta.dot(second), delta.dot(normal));
            let in_plane = a.mul_add(a, b * b).sqrt();
            let full = n.mul_add(n, in_plane * in_plane).sqrt();
            let most = R::either(begin, start, R::load(worst.in_plane[i]));
            let more = in_plane > most;
            worst.in_plane[i] = R::either(more, in_plane, most).store();
            worst.case[i] = R::either(more, index, R::load(worst.case[i])).store();
            let normal_so_far = R::either(begin, zero, R::load(worst.normal[i]));
            worst.normal[i] = R::either(n.abs() > normal_so_far.abs(), n, normal_so_far).store();
            worst.full[i] = full.max(R::either(begin, zero, R::load(worst.full[i]))).store();
            worst.components[0][i] = R::either(more, a, R::load(worst.components[0][i])).store();
            worst.components[1][i] = R::either(more, b, R::load(worst.components[1][i])).store();
            let so_far = vector::<R>(&worst.wrench[0..3], i);
            put(&mut worst.wrench[0..3], i, either(more, force, so_far));
            let so_far = vector::<R>(&worst.wrench[3..6], i);
            put(&mut worst.wrench[3..6], i, either(more, moment, so_far));
        }
    }
}

#[inline(always)]
fn either<R: Real>(condition: bool, yes: Vector<R>, no: Vector<R>) -> Vector<R> {
    Vector::new(
        R::either(condition, yes.x, no.x),
        R::either(condition, yes.y, no.y),
        R::either(condition, yes.z, no.z),
    )
}

/// Fills the shares (m, one plane per contributor) and the standard uncertainty of the in-plane deviation of the worst
/// case (m).
pub(in crate::kernel::lanes) struct FindShares<'a, T> {
    pub model: &'a ModelConstants,
    pub parts: &'a [PartPlanes<T>],
    pub still: &'a StillPlanes<T>,
    pub plane: &'a [Vector3<f64>; 3],
    pub worst: &'a Worst<T>,
    /// Memory: the direction of the in-plane deviation, base.
    pub along: &'a mut Planes<T, 3>,
    /// Memory: the elastic and gravity part along it.
    pub by_load: &'a mut Plane<T>,
    pub shares: &'a mut [Plane<T>],
    pub uncertainty: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for FindShares<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let FindShares {
            model,
            parts,
            still,
            plane,
            worst,
            along,
            by_load,
            shares,
            uncertainty,
        } = self;
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let (first, second) = (Vector::<R>::of(&plane[0]), Vector::<R>::of(&plane[1]));
        for i in 0..BLOCK {
            R::step();
            let in_plane = R::load(worst.in_plane[i]);
            let moves = in_plane > zero;
            let per_length = R::either(moves, one, zero) / R::either(moves, in_plane, one);
            let (a, b) = (R::load(worst.components[0][i]), R::load(worst.components[1][i]));
            put(
                along,
                i,
                second.mul_add(b * per_length, first.scaled(a * per_length)),
            );
            by_load[i] = zero.store();
            uncertainty[i] = zero.store();
        }
        let mut contributor = 0;
        while contributor < shares.len() {
            for i in 0..BLOCK {
                R::step();
                shares[contributor][i] = zero.store();
            }
            contributor += 1;
        }
        let mut k = 0;
        while k < parts.len() {
            let (constants, part) = (&model.parts[k], &parts[k]);
            let share = &mut shares[constants.contributor];
            let (c, u) = (R::of(constants.compliance), R::of(constants.uncertainty));
            let there = Vector::<R>::of(&constants.reference[0]);
            let there_per_unit = Vector::<R>::of(&constants.reference[1]);
            for i in 0..BLOCK {
                R::step();
                let linear = vector::<R>(&part.linear, i);
                let force = vector::<R>(&worst.wrench[0..3], i);
                let moment = vector::<R>(&worst.wrench[3..6], i);
                let torque = linear.dot(force) + vector::<R>(&part.angular, i).dot(moment);
                let torque = torque + R::load(part.weight[i]);
                let along = vector::<R>(along, i);
                let moved = linear.dot(along) * torque;
                let of_part = moved.mul_add(c, -there.dot(along));
                share[i] = (R::load(share[i]) + of_part).store();
                by_load[i] = (R::load(by_load[i]) + of_part).store();
                let by_unit = (moved - there_per_unit.dot(along)) * u;
                uncertainty[i] = by_unit.mul_add(by_unit, R::load(uncertainty[i])).store();
            }
            k += 1;
        }
        let model_error = R::of(model.model_error);
        let scatter = R::of(model.repeatability);
        for i in 0..BLOCK {
            R::step();
            let missed = R::load(by_load[i]) * model_error;
            let variance = scatter.mul_add(scatter, R::load(uncertainty[i]));
            uncertainty[i] = missed.mul_add(missed, variance).store();
        }
        if let Some(geometry) = model.geometry {
            for i in 0..BLOCK {
                R::step();
                let part = vector::<R>(&still.geometry, i).dot(vector::<R>(along, i));
                shares[geometry][i] = part.store();
            }
        }
        if let (Some(thermal), Some([growth, u])) = (model.thermal, model.growth) {
            let (growth, u) = (R::of(growth), R::of(u));
            for i in 0..BLOCK {
                R::step();
                let length = vector::<R>(&still.lengths, i).dot(vector::<R>(along, i));
                shares[thermal][i] = (length * growth).store();
                let by_u = length * u;
                uncertainty[i] = by_u.mul_add(by_u, R::load(uncertainty[i])).store();
            }
        }
        for i in 0..BLOCK {
            R::step();
            uncertainty[i] = R::load(uncertainty[i]).sqrt().store();
        }
    }
}
