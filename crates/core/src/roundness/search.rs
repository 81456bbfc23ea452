//! Global optimum of the centre, with proof: branch and bound over cells.
//!
//! A cell is a rectangle of centres. Each has a bound: no centre in it has less. The cell with the least bound is
//! halved; where no bound is below the least value found, less `TOLERANCE`, that value is the global minimum. The
//! result does not depend on a good start, and is never a local optimum.
//!
//! Bounds are taken over a few working points, which is valid, since fewer points give lower bounds; values over all of
//! them. Points that decide a value join the working points: a profile of 10^5 points is then searched at the cost of
//! some tens.
//!
//! Source: branch and bound, as in Horst and Tuy, Global Optimization, Springer 1996; working points as in cutting
//! planes: Kelley, The cutting-plane method for solving convex programs, J. SIAM 8, 1960 \[recalled\].

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use nalgebra::Vector2;

use super::RoundnessError;

/// The result may exceed the minimum by this, in radii of the profile: some tens of roundings.
const TOLERANCE: f64 = 1e-14;
/// Maximum number of distances that are computed, in addition to as many times all points: a profile takes some hundred
/// thousand, and all points a hundred times.
const MOST_WORK: usize = 300_000_000;
const MOST_TIMES_ALL: usize = 1000;

/// A rectangle of centres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub middle: Vector2<f64>,
    /// Half its sides.
    pub half: Vector2<f64>,
}

/// Bound of a cell.
pub(super) struct Bound {
    /// No centre in it has less.
    pub least: f64,
    /// The value at its middle over the working points; infinite where a centre there is not valid.
    pub at_middle: f64,
    /// Contribution of each half side to `least` being below `at_middle`.
    pub by_side: Vector2<f64>,
}

/// A plane below the quantity in a cell: `value + slope . (c - middle)`, less its bend.
#[derive(Clone, Copy)]
pub(super) struct Tangent {
    /// At the middle of the cell.
    pub value: f64,
    pub slope: Vector2<f64>,
    /// Bend of the quantity below the plane, by half side.
    pub bend: Vector2<f64>,
}

impl Tangent {
    /// Its least value in a cell, and the contribution of each half side to the difference from the value at the
    /// middle.
    fn least(&self, half: &Vector2<f64>) -> (f64, Vector2<f64>) {
        let by_side = self.slope.abs().component_mul(half) + self.bend;
        (self.value - by_side.sum(), by_side)
    }

    /// The weighted mean of both: it is a lower bound too.
    fn mean(&self, other: &Tangent, weight: f64) -> Tangent {
        Tangent {
            value: weight * self.value + (1.0 - weight) * other.value,
            slope: self.slope * weight + other.slope * (1.0 - weight),
            bend: self.bend * weight + other.bend * (1.0 - weight),
        }
    }
}

/// The best bound by `first` alone and by its means with each of `others`: where two opposite ones determine the
/// optimum, their mean is level, and large cells are sufficient. Returned with the contribution of each half side.
pub(super) fn bound_by(
    first: Tangent,
    others: impl Iterator<Item = Tangent>,
    half: &Vector2<f64>,
) -> (f64, Vector2<f64>) {
    let (mut best, by_side) = first.least(half);
    for other in others {
        // The bound is concave in the weight, with corners where the mean is level along a side.
        let level = other.slope.component_div(&(other.slope - first.slope));
        for weight in level.iter().filter(|weight| (0.0..1.0).contains(*weight)) {
            best = best.max(first.mean(&other, *weight).least(half).0);
        }
    }
    (best, by_side)
}

/// Greatest excess of the distance to a point, `away` from the middle of a cell at `distance`, over its tangent in the
/// cell, by half side: the square of the part across the line of sight, over twice the least distance.
pub(super) fn distance_bend(away: &Vector2<f64>, distance: f64, half: &Vector2<f64>) -> Vector2<f64> {
    let passed = Vector2::new(away.y, away.x).abs().component_mul(half) / distance;
    passed * (passed.sum() / (2.0 * (distance - half.norm())))
}

/// A quantity of the centre, to be minimised.
pub(super) trait Objective {
    /// Its value over all points; those that decide it join the working points.
    fn value(&mut self, centre: &Vector2<f64>) -> f64;
    /// Bound of a cell from the working points.
    fn bound(&self, cell: &Cell) -> Bound;
    /// Number of points used by a value, and by a bound.
    fn work(&self) -> [usize; 2];
}

/// A cell that may contain a better centre.
struct Open {
    least: f64,
    by_side: Vector2<f64>,
    cell: Cell,
}

/// The centre in `root` where `objective` is least, to `TOLERANCE`, and its value; `start` is the initial guess.
///
/// # Errors
/// Too many cells are nearly equivalent.
pub(super) fn least(
    objective: &mut impl Objective,
    root: Cell,
    start: Vector2<f64>,
) -> Result<(Vector2<f64>, f64), RoundnessError> {
    let mut best = (start, objective.value(&start));
    let bound = objective.bound(&root);
    let (mut cells, mut work) = (1, 0);
    let mut open = BinaryHeap::from([Open {
        least: bound.least,
        by_side: bound.by_side,
        cell: root,
    }]);
    while let Some(next) = open.pop() {
        if next.least >= best.1 - TOLERANCE {
            break;
        }
        for cell in next.halves() {
            let mut bound = objective.bound(&cell);
            if bound.at_middle < best.1 {
                let value = objective.value(&cell.middle);
                work += objective.work()[0];
                if value < best.1 {
                    best = (cell.middle, value);
                }
                bound = objective.bound(&cell);
            }
            if bound.least < best.1 - TOLERANCE {
                open.push(Open {
                    least: bound.least,
                    by_side: bound.by_side,
                    cell,
                });
            }
        }
        cells += 2;
        work += 2 * objective.work()[1];
        if work > MOST_WORK + MOST_TIMES_ALL * objective.work()[0] {
            return Err(RoundnessError::NotProven { cells });
        }
    }
    Ok(best)
}

impl Open {
    /// Both halves of the cell, across the side that contributes most to its bound.
    fn halves(&self) -> [Cell; 2] {
        let mut half = self.cell.half;
        let side = self.by_side.imax();
        half[side] /= 2.0;
        let mut by = Vector2::zeros();
        by[side] = half[side];
        [-by, by].map(|by| Cell {
            middle: self.cell.middle + by,
            half,
        })
    }
}

/// The cell with the least bound is first out of the heap.
impl Ord for Open {
    fn cmp(&self, other: &Open) -> Ordering {
        other.least.total_cmp(&self.least)
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Open) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Open) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Open {}
