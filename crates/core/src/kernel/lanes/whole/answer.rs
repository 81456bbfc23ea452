//! The largest in-plane deviation of the load cases, the share of each contributor in it, and its uncertainty.
//!
//! With `a` the direction of the in-plane deviation of the worst case, `x_k` the deflection and `s_k` the screw of part k:
//!
//! ```text
//! share of a contributor = sum over its parts of a . s_k x_k  (gravity relative to tool setting)   + a . geometry, a . thermal
//! u^2 = sum_kl S_kl (a . d delta / d c_k) (a . d delta / d c_l) + (m a . elastic and gravity)^2 + u_thermal^2
//! ```

use std::ops::Range;

use nalgebra::Vector3;

use super::chain::FramePlanes;
use super::compensator::Compensated;
use super::curves::Curved;
use super::model::ModelConstants;
use super::parts::{PartPlanes, angular};
use super::sum::StillPlanes;
use crate::kernel::lanes::load::{CaseLanes, Worst};
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, put, vector};

/// Takes the deviation of one case (base) into the worst so far.
pub(in crate::kernel::lanes) struct TakeCase<'a, T> {
    /// Its index and those of the cases that follow.
    pub cases: Range<usize>,
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
        let case = CaseLanes::<R>::new(self.cases, &self.force, &self.moment, self.plane);
        for i in 0..BLOCK {
            R::step();
            case.take::<true>(vector::<R>(self.deviation, i), i, self.worst);
        }
    }
}

/// Fills the shares (m, one plane per contributor) and the variance (m^2) of the in-plane deviation of the worst case;
/// moments act only if `MOMENTS`.
pub(in crate::kernel::lanes) struct FindShares<'a, T, const MOMENTS: bool> {
    pub model: &'a ModelConstants,
    pub frames: &'a [FramePlanes<T>],
    pub parts: &'a [PartPlanes<T>],
    pub curved: Curved<'a, T>,
    pub compensated: Option<Compensated<'a, T>>,
    pub still: &'a StillPlanes<T>,
    pub plane: &'a [Vector3<f64>; 3],
    pub worst: &'a Worst<T>,
    /// Memory: the direction of the in-plane deviation, base.
    pub along: &'a mut Planes<T, 3>,
    /// Displacement along it per unit of each compliance.
    pub by_unit: &'a mut [Plane<T>],
    pub shares: &'a mut [Plane<T>],
    pub variance: &'a mut Plane<T>,
}

impl<T: Float, const MOMENTS: bool> Work<T> for FindShares<'_, T, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let FindShares {
            model,
            frames,
            parts,
            curved,
            compensated,
            still,
            plane,
            worst,
            along,
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
        }
        let mut contributor = 0;
        while contributor < shares.len() {
            shares[contributor] = [T::default(); BLOCK];
            contributor += 1;
        }
        let mut sums = [[T::default(); BLOCK]; 2];
        let mut g = 0;
        while g < model.groups.len() {
            let group = &model.groups[g];
            let of_group = OfGroup {
                model,
                frames,
                parts,
                worst,
                along,
                first: group.first,
            };
            let share = &mut shares[model.parts[group.first].contributor];
            let by_unit = &mut by_unit[group.first..group.first + group.count];
            match group.count {
                1 => of_group.add::<R, 1, MOMENTS>(by_unit, share, &mut sums),
                2 => of_group.add::<R, 2, MOMENTS>(by_unit, share, &mut sums),
                _ => of_group.add::<R, 3, MOMENTS>(by_unit, share, &mut sums),
            }
            g += 1;
        }
        curved.share::<R, MOMENTS>(&worst.wrench, along, shares, &mut sums[0]);
        if let Some(compensated) = compensated {
            compensated.share::<R, MOMENTS>(along, by_unit, shares, &mut sums);
        }
        add_correlated::<R>(model, by_unit, &mut sums[1]);
        let (model_error, scatter) = (R::of(model.model_error), R::of(model.repeatability));
        for i in 0..BLOCK {
            R::step();
            let missed = R::load(sums[0][i]) * model_error;
            let of_parts = scatter.mul_add(scatter, R::load(sums[1][i]));
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

/// The shares of a group of parts.
struct OfGroup<'a, T> {
    model: &'a ModelConstants,
    frames: &'a [FramePlanes<T>],
    parts: &'a [PartPlanes<T>],
    worst: &'a Worst<T>,
    along: &'a Planes<T, 3>,
    first: usize,
}

impl<T: Float> OfGroup<'_, T> {
    /// Adds them to the share of their contributor and, in `sums`, to the deviation by load and gravity and to the
    /// variance of independent compliances.
    #[inline(always)]
    fn add<R: Real<Float = T>, const N: usize, const MOMENTS: bool>(
        &self,
        by_unit: &mut [Plane<T>],
        share: &mut Plane<T>,
        sums: &mut Planes<T, 2>,
    ) {
        let Some(parts) = self.parts[self.first..].first_chunk::<N>() else {
            return;
        };
        let Some(by_unit) = by_unit.first_chunk_mut::<N>() else {
            return;
        };
        let (zero, worst, along) = (R::of(0.0), self.worst, self.along);
        let (mut c, mut u) = ([zero; N], [zero; N]);
        let mut there = [Vector::new(zero, zero, zero); N];
        let mut axes = [&parts[0].angular; N];
        let mut n = 0;
        while n < N {
            let constants = &self.model.parts[self.first + n];
            (c[n], u[n]) = (R::of(constants.compliance), R::of(constants.uncertainty));
            there[n] = Vector::of(&constants.reference);
            axes[n] = angular(self.model, self.frames, self.parts, self.first + n);
            n += 1;
        }
        for i in 0..BLOCK {
            R::step();
            let along = vector::<R>(along, i);
            let force = vector::<R>(&worst.wrench[0..3], i);
            let (mut of_group, mut variance) = (zero, R::load(sums[1][i]));
            let mut n = 0;
            while n < N {
                let linear = vector::<R>(&parts[n].linear, i);
                let mut torque = linear.dot(force) + R::load(parts[n].weight[i]);
                if MOMENTS {
                    let moment = vector::<R>(&worst.wrench[3..6], i);
                    torque = torque + vector::<R>(axes[n], i).dot(moment);
                }
                let per_unit = linear.dot(along).mul_add(torque, -there[n].dot(along));
                by_unit[n][i] = per_unit.store();
                of_group = per_unit.mul_add(c[n], of_group);
                let by_u = per_unit * u[n];
                variance = by_u.mul_add(by_u, variance);
                n += 1;
            }
            share[i] = (R::load(share[i]) + of_group).store();
            sums[0][i] = (R::load(sums[0][i]) + of_group).store();
            sums[1][i] = variance.store();
        }
    }
}

/// Adds the variance by the compliances that are not independent.
#[inline(always)]
fn add_correlated<R: Real>(
    model: &ModelConstants,
    by_unit: &[Plane<R::Float>],
    variance: &mut Plane<R::Float>,
) {
    let mut r = 0;
    while r < model.covariance.len() {
        let row = &model.covariance[r];
        let mut weighted = [R::Float::default(); BLOCK];
        let mut k = 0;
        while k < row.entries.len() {
            let (other, entry) = (&by_unit[row.entries[k].0], R::of(row.entries[k].1));
            for i in 0..BLOCK {
                R::step();
                let so_far = R::load(weighted[i]);
                weighted[i] = R::load(other[i]).mul_add(entry, so_far).store();
            }
            k += 1;
        }
        let own = &by_unit[row.part];
        for i in 0..BLOCK {
            R::step();
            let so_far = R::load(variance[i]);
            variance[i] = R::load(own[i]).mul_add(R::load(weighted[i]), so_far).store();
        }
        r += 1;
    }
    // Rounding of a covariance.
    let zero = R::of(0.0);
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
