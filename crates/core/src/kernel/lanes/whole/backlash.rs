//! Backlash at single points: each link on the side that its torque gives, and where no torque decides on the side with
//! the largest in-plane deviation, as in `source/backlash.rs`.
//!
//! ```text
//! h_g = v_g b_g / 2                                         half of gap g; 0 where its torque decides
//! A_e = sum sign(P h_e x P h_g) h_g    B_e = sum of the halves along P h_e, in its direction
//! farthest of  d + (A_e + B_e),  d + (A_e - B_e),  d - (A_e - B_e),  d - (A_e + B_e)  over all e:
//! |P (d +- s)|^2 = |P d|^2 + |P s|^2 +- 2 P d . P s
//! ```
//!
//! `P` projects on the plane. The candidates, their order and the choice of equal ones are those of the plain row; only
//! their sums are rounded otherwise.

use nalgebra::Vector3;

use super::chain::FramePlanes;
use super::model::{MOST_GAPS, ModelConstants};
use super::parts::{PartPlanes, angular};
use crate::kernel::lanes::load::Worst;
use crate::numbers::{BLOCK, Backend, Float, Plane, Planes, Real, Vector, Work, planes, put, vector};
use crate::source::backlash::NO_TORQUE;
use crate::spatial::Wrench;

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
    /// Half of the gap where no torque decides its side, m: along two directions of the plane, and along the normal.
    half: Planes<T, 3>,
    /// The sum and the difference of the halves across this one and along it, and the squares of their in-plane parts.
    corners: [Planes<T, 3>; 2],
    squares: Planes<T, 2>,
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
        corners: [planes(), planes()],
        squares: planes(),
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

/// An arm with backlash at each point.
#[derive(Debug)]
pub(in crate::kernel::lanes) struct Worn<'a> {
    pub model: &'a ModelConstants,
    pub frames: &'a [FramePlanes<f64>],
    pub parts: &'a [PartPlanes<f64>],
    pub gaps: &'a mut [GapPlanes<f64>],
}

/// Adds the displacement by backlash under one load case to `deviation` (m, base), which is that by all other sources;
/// the cases in their order. The offsets of the links are found only if `OFFSETS`.
pub(in crate::kernel::lanes) fn settle<const OFFSETS: bool>(
    backend: Backend,
    arm: Worn<'_>,
    case: CaseOnPlane<'_>,
    deviation: &mut Planes<f64, 3>,
) {
    let Worn {
        model,
        frames,
        parts,
        gaps,
    } = arm;
    let plane = case.plane;
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
            deviation,
            free: &mut free,
        });
        if by_torque && free.iter().all(|free| *free <= 1.0) {
            backend.run(TakeAlone {
                model,
                plane,
                gaps,
                deviation,
            });
            return;
        }
        backend.run(FindCorners { gaps });
    }
    backend.run(TakeFarthest::<f64, OFFSETS> {
        model,
        plane,
        gaps,
        deviation,
    });
}

/// Finds where a torque decides and adds the displacement (m, base); fills the halves of the others and counts them.
struct FindSides<'a, T> {
    model: &'a ModelConstants,
    frames: &'a [FramePlanes<T>],
    parts: &'a [PartPlanes<T>],
    case: CaseOnPlane<'a>,
    gaps: &'a mut [GapPlanes<T>],
    deviation: &'a mut Planes<T, 3>,
    free: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for FindSides<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let CaseOnPlane { wrench, plane, .. } = self.case;
        let (force, moment) = (Vector::<R>::of(&wrench.force), Vector::<R>::of(&wrench.moment));
        let plane = Plane3::<R>::new(plane);
        let (zero, one, nothing) = (R::of(0.0), R::of(1.0), R::of(NO_TORQUE));
        let mut g = 0;
        while g < self.model.backlash.len() {
            let (constants, gap) = (&self.model.backlash[g], &mut self.gaps[g]);
            let part = &self.parts[constants.part];
            let axis = angular(self.model, self.frames, self.parts, constants.part);
            let half = R::of(constants.half);
            let by_torque = constants.by_torque;
            for i in 0..BLOCK {
                R::step();
                let linear = vector::<R>(&part.linear, i);
                let torque = linear.dot(force) + vector::<R>(axis, i).dot(moment);
                let torque = torque + R::load(part.weight[i]);
                let decides = by_torque & (torque.abs() > nothing);
                let offset = R::either(decides, half * torque.sign(), zero);
                gap.decided[i] = offset.store();
                let so_far = vector::<R>(self.deviation, i);
                put(self.deviation, i, linear.mul_add(offset, so_far));
                let along = plane.along(linear);
                // A half across the plane is on no side.
                let moves = (along.x.abs() + along.y.abs()) > zero;
                let open = R::either(moves & !decides, half, zero);
                put(&mut gap.half, i, along.scaled(open));
                self.free[i] = (R::load(self.free[i]) + R::either(decides, zero, one)).store();
            }
            g += 1;
        }
    }
}

/// Two directions across the normal, then the normal, in every lane.
#[derive(Clone, Copy)]
struct Plane3<R>([Vector<R>; 3]);

impl<R: Real> Plane3<R> {
    #[inline(always)]
    fn new(plane: &[Vector3<f64>; 3]) -> Self {
        Plane3([
            Vector::of(&plane[0]),
            Vector::of(&plane[1]),
            Vector::of(&plane[2]),
        ])
    }

    /// Components along the three.
    #[inline(always)]
    fn along(&self, v: Vector<R>) -> Vector<R> {
        Vector::new(v.dot(self.0[0]), v.dot(self.0[1]), v.dot(self.0[2]))
    }

    /// `to` and the vector with these components.
    #[inline(always)]
    fn add(&self, by: Vector<R>, to: Vector<R>) -> Vector<R> {
        let [first, second, normal] = self.0;
        first.mul_add(by.x, second.mul_add(by.y, normal.mul_add(by.z, to)))
    }
}

/// Puts the links of points of which at most one is not decided by its torque; adds its displacement (m, base).
struct TakeAlone<'a, T> {
    model: &'a ModelConstants,
    plane: &'a [Vector3<f64>; 3],
    gaps: &'a mut [GapPlanes<T>],
    deviation: &'a mut Planes<T, 3>,
}

impl<T: Float> Work<T> for TakeAlone<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let plane = Plane3::<R>::new(self.plane);
        let zero = R::of(0.0);
        let mut g = 0;
        while g < self.model.backlash.len() {
            let gap = &mut self.gaps[g];
            let half = R::of(self.model.backlash[g].half);
            for i in 0..BLOCK {
                R::step();
                let (delta, h) = (vector::<R>(self.deviation, i), vector::<R>(&gap.half, i));
                let in_plane = plane.along(delta);
                let sign = (in_plane.x * h.x + in_plane.y * h.y).sign();
                put(self.deviation, i, plane.add(h.scaled(sign), delta));
                let moves = (h.x.abs() + h.y.abs()) > zero;
                let offset = R::either(moves, half * sign, zero);
                gap.offset[i] = (R::load(gap.decided[i]) + offset).store();
            }
            g += 1;
        }
    }
}

/// Fills the corners at the ends of the edge along each half.
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
    let none = Vector::new(zero, zero, zero);
    let mut edge = 0;
    while edge < N {
        let mut corners: [Planes<R::Float, 3>; 2] = [planes(), planes()];
        let mut squares: Planes<R::Float, 2> = planes();
        let of_edge = &gaps[edge].half;
        for i in 0..BLOCK {
            R::step();
            let e = vector::<R>(of_edge, i);
            let (mut across, mut along) = (none, none);
            let mut g = 0;
            while g < N {
                let h = vector::<R>(&gaps[g].half, i);
                let (side, end) = sides(e, h);
                across = h.mul_add(side, across);
                along = h.mul_add(end, along);
                g += 1;
            }
            let (sum, difference) = (across + along, across - along);
            put(&mut corners[0], i, sum);
            put(&mut corners[1], i, difference);
            // No corner where there is no edge.
            let moves = (e.x.abs() + e.y.abs()) > zero;
            let none = R::of(-1.0);
            squares[0][i] = R::either(moves, sum.x.mul_add(sum.x, sum.y * sum.y), none).store();
            let square = difference.x.mul_add(difference.x, difference.y * difference.y);
            squares[1][i] = R::either(moves, square, none).store();
        }
        gaps[edge].corners = corners;
        gaps[edge].squares = squares;
        edge += 1;
    }
}

/// Sign of a half by its side of an edge, and by its direction where it is along it, both in the plane; 0 for the other
/// of the two.
#[inline(always)]
fn sides<R: Real>(edge: Vector<R>, half: Vector<R>) -> (R, R) {
    let zero = R::of(0.0);
    // Rounded one after the other: exactly zero for the edge itself.
    let across = edge.x * half.y - edge.y * half.x;
    let along = edge.x * half.x + edge.y * half.y;
    let parallel = across == zero;
    (
        R::either(parallel, zero, across.sign()),
        R::either(parallel, along.sign(), zero),
    )
}

/// Puts the links that no torque decides on the farthest side and adds the displacement (m, base).
struct TakeFarthest<'a, T, const OFFSETS: bool> {
    model: &'a ModelConstants,
    plane: &'a [Vector3<f64>; 3],
    gaps: &'a mut [GapPlanes<T>],
    deviation: &'a mut Planes<T, 3>,
}

impl<T: Float, const OFFSETS: bool> Work<T> for TakeFarthest<'_, T, OFFSETS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let plane = Plane3::<R>::new(self.plane);
        if let Some(gaps) = self.gaps.first_chunk_mut::<MOST_GAPS>() {
            take_farthest::<R, MOST_GAPS, OFFSETS>(self.model, plane, gaps, self.deviation);
        } else if let Some(gaps) = self.gaps.first_chunk_mut::<FEW_GAPS>() {
            take_farthest::<R, FEW_GAPS, OFFSETS>(self.model, plane, gaps, self.deviation);
        }
    }
}

#[inline(always)]
fn take_farthest<R: Real, const N: usize, const OFFSETS: bool>(
    model: &ModelConstants,
    plane: Plane3<R>,
    gaps: &mut [GapPlanes<R::Float>; N],
    deviation: &mut Planes<R::Float, 3>,
) {
    let (zero, two) = (R::of(0.0), R::of(2.0));
    let mut halves = [zero; N];
    let mut g = 0;
    while g < model.backlash.len() {
        halves[g] = R::of(model.backlash[g].half);
        g += 1;
    }
    for i in 0..BLOCK {
        R::step();
        let delta = vector::<R>(deviation, i);
        let from = plane.along(delta);
        let (twice_x, twice_y) = (from.x * two, from.y * two);
        // By how much the square of the in-plane deviation grows at most, and there: the displacement; its edge, side
        // and end.
        let mut most = R::of(-1.0);
        let mut by = Vector::new(zero, zero, zero);
        let (mut edge, mut side, mut end) = (by, zero, zero);
        let mut g = 0;
        while g < N {
            let gap = &gaps[g];
            let (sum, difference) = (vector::<R>(&gap.corners[0], i), vector::<R>(&gap.corners[1], i));
            let of_sum = twice_x.mul_add(sum.x, twice_y * sum.y);
            let of_difference = twice_x.mul_add(difference.x, twice_y * difference.y);
            let far = R::load(gap.squares[0][i]) + of_sum.abs();
            let other_far = R::load(gap.squares[1][i]) + of_difference.abs();
            // Of equal ones: the sum, the difference, the difference reversed, the sum reversed.
            let other = (other_far > far) | ((other_far == far) & (of_sum < zero));
            let (far, along) = (
                R::either(other, other_far, far),
                R::either(other, of_difference, of_sum),
            );
            let edge_there = R::load(gap.squares[0][i]) >= zero;
            let taken = edge_there & (far > most);
            let sign = along.sign();
            most = R::either(taken, far, most);
            by = Vector::new(
                R::either(taken, R::either(other, difference.x, sum.x) * sign, by.x),
                R::either(taken, R::either(other, difference.y, sum.y) * sign, by.y),
                R::either(taken, R::either(other, difference.z, sum.z) * sign, by.z),
            );
            if OFFSETS {
                let e = vector::<R>(&gap.half, i);
                edge.x = R::either(taken, e.x, edge.x);
                edge.y = R::either(taken, e.y, edge.y);
                side = R::either(taken, sign, side);
                end = R::either(taken, R::either(other, -sign, sign), end);
            }
            g += 1;
        }
        put(deviation, i, plane.add(by, delta));
        if OFFSETS {
            let mut g = 0;
            while g < N {
                let h = vector::<R>(&gaps[g].half, i);
                let moves = (h.x.abs() + h.y.abs()) > zero;
                let (of_side, of_end) = sides(edge, h);
                let sign = of_side.mul_add(side, of_end * end);
                let offset = R::either(moves, halves[g] * sign, zero);
                gaps[g].offset[i] = (R::load(gaps[g].decided[i]) + offset).store();
                g += 1;
            }
        }
    }
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
