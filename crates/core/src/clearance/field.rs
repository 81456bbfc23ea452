//! A field of distances around bodies that stand still: a fast lower bound of the distance of a capsule from them.
//!
//! The space around the bodies is divided into cubic cells. Each knows the distance `d` of its centre `c` from the nearest body;
//! no point `p` is nearer to them than
//!
//! ```text
//! d - |p - c|
//! ```
//!
//! A ball around a capsule is as far as its centre less its radius; where that does not decide, the capsule is halved.
//! Values are calculated when they are first used, in the frame of the bodies; they do not depend on the order of use.
//! Lengths in m.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use nalgebra::Point3;

use super::bounds::{Bounds, Capsule};
use super::nearest::Segment;
use super::shape::Placed;

/// Least edge of a cell.
const LEAST_EDGE: f64 = 0.02;
/// Most cells: 16 MiB.
const MOST_CELLS: f64 = 4.0e6;
/// How far the field reaches beyond the bodies. Farther away the box around them bounds the distance.
const BEYOND: f64 = 0.25;
/// Most halvings of a capsule: pieces as short as 1/32 of it.
const MOST_HALVINGS: u32 = 5;

/// A field of distances.
#[derive(Clone, Debug)]
pub struct Field {
    around: Bounds,
    region: Bounds,
    edge: f64,
    counts: [usize; 3],
    /// Distances of the centres: the bits of a single-precision number, which is never above the exact one, plus 1; 0 where it is not
    /// known yet.
    values: Arc<[AtomicU32]>,
}

impl Field {
    /// The field around bodies that are inside of this box.
    pub fn around(bodies: &Bounds) -> Field {
        let region = bodies.grown(BEYOND);
        let size = region.greatest - region.least;
        let edge = (size.product() / MOST_CELLS).cbrt().max(LEAST_EDGE);
        let counts: [usize; 3] = std::array::from_fn(|axis| (size[axis] / edge).ceil().max(1.0) as usize);
        let cells: usize = counts.iter().product();
        Field {
            around: *bodies,
            region,
            edge,
            counts,
            values: (0..cells).map(|_| AtomicU32::new(0)).collect(),
        }
    }

    /// A lower bound of the distance of a point from the bodies.
    fn bound(&self, point: &Point3<f64>, bodies: &[Placed]) -> f64 {
        let mut index = 0;
        let mut centre = Point3::origin();
        for axis in 0..3 {
            let at = (point[axis] - self.region.least[axis]) / self.edge;
            if !(at >= 0.0 && at < self.counts[axis] as f64) {
                return self.around.distance_of(point);
            }
            let cell = at as usize;
            centre[axis] = self.region.least[axis] + (cell as f64 + 0.5) * self.edge;
            index = index * self.counts[axis] + cell;
        }
        let known = self.values[index].load(Ordering::Relaxed);
        let distance = match known.checked_sub(1) {
            Some(bits) => f64::from(f32::from_bits(bits)),
            None => {
                let distance = bodies
                    .iter()
                    .map(|body| body.distance_of(&centre))
                    .fold(f64::INFINITY, f64::min);
                let below = (distance as f32).next_down().max(0.0);
                self.values[index].store(below.to_bits() + 1, Ordering::Relaxed);
                f64::from(below)
            }
        };
        distance - (point - centre).norm()
    }

    /// A lower bound of the distance of a capsule from the bodies: refined until it is at least `enough`, or as near as
    /// the cells permit.
    pub fn bound_of(&self, capsule: &Capsule, bodies: &[Placed], enough: f64) -> f64 {
        self.bound_of_axis(&capsule.axis, bodies, enough + capsule.radius, MOST_HALVINGS) - capsule.radius
    }

    fn bound_of_axis(&self, axis: &Segment, bodies: &[Placed], enough: f64, halvings: u32) -> f64 {
        let (middle, half) = (axis.middle(), axis.half_length());
        let at_middle = self.bound(&middle, bodies);
        let bound = at_middle - half;
        // Nowhere can it be better than in the middle: there is no use in halving what is too near there.
        if bound >= enough || halvings == 0 || half < 0.5 * self.edge || at_middle < enough {
            return bound;
        }
        let halves = [
            Segment {
                from: axis.from,
                to: middle,
            },
            Segment {
                from: middle,
                to: axis.to,
            },
        ];
        let [first, second] = halves.map(|half| self.bound_of_axis(&half, bodies, enough, halvings - 1));
        bound.max(first.min(second))
    }
}

#[cfg(test)]
mod tests;
