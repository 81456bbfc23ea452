//! The best centre of all, with proof: a quantity of the centre made least, by halving cells and bounding what is in them.
//!
//! A cell is a rectangle of centres. Each is asked for a bound: no centre in it has less. The cell with the least bound is
//! halved; where no bound is below the least value found, less `TOLERANCE`, that value is the least of all. What is found
//! does not depend on a good start, and a local optimum cannot pass for the global one.
//!
//! Bounds are taken over a few working points, which is allowed, since fewer points ask for less; values over all of them.
//! Points that decide a value join the working points: so a profile of 10^5 points is searched at the price of some tens.
//!
//! Source: branch and bound, as in Horst and Tuy, Global Optimization, Springer 1996; working points as in cutting planes:
//! Kelley, The cutting-plane method for solving convex programs, J. SIAM 8, 1960 \[recalled\].

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use nalgebra::Vector2;

use super::RoundnessError;

/// What is found may be above the least of all by this, in radii of the profile: some tens of roundings.
const TOLERANCE: f64 = 1e-14;
/// Most cells: a profile takes some thousands.
const MOST_CELLS: usize = 2_000_000;

/// A rectangle of centres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub middle: Vector2<f64>,
    /// Half its sides.
    pub half: Vector2<f64>,
}

/// What is known of a cell.
pub(super) struct Bound {
    /// No centre in it has less.
    pub least: f64,
    /// The value at its middle over the working points; infinite where no centre may lie there.
    pub at_middle: f64,
    /// How much each half side has a part in `least` being below `at_middle`.
    pub by_side: Vector2<f64>,
}

/// A plane that the quantity is never below in a cell: `value + slope . (c - middle)`, less its bend.
#[derive(Clone, Copy)]
pub(super) struct Tangent {
    /// At the middle of the cell.
    pub value: f64,
    pub slope: Vector2<f64>,
    /// How far the quantity bends below the plane, the part of each half side.
    pub bend: Vector2<f64>,
}

impl Tangent {
    /// The least that it leaves in a cell, and what each half side takes off the value at the middle.
    fn least(&self, half: &Vector2<f64>) -> (f64, Vector2<f64>) {
        let by_side = self.slope.abs().component_mul(half) + self.bend;
        (self.value - by_side.sum(), by_side)
    }

    /// The mean of both by weight: the quantity is not below that either.
    fn mean(&self, other: &Tangent, weight: f64) -> Tangent {
        Tangent {
            value: weight * self.value + (1.0 - weight) * other.value,
            slope: self.slope * weight + other.slope * (1.0 - weight),
            bend: self.bend * weight + other.bend * (1.0 - weight),
        }
    }
}

/// The best bound by `first` alone and by its means with each of `others`: where two that face each other hold the optimum,
/// their mean is level, and large cells are enough. What each half side takes off comes with it.
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

/// How far the distance to a point, `away` from the middle of a cell at `distance`, is above its tangent in the cell at
/// most, the part of each half side: the square of what passes across the line of sight, over twice the least distance.
pub(super) fn distance_bend(away: &Vector2<f64>, distance: f64, half: &Vector2<f64>) -> Vector2<f64> {
    let passed = Vector2::new(away.y, away.x).abs().component_mul(half) / distance;
    passed * (passed.sum() / (2.0 * (distance - half.norm())))
}

/// A quantity of the centre, to be made least.
pub(super) trait Objective {
    /// Its value over all points; those that decide it join the working points.
    fn value(&mut self, centre: &Vector2<f64>) -> f64;
    /// What is known of a cell from the working points.
    fn bound(&self, cell: &Cell) -> Bound;
}

/// A cell that may hold better.
struct Open {
    least: f64,
    by_side: Vector2<f64>,
    cell: Cell,
}

/// The centre in `root` where `objective` is least, to `TOLERANCE`, and its value; `start` is the first guess.
///
/// # Errors
/// Too many cells are as good as each other.
pub(super) fn least(
    objective: &mut impl Objective,
    root: Cell,
    start: Vector2<f64>,
) -> Result<(Vector2<f64>, f64), RoundnessError> {
    let mut best = (start, objective.value(&start));
    let bound = objective.bound(&root);
    let mut cells = 1;
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
        if cells > MOST_CELLS {
            return Err(RoundnessError::NotProven { cells });
        }
    }
    Ok(best)
}

impl Open {
    /// Both halves of the cell, across the side that spoils its bound most.
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

/// The cell with the least bound comes first out of the heap.
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
