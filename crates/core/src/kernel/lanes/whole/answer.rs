//! The largest in-plane deviation of the load cases, the share of each contributor in it, and its uncertainty.
//!
//! With `a` the direction of the in-plane deviation of the worst case, `x_k` the deflection and `s_k` the screw of part k:
//!
//! ```text
//! share of a contributor = sum over its parts of a . s_k x_k  (gravity relative to tool setting)   + a . geometry, a . thermal
//! u^2 = sum_kl S_kl (a . d delta / d c_k) (a . d delta / d c_l) + (m a . elastic and gravity)^2 + u_thermal^2
//! ```

use nalgebra::Vector3;

use super::model::ModelConstants;
use super::parts::PartPlanes;
use super::sum::StillPlanes;
use crate::kernel::lanes::load::{CaseLanes, Worst};
use crate::kernel::lanes::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, put, vector};

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
        let case = CaseLanes::<R>::new(self.case, &self.force, &self.moment, self.plane);
        for i in 0..BLOCK {
            R::step();
            case.take::<true>(vector::<R>(self.deviation, i), i, self.worst);
        }
    }
}

/// Fills the shares (m, one plane per contributor) and the variance (m^2) of the in-plane deviation of the worst case.
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
    /// Displacement along it per unit of each compliance.
    pub by_unit: &'a mut [Plane<T>],
    pub shares: &'a mut [Plane<T>],
    pub variance: &'a mut Plane<T>,
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
            by_unit,
            shares,
            variance,
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
            let c = R::of(constants.compliance);
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
                by_unit[k][i] = (moved - there_per_unit.dot(along)).store();
            }
            k += 1;
        }
        add_compliances::<R>(model, by_unit, variance);
        let model_error = R::of(model.model_error);
        let scatter = R::of(model.repeatability);
        for i in 0..BLOCK {
            R::step();
            let missed = R::load(by_load[i]) * model_error;
            let of_parts = scatter.mul_add(scatter, R::load(variance[i]));
            variance[i] = missed.mul_add(missed, of_parts).store();
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
                variance[i] = by_u.mul_add(by_u, R::load(variance[i])).store();
            }
        }
    }
}

/// The variance by the compliances: those of the covariance, and the others as independent.
#[inline(always)]
fn add_compliances<R: Real>(
    model: &ModelConstants,
    by_unit: &[Plane<R::Float>],
    variance: &mut Plane<R::Float>,
) {
    let zero = R::of(0.0);
    for i in 0..BLOCK {
        R::step();
        variance[i] = zero.store();
    }
    let mut k = 0;
    while k < by_unit.len() {
        let mut weighted = [R::Float::default(); BLOCK];
        if let Some(row) = model.covariance.get(k) {
            let mut other = 0;
            while other < row.len() {
                let entry = R::of(row[other]);
                for i in 0..BLOCK {
                    R::step();
                    let so_far = R::load(weighted[i]);
                    weighted[i] = R::load(by_unit[other][i]).mul_add(entry, so_far).store();
                }
                other += 1;
            }
        } else {
            let u = R::of(model.parts[k].uncertainty);
            for i in 0..BLOCK {
                R::step();
                weighted[i] = (R::load(by_unit[k][i]) * u * u).store();
            }
        }
        for i in 0..BLOCK {
            R::step();
            let so_far = R::load(variance[i]);
            variance[i] = R::load(by_unit[k][i])
                .mul_add(R::load(weighted[i]), so_far)
                .store();
        }
        k += 1;
    }
    // Rounding of a covariance.
    for i in 0..BLOCK {
        R::step();
        variance[i] = R::load(variance[i]).max(zero).store();
    }
}

/// Turns a variance into a standard uncertainty.
pub(in crate::kernel::lanes) struct TakeRoot<'a, T> {
    pub of: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for TakeRoot<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        for i in 0..BLOCK {
            R::step();
            self.of[i] = R::load(self.of[i]).sqrt().store();
        }
    }
}
