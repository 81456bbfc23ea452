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

/// Most gaps that lanes know. They are computed six or eight at once; those that an arm lacks are zero.
pub(in crate::kernel::lanes) const MOST_GAPS: usize = 8;
const FEW_GAPS: usize = 6;

/// A gap at each point.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct GapPlanes<T> {
    /// Offset of the link from its motor under the current case, and under the worst so far, rad (m).
    offset: Plane<T>,
    worst: Plane<T>,
    /// Offset where a torque decides, otherwise 0.
    decided: Plane<T>,
    /// Half of the gap in the plane where no torque decides its side, m, base.
    half: Planes<T, 2>,
    /// Sums of the halves on both sides of this one, and along it.
    across: Planes<T, 2>,
    along: Planes<T, 2>,
}

/// Memory for the gaps of this arm.
pub(in crate::kernel::lanes) fn gaps_of<T: Float>(model: &ModelConstants) -> Vec<GapPlanes<T>> {
    let count = match model.backlash.len() {
        0 => 0,
        1..=FEW_GAPS => FEW_GAPS,
        _ => MOST_GAPS,
    };
    let unknown = GapPlanes {
        offset: [T::default(); BLOCK],
        worst: [T::default(); BLOCK],
        decided: [T::default(); BLOCK],
        half: planes(),
        across: planes(),
        along: planes(),
    };
    vec![unknown; count]
}

/// One load case: index, wrench, and two directions across the normal, then the normal, base.
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) struct CaseOnPlane<'a> {
    pub case: usize,
    pub wrench: &'a Wrench,
    pub plane: &'a [Vector3<f64>; 3],
}

/// Adds the displacement by backlash under one load case to `deviation` (m, base), which is that by all other sources;
/// the cases in their order.
pub(in crate::kernel::lanes) fn settle(
    backend: Backend,
    model: &ModelConstants,
    (frames, parts): (&[FramePlanes<f64>], &[PartPlanes<f64>]),
    case: CaseOnPlane<'_>,
    gaps: &mut [GapPlanes<f64>],
    deviation: &mut Planes<f64, 3>,
) {
    // The halves are the same under every case, unless a torque decides.
    let by_torque = model.backlash.iter().any(|gap| gap.by_torque);
    if by_torque || case.case == 0 {
        let mut free = [0.0; BLOCK];
        backend.run(FindSides {
            model,
            frames,
            parts,
            case,
            gaps,
            free: &mut free,
        });
        if free.iter().any(|free| *free != 0.0) {
            backend.run(FindCorners { gaps });
        } else {
            backend.run(TakeDecided {
                model,
                parts,
                gaps,
                deviation,
            });
            return;
        }
    }
    backend.run(TakeFarthest {
        model,
        parts,
        case,
        gaps,
        deviation,
    });
}

/// Finds where a torque decides; fills the halves of the others, and marks the points that have any.
struct FindSides<'a, T> {
    model: &'a ModelConstants,
    frames: &'a [FramePlanes<T>],
    parts: &'a [PartPlanes<T>],
    case: CaseOnPlane<'a>,
    gaps: &'a mut [GapPlanes<T>],
    free: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for FindSides<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let CaseOnPlane { wrench, plane, .. } = self.case;
        let (force, moment) = (Vector::<R>::of(&wrench.force), Vector::<R>::of(&wrench.moment));
        let (first, second) = (Vector::<R>::of(&plane[0]), Vector::<R>::of(&plane[1]));
        let (zero, one, nothing) = (R::of(0.0), R::of(1.0), R::of(NO_TORQUE));
        let mut g = 0;
        while g < self.model.backlash.len() {
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
                gap.decided[i] = R::either(decides, half * torque.sign(), zero).store();
                let open = R::either(decides, zero, half);
                gap.half[0][i] = (linear.dot(first) * open).store();
                gap.half[1][i] = (linear.dot(second) * open).store();
                self.free[i] = R::either(decides, R::load(self.free[i]), one).store();
            }
            g += 1;
        }
    }
}

/// Takes the sides that torques decide, at points where they decide all, and adds their displacement (m, base).
struct TakeDecided<'a, T> {
    model: &'a ModelConstants,
    parts: &'a [PartPlanes<T>],
    gaps: &'a mut [GapPlanes<T>],
    deviation: &'a mut Planes<T, 3>,
}

impl<T: Float> Work<T> for TakeDecided<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let mut g = 0;
        while g < self.model.backlash.len() {
            let gap = &mut self.gaps[g];
            let linear = &self.parts[self.model.backlash[g].part].linear;
            for i in 0..BLOCK {
                R::step();
                let offset = R::load(gap.decided[i]);
                gap.offset[i] = offset.store();
                let so_far = vector::<R>(self.deviation, i);
                put(self.deviation, i, vector::<R>(linear, i).mul_add(offset, so_far));
            }
            g += 1;
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
        if let Some(gaps) = self.gaps.first_chunk_mut::<MOST_GAPS>() {
            find_corners::<R, MOST_GAPS>(gaps);
        } else if let Some(gaps) = self.gaps.first_chunk_mut::<FEW_GAPS>() {
            find_corners::<R, FEW_GAPS>(gaps);
        }
    }
}

#[inline(always)]
fn find_corners<R: Real, const N: usize>(gaps: &mut [GapPlanes<R::Float>; N]) {
    let zero = R::of(0.0);
    let mut edge = 0;
    while edge < N {
        let (mut across, mut along): (Planes<R::Float, 2>, Planes<R::Float, 2>) = (planes(), planes());
        let of_edge = &gaps[edge].half;
        for i in 0..BLOCK {
            R::step();
            let e = [R::load(of_edge[0][i]), R::load(of_edge[1][i])];
            let (mut a, mut b) = ([zero; 2], [zero; 2]);
            let mut g = 0;
            while g < N {
                let h = [R::load(gaps[g].half[0][i]), R::load(gaps[g].half[1][i])];
                let (side, end) = sides(e, h);
                a = [side.mul_add(h[0], a[0]), side.mul_add(h[1], a[1])];
                b = [end.mul_add(h[0], b[0]), end.mul_add(h[1], b[1])];
                g += 1;
            }
            (across[0][i], across[1][i]) = (a[0].store(), a[1].store());
            (along[0][i], along[1][i]) = (b[0].store(), b[1].store());
        }
        gaps[edge].across = across;
        gaps[edge].along = along;
        edge += 1;
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

/// Puts every link: by its torque, or where none decides on the farthest side; adds the displacement (m, base).
struct TakeFarthest<'a, T> {
    model: &'a ModelConstants,
    parts: &'a [PartPlanes<T>],
    case: CaseOnPlane<'a>,
    gaps: &'a mut [GapPlanes<T>],
    deviation: &'a mut Planes<T, 3>,
}

impl<T: Float> Work<T> for TakeFarthest<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let (model, parts, plane) = (self.model, self.parts, self.case.plane);
        if let Some(gaps) = self.gaps.first_chunk_mut::<MOST_GAPS>() {
            take_farthest::<R, MOST_GAPS>(model, parts, plane, gaps, self.deviation);
        } else if let Some(gaps) = self.gaps.first_chunk_mut::<FEW_GAPS>() {
            take_farthest::<R, FEW_GAPS>(model, parts, plane, gaps, self.deviation);
        }
    }
}

#[inline(always)]
fn take_farthest<R: Real, const N: usize>(
    model: &ModelConstants,
    parts: &[PartPlanes<R::Float>],
    plane: &[Vector3<f64>; 3],
    gaps: &mut [GapPlanes<R::Float>; N],
    deviation: &mut Planes<R::Float, 3>,
) {
    let (zero, one, minus) = (R::of(0.0), R::of(1.0), R::of(-1.0));
    let (first, second) = (Vector::<R>::of(&plane[0]), Vector::<R>::of(&plane[1]));
    // Gaps that the arm lacks have the screw of any part, and no half.
    let (mut screws, mut halves) = ([&parts[0].linear; N], [zero; N]);
    let mut g = 0;
    while g < model.backlash.len() {
        screws[g] = &parts[model.backlash[g].part].linear;
        halves[g] = R::of(model.backlash[g].half);
        g += 1;
    }
    for i in 0..BLOCK {
        R::step();
        let mut delta = vector::<R>(deviation, i);
        let mut g = 0;
        while g < N {
            delta = vector::<R>(screws[g], i).mul_add(R::load(gaps[g].decided[i]), delta);
            g += 1;
        }
        let from = [delta.dot(first), delta.dot(second)];
        // The square of the largest in-plane deviation; its edge, side and end.
        let (mut most, mut edge, mut side, mut end) = (minus, [zero; 2], zero, zero);
        let mut g = 0;
        while g < N {
            let gap = &gaps[g];
            let e = [R::load(gap.half[0][i]), R::load(gap.half[1][i])];
            let a = [R::load(gap.across[0][i]), R::load(gap.across[1][i])];
            let b = [R::load(gap.along[0][i]), R::load(gap.along[1][i])];
            let (plus, of_plus) = better_end([from[0] + a[0], from[1] + a[1]], b);
            let (less, of_less) = better_end([from[0] - a[0], from[1] - a[1]], b);
            let other = less > plus;
            let square = R::either(other, less, plus);
            let moves = (e[0].abs() + e[1].abs()) > zero;
            let taken = moves & (square > most);
            most = R::either(taken, square, most);
            side = R::either(taken, R::either(other, minus, one), side);
            end = R::either(taken, R::either(other, of_less, of_plus), end);
            edge[0] = R::either(taken, e[0], edge[0]);
            edge[1] = R::either(taken, e[1], edge[1]);
            g += 1;
        }
        let mut g = 0;
        while g < N {
            let h = [R::load(gaps[g].half[0][i]), R::load(gaps[g].half[1][i])];
            let moves = (h[0].abs() + h[1].abs()) > zero;
            let (of_side, of_end) = sides(edge, h);
            let sign = of_side.mul_add(side, of_end * end);
            let offset = R::either(moves, halves[g] * sign, zero);
            delta = vector::<R>(screws[g], i).mul_add(offset, delta);
            gaps[g].offset[i] = (R::load(gaps[g].decided[i]) + offset).store();
            g += 1;
        }
        put(deviation, i, delta);
    }
}

/// The larger square of `at + along` and `at - along`, and which: the first if equal.
#[inline(always)]
fn better_end<R: Real>(at: [R; 2], along: [R; 2]) -> (R, R) {
    let plus = [at[0] + along[0], at[1] + along[1]];
    let less = [at[0] - along[0], at[1] - along[1]];
    let (plus, less) = (
        plus[0].mul_add(plus[0], plus[1] * plus[1]),
        less[0].mul_add(less[0], less[1] * less[1]),
    );
    let other = less > plus;
    (
        R::either(other, less, plus),
        R::either(other, R::of(-1.0), R::of(1.0)),
    )
}

/// Keeps the offsets of the points where this case is the worst so far.
pub(in crate::kernel::lanes) struct KeepOffsets<'a, T> {
    pub model: &'a ModelConstants,
    pub case: usize,
    pub worst: &'a Worst<T>,
    pub gaps: &'a mut [GapPlanes<T>],
}

impl<T: Float> Work<T> for KeepOffsets<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let index = R::of(self.case as f64);
        let mut g = 0;
        while g < self.model.backlash.len() {
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
        while g < self.model.backlash.len() {
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
