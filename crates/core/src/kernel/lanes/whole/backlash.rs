//! Backlash at single points: each link on the side that its torque gives, and where no torque decides on the side with
//! the largest in-plane deviation, as in `source/backlash.rs`.
//!
//! ```text
//! h_g = P v_g b_g / 2                                       half of gap g in the plane; 0 where its torque decides
//! A_e = sum sign(h_e x h_g) h_g    B_e = sum of the halves along h_e, in its direction
//! farthest of  d + A_e + B_e,  d + A_e - B_e,  d - A_e + B_e,  d - A_e - B_e  over all e
//! ```
//!
//! The candidates, their order and the choice of equal ones are those of the plain row; only their sums are rounded
//! otherwise.

use nalgebra::Vector3;

use super::chain::FramePlanes;
use super::model::ModelConstants;
use super::parts::PartPlanes;
use crate::kernel::lanes::load::Worst;
use crate::kernel::lanes::numbers::{
    BLOCK, Backend, Float, Plane, Planes, Real, Vector, Work, planes, put, vector,
};
use crate::source::backlash::NO_TORQUE;
use crate::spatial::Wrench;

/// A joint with backlash.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct GapConstants {
    /// Index of the drive of its joint.
    pub part: usize,
    /// Half of the backlash, rad (m), and its standard uncertainty over it.
    pub half: f64,
    pub relative: f64,
    pub by_torque: bool,
}

/// A gap at each point.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct GapPlanes<T> {
    /// Offset of the link from its motor under the current case, and under the worst so far, rad (m).
    offset: Plane<T>,
    worst: Plane<T>,
    /// Half of the gap in the plane where no torque decides its side, m, base.
    half: Planes<T, 2>,
    /// Sums of the halves on both sides of this one, and along it.
    across: Planes<T, 2>,
    along: Planes<T, 2>,
}

impl<T: Float> GapPlanes<T> {
    /// A gap of which nothing is known yet.
    pub fn unknown() -> GapPlanes<T> {
        GapPlanes {
            offset: [T::default(); BLOCK],
            worst: [T::default(); BLOCK],
            half: planes(),
            across: planes(),
            along: planes(),
        }
    }
}

/// Adds the displacement by backlash under one load case to `deviation` (m, base), which is that by all other sources.
pub(in crate::kernel::lanes) fn settle(
    backend: Backend,
    model: &ModelConstants,
    (frames, parts): (&[FramePlanes<f64>], &[PartPlanes<f64>]),
    (case, wrench): (usize, &Wrench),
    plane: &[Vector3<f64>; 3],
    gaps: &mut [GapPlanes<f64>],
    deviation: &mut Planes<f64, 3>,
) {
    let (mut free, mut from) = ([0.0; BLOCK], planes());
    backend.run(FindSides {
        model,
        frames,
        parts,
        wrench,
        plane,
        gaps,
        deviation,
        from: &mut from,
        free: &mut free,
    });
    if free.iter().all(|free| *free == 0.0) {
        return;
    }
    // The same under every case, unless a torque decides.
    if case == 0 || model.backlash.iter().any(|gap| gap.by_torque) {
        backend.run(FindCorners { gaps });
    }
    backend.run(TakeFarthest {
        model,
        parts,
        from: &from,
        gaps,
        deviation,
    });
}

/// Puts the links whose side a torque decides; fills the halves of the others, and marks the points that have any.
struct FindSides<'a, T> {
    model: &'a ModelConstants,
    frames: &'a [FramePlanes<T>],
    parts: &'a [PartPlanes<T>],
    wrench: &'a Wrench,
    plane: &'a [Vector3<f64>; 3],
    gaps: &'a mut [GapPlanes<T>],
    deviation: &'a mut Planes<T, 3>,
    /// The deviation in the plane with the links that are put.
    from: &'a mut Planes<T, 2>,
    free: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for FindSides<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let (force, moment) = (
            Vector::<R>::of(&self.wrench.force),
            Vector::<R>::of(&self.wrench.moment),
        );
        let (first, second) = (Vector::<R>::of(&self.plane[0]), Vector::<R>::of(&self.plane[1]));
        let (zero, one, nothing) = (R::of(0.0), R::of(1.0), R::of(NO_TORQUE));
        let mut g = 0;
        while g < self.gaps.len() {
            let (constants, gap) = (&self.model.backlash[g], &mut self.gaps[g]);
            let part = &self.parts[constants.part];
            let axis = self.model.angular(self.frames, self.parts, constants.part);
            let half = R::of(constants.half);
            let by_torque = constants.by_torque;
            for i in 0..BLOCK {
                R::step();
                let linear = vector::<R>(&part.linear, i);
                let torque = linear.dot(force) + vector::<R>(axis, i).dot(moment);
                let torque = torque + R::load(part.weight[i]);
                let decides = by_torque & (torque.abs() > nothing);
                let offset = R::either(decides, half * torque.sign(), zero);
                gap.offset[i] = offset.store();
                let open = R::either(decides, zero, half);
                gap.half[0][i] = (linear.dot(first) * open).store();
                gap.half[1][i] = (linear.dot(second) * open).store();
                let so_far = vector::<R>(self.deviation, i);
                put(self.deviation, i, linear.mul_add(offset, so_far));
                self.free[i] = R::either(decides, R::load(self.free[i]), one).store();
            }
            g += 1;
        }
        for i in 0..BLOCK {
            R::step();
            let deviation = vector::<R>(self.deviation, i);
            self.from[0][i] = deviation.dot(first).store();
            self.from[1][i] = deviation.dot(second).store();
        }
    }
}

/// Fills the sums of halves on both sides of each half, and along it.
struct FindCorners<'a, T> {
    gaps: &'a mut [GapPlanes<T>],
}

impl<T: Float> Work<T> for FindCorners<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let mut edge = 0;
        while edge < self.gaps.len() {
            let (mut across, mut along): (Planes<T, 2>, Planes<T, 2>) = (planes(), planes());
            let mut g = 0;
            while g < self.gaps.len() {
                let (of_edge, of_gap) = (&self.gaps[edge].half, &self.gaps[g].half);
                for i in 0..BLOCK {
                    R::step();
                    let e = [R::load(of_edge[0][i]), R::load(of_edge[1][i])];
                    let h = [R::load(of_gap[0][i]), R::load(of_gap[1][i])];
                    let (side, end) = sides(e, h);
                    let mut axis = 0;
                    while axis < 2 {
                        let so_far = R::load(across[axis][i]);
                        across[axis][i] = side.mul_add(h[axis], so_far).store();
                        let so_far = R::load(along[axis][i]);
                        along[axis][i] = end.mul_add(h[axis], so_far).store();
                        axis += 1;
                    }
                }
                g += 1;
            }
            self.gaps[edge].across = across;
            self.gaps[edge].along = along;
            edge += 1;
        }
    }
}

/// Sign of a half by its side of an edge, and by its direction where it is along it; 0 for the other of the two.
#[inline(always)]
fn sides<R: Real>(edge: [R; 2], half: [R; 2]) -> (R, R) {
    let zero = R::of(0.0);
    // Rounded one after the other: exactly zero for the edge itself.
    let across = edge[0] * half[1] - edge[1] * half[0];
    let along = edge[0] * half[0] + edge[1] * half[1];
    let parallel = across == zero;
    (
        R::either(parallel, zero, across.sign()),
        R::either(parallel, along.sign(), zero),
    )
}

/// Puts the links whose side no torque decides, and adds their displacement (m, base).
struct TakeFarthest<'a, T> {
    model: &'a ModelConstants,
    parts: &'a [PartPlanes<T>],
    from: &'a Planes<T, 2>,
    gaps: &'a mut [GapPlanes<T>],
    deviation: &'a mut Planes<T, 3>,
}

impl<T: Float> Work<T> for TakeFarthest<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        // The square of the largest in-plane deviation; its edge, side and end.
        let mut most: Plane<T> = [T::default(); BLOCK];
        let mut chosen: Planes<T, 2> = planes();
        let mut signs: Planes<T, 2> = planes();
        let least = R::of(-1.0);
        for i in 0..BLOCK {
            R::step();
            most[i] = least.store();
        }
        let mut edge = 0;
        while edge < self.gaps.len() {
            let gap = &self.gaps[edge];
            for i in 0..BLOCK {
                R::step();
                let e = [R::load(gap.half[0][i]), R::load(gap.half[1][i])];
                let across = [R::load(gap.across[0][i]), R::load(gap.across[1][i])];
                let along = [R::load(gap.along[0][i]), R::load(gap.along[1][i])];
                let from = [R::load(self.from[0][i]), R::load(self.from[1][i])];
                let before = R::load(most[i]);
                let (mut best, mut side, mut end) = (before, zero, zero);
                let mut candidate = 0;
                while candidate < 4 {
                    let s = R::of(if candidate < 2 { 1.0 } else { -1.0 });
                    let t = R::of(if candidate % 2 == 0 { 1.0 } else { -1.0 });
                    let x = from[0] + s.mul_add(across[0], t * along[0]);
                    let y = from[1] + s.mul_add(across[1], t * along[1]);
                    let square = x.mul_add(x, y * y);
                    let more = square > best;
                    best = R::either(more, square, best);
                    side = R::either(more, s, side);
                    end = R::either(more, t, end);
                    candidate += 1;
                }
                let taken = (best > before) & !((e[0] == zero) & (e[1] == zero));
                most[i] = R::either(taken, best, before).store();
                signs[0][i] = R::either(taken, side, R::load(signs[0][i])).store();
                signs[1][i] = R::either(taken, end, R::load(signs[1][i])).store();
                chosen[0][i] = R::either(taken, e[0], R::load(chosen[0][i])).store();
                chosen[1][i] = R::either(taken, e[1], R::load(chosen[1][i])).store();
            }
            edge += 1;
        }
        let mut g = 0;
        while g < self.gaps.len() {
            let (constants, gap) = (&self.model.backlash[g], &mut self.gaps[g]);
            let part = &self.parts[constants.part];
            let half = R::of(constants.half);
            for i in 0..BLOCK {
                R::step();
                let e = [R::load(chosen[0][i]), R::load(chosen[1][i])];
                let h = [R::load(gap.half[0][i]), R::load(gap.half[1][i])];
                let moves = R::either((h[0] == zero) & (h[1] == zero), zero, one);
                let (side, end) = sides(e, h);
                let sign = side.mul_add(R::load(signs[0][i]), end * R::load(signs[1][i])) * moves;
                let offset = half * sign;
                gap.offset[i] = (R::load(gap.offset[i]) + offset).store();
                let so_far = vector::<R>(self.deviation, i);
                put(
                    self.deviation,
                    i,
                    vector::<R>(&part.linear, i).mul_add(offset, so_far),
                );
            }
            g += 1;
        }
    }
}

/// Keeps the offsets of the points where this case is the worst so far.
pub(in crate::kernel::lanes) struct KeepOffsets<'a, T> {
    pub case: usize,
    pub worst: &'a Worst<T>,
    pub gaps: &'a mut [GapPlanes<T>],
}

impl<T: Float> Work<T> for KeepOffsets<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let index = R::of(self.case as f64);
        let mut g = 0;
        while g < self.gaps.len() {
            let gap = &mut self.gaps[g];
            for i in 0..BLOCK {
                R::step();
                let worst = R::load(self.worst.case[i]) == index;
                gap.worst[i] = R::either(worst, R::load(gap.offset[i]), R::load(gap.worst[i])).store();
            }
            g += 1;
        }
    }
}

/// Adds the parts of backlash along the in-plane deviation of the worst case to the shares (m), and the variance by the
/// uncertainty of the gaps (m^2).
pub(in crate::kernel::lanes) struct ShareBacklash<'a, T> {
    pub model: &'a ModelConstants,
    pub parts: &'a [PartPlanes<T>],
    pub gaps: &'a [GapPlanes<T>],
    /// Direction of that deviation, base.
    pub along: &'a Planes<T, 3>,
    pub shares: &'a mut [Plane<T>],
    pub variance: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for ShareBacklash<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let mut g = 0;
        while g < self.gaps.len() {
            let (constants, gap) = (&self.model.backlash[g], &self.gaps[g]);
            let (part, share) = (
                &self.parts[constants.part],
                &mut self.shares[self.model.parts[constants.part].contributor],
            );
            let relative = R::of(constants.relative);
            for i in 0..BLOCK {
                R::step();
                let reach = vector::<R>(&part.linear, i).dot(vector::<R>(self.along, i));
                let of_gap = reach * R::load(gap.worst[i]);
                share[i] = (R::load(share[i]) + of_gap).store();
                let u = of_gap * relative;
                self.variance[i] = u.mul_add(u, R::load(self.variance[i])).store();
            }
            g += 1;
        }
    }
}

#[cfg(test)]
mod tests;
