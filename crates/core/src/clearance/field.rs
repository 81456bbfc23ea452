//! A field of distances around bodies that do not move relative to each other: fast bounds of the distance of a capsule from them.
//!
//! The space around the bodies is divided into cubic cells, and each of these into 4 x 4 x 4 fine ones. A cell knows the distance `d` of
//! its centre `c` from the nearest body; the distance of any point `p` from them is
//!
//! ```text
//! d - |p - c|  <=  distance of p  <=  d + |p - c|
//! ```
//!
//! A ball around a capsule is as far as its centre less its radius; where that does not decide, the capsule is halved.
//! Values are calculated when they are first used, in the frame of the bodies; they do not depend on the order of use.
//! Lengths in m.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use nalgebra::Point3;

use super::bounds::{Bounds, Capsule};
use super::nearest::Segment;
use super::shape::Placed;

/// Least edge of a cell.
const LEAST_EDGE: f64 = 0.02;
/// Most cells: 16 MiB.
const MOST_CELLS: f64 = 4.0e6;
/// Fine cells along the edge of a cell.
const FINE: usize = 4;
/// Most values of fine cells that are stored, a power of two: 8 MiB.
const MOST_FINE: usize = 1 << 20;
/// How far the field reaches beyond the bodies. Farther away the box around them bounds the distance.
const BEYOND: f64 = 0.25;
/// Most halvings of a capsule: pieces as short as 1/128 of it.
const MOST_HALVINGS: u32 = 7;

/// A field of distances.
#[derive(Clone, Debug)]
pub struct Field {
    around: Bounds,
    region: Bounds,
    edge: f64,
    counts: [usize; 3],
    /// Distances of the centres of cells.
    values: Arc<[Value]>,
    /// Those of some fine cells: the index of the cell plus 1 in the upper half, the bits of the distance in the lower.
    fine: Arc<[AtomicU64]>,
}

/// Bounds of a distance, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// It is not less.
    pub lower: f64,
    /// It is not greater.
    pub upper: f64,
}

/// What is to be decided of a distance, m.
#[derive(Clone, Copy, Debug)]
pub struct Thresholds {
    /// Whether it is at least this.
    pub least: f64,
    /// Whether it is even at least this, if that is known without much effort.
    pub enough: f64,
}

/// A distance: the bits of a single-precision number, which is never above the exact one, plus 1; 0 where it is not known yet.
#[derive(Debug, Default)]
struct Value(AtomicU32);

impl Value {
    /// The distance, calculated if it is not known, as bounds.
    fn range(&self, distance: impl FnOnce() -> f64) -> Range {
        let bits = match self.0.load(Ordering::Relaxed).checked_sub(1) {
            Some(bits) => bits,
            None => {
                let bits = bits_of(distance());
                self.0.store(bits + 1, Ordering::Relaxed);
                bits
            }
        };
        range_of_bits(bits)
    }
}

/// The bits of a single-precision number that is not above a distance.
fn bits_of(distance: f64) -> u32 {
    (distance as f32).next_down().max(0.0).to_bits()
}

/// The distances with these bits.
fn range_of_bits(bits: u32) -> Range {
    let below = f32::from_bits(bits);
    Range {
        lower: f64::from(below),
        upper: f64::from(below.next_up().next_up()),
    }
}

impl Range {
    /// Of a point this far away.
    fn apart(&self, by: f64) -> Range {
        Range {
            lower: self.lower - by,
            upper: self.upper + by,
        }
    }

    fn contains(&self, value: f64) -> bool {
        self.lower < value && value <= self.upper
    }

    /// Without the lower bound.
    pub fn upper_alone(&self) -> Range {
        Range {
            lower: f64::NEG_INFINITY,
            ..*self
        }
    }

    /// Of the distance less this.
    pub fn less(&self, by: f64) -> Range {
        Range {
            lower: self.lower - by,
            upper: self.upper - by,
        }
    }
}

impl Thresholds {
    /// Of a distance that is this much greater.
    pub fn plus(&self, by: f64) -> Thresholds {
        Thresholds {
            least: self.least + by,
            enough: self.enough + by,
        }
    }
}

impl Field {
    /// The field around bodies that are inside of this box.
    pub fn around(bodies: &Bounds) -> Field {
        let region = bodies.grown(BEYOND);
        let size = region.greatest - region.least;
        let edge = (size.product() / MOST_CELLS).cbrt().max(LEAST_EDGE);
        let counts: [usize; 3] = std::array::from_fn(|axis| (size[axis] / edge).ceil().max(1.0) as usize);
        let cells: usize = counts.iter().product();
        let fine = cells.next_power_of_two().saturating_mul(FINE).min(MOST_FINE);
        Field {
            around: *bodies,
            region,
            edge,
            counts,
            values: (0..cells).map(|_| Value::default()).collect(),
            fine: (0..fine).map(|_| AtomicU64::new(0)).collect(),
        }
    }

    /// Edge of a fine cell, m.
    fn fine_edge(&self) -> f64 {
        self.edge / FINE as f64
    }

    /// The distance of a point from the bodies, as near as needed and as the cells permit.
    pub fn range_at(&self, point: &Point3<f64>, bodies: &[Placed], thresholds: Thresholds) -> Range {
        let at = (point - self.region.least) / self.edge;
        let inside = |axis: usize| at[axis] >= 0.0 && at[axis] < self.counts[axis] as f64;
        if !(inside(0) && inside(1) && inside(2)) {
            return Range {
                lower: self.around.distance_of(point),
                upper: f64::INFINITY,
            };
        }
        let cell = [0, 1, 2].map(|axis| at[axis] as usize);
        let centre = self.centre(cell, self.edge);
        let value = &self.values[flat(cell, self.counts)];
        let of_cell = value.range(|| distance_of(&centre, bodies, f64::INFINITY));
        let range = of_cell.apart((point - centre).norm());
        if !range.contains(thresholds.least) && !range.contains(thresholds.enough) {
            return range;
        }
        let fine = [0, 1, 2].map(|axis| (at[axis] * FINE as f64) as usize);
        let fine_centre = self.centre(fine, self.fine_edge());
        let of_fine = self.range_of_fine(fine, || {
            let farthest = of_cell.apart((fine_centre - centre).norm()).upper;
            distance_of(&fine_centre, bodies, farthest)
        });
        let finer = of_fine.apart((point - fine_centre).norm());
        Range {
            lower: range.lower.max(finer.lower),
            upper: range.upper.min(finer.upper),
        }
    }

    /// The distance of the centre of a fine cell, calculated if it is not stored; it takes the place of that of another cell.
    fn range_of_fine(&self, cell: [usize; 3], distance: impl FnOnce() -> f64) -> Range {
        let index = flat(cell, self.counts.map(|count| count * FINE)) as u64;
        // Neighbours are stored apart from each other: multiplicative hashing by the golden ratio.
        let place = (index.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize & (self.fine.len() - 1);
        let stored = self.fine[place].load(Ordering::Relaxed);
        if stored >> 32 == index + 1 {
            return range_of_bits(stored as u32);
        }
        let bits = bits_of(distance());
        self.fine[place].store((index + 1) << 32 | u64::from(bits), Ordering::Relaxed);
        range_of_bits(bits)
    }

    /// The centre of a cell with this edge.
    fn centre(&self, cell: [usize; 3], edge: f64) -> Point3<f64> {
        let along = |axis: usize| self.region.least[axis] + (cell[axis] as f64 + 0.5) * edge;
        Point3::new(along(0), along(1), along(2))
    }

    /// A lower bound of the distance of a capsule from the bodies: refined until it is at least `enough`, or as near as
    /// the cells permit.
    pub fn bound_of(&self, capsule: &Capsule, bodies: &[Placed], enough: f64) -> f64 {
        let least = f64::NEG_INFINITY;
        self.range_of(capsule, bodies, Thresholds { least, enough }).lower
    }

    /// The distance of the axis of a capsule from the bodies less its radius, so that it is negative where they overlap: refined until it is
    /// decided whether it is at least `least`, and as long as it may be at least `enough`.
    pub fn range_of(&self, capsule: &Capsule, bodies: &[Placed], thresholds: Thresholds) -> Range {
        let axis = thresholds.plus(capsule.radius);
        self.range_of_axis(&capsule.axis, bodies, axis, MOST_HALVINGS)
            .less(capsule.radius)
    }

    fn range_of_axis(
        &self,
        axis: &Segment,
        bodies: &[Placed],
        mut thresholds: Thresholds,
        halvings: u32,
    ) -> Range {
        let (middle, half) = (axis.middle(), axis.half_length());
        let at_middle = self.range_at(&middle, bodies, thresholds);
        let range = Range {
            lower: at_middle.lower - half,
            upper: at_middle.upper,
        };
        // Nowhere can it be better than in the middle: there is no use in halving what is too near there.
        if at_middle.lower < thresholds.enough {
            thresholds.enough = thresholds.least;
        }
        if range.lower >= thresholds.enough
            || range.upper < thresholds.least
            || halvings == 0
            || half < 0.5 * self.fine_edge()
        {
            return range;
        }
        let halves = [(axis.from, middle), (middle, axis.to)].map(|ends| Segment {
            from: ends.0,
            to: ends.1,
        });
        let first = self.range_of_axis(&halves[0], bodies, thresholds, halvings - 1);
        if first.upper < thresholds.least {
            return Range {
                lower: range.lower,
                ..first
            };
        }
        let second = self.range_of_axis(&halves[1], bodies, thresholds, halvings - 1);
        Range {
            lower: range.lower.max(first.lower.min(second.lower)),
            upper: range.upper.min(first.upper).min(second.upper),
        }
    }
}

/// Index of a cell among these counts.
fn flat(cell: [usize; 3], counts: [usize; 3]) -> usize {
    (cell[0] * counts[1] + cell[1]) * counts[2] + cell[2]
}

/// The least distance of a point from bodies; `limit` where that is above it.
fn distance_of(point: &Point3<f64>, bodies: &[Placed], limit: f64) -> f64 {
    bodies
        .iter()
        .fold(limit, |least, body| body.distance_of(point, least))
}

#[cfg(test)]
mod tests;
