//! Points of a stock, and the first move that removes each.

use armill_core::nalgebra::Point3;
use armill_core::removal::DexelPart;
use rayon::prelude::*;

use crate::MM;
use crate::moving_tool::MovingTool;

/// Numbers from 0 to 1, the same in every run.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        // The generator of Lehmer with the constants of Knuth; its upper bits.
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        ((self.next() * count as f64) as usize).min(count - 1)
    }
}

/// Two points in every voxel of a box of about this many voxels.
pub fn in_voxels([low, high]: [Point3<f64>; 2], voxels: f64, numbers: &mut Numbers) -> Vec<Point3<f64>> {
    let size = high - low;
    let side = (size.x * size.y * size.z / voxels).cbrt();
    let counts = [size.x, size.y, size.z].map(|length| (length / side).ceil() as usize);
    let mut points = Vec::new();
    for x in 0..counts[0] {
        for y in 0..counts[1] {
            for z in 0..counts[2] {
                for _ in 0..2 {
                    let part = [x, y, z].map(|voxel| voxel as f64 + numbers.next());
                    let along = |k: usize| low[k] + size[k] * part[k] / counts[k] as f64;
                    points.push(Point3::new(along(0), along(1), along(2)));
                }
            }
        }
    }
    points
}

/// Points on random dexels along `k`, evenly distributed over all of their lengths.
pub fn on_dexels(part: &DexelPart, k: usize, count: usize, numbers: &mut Numbers) -> Vec<Point3<f64>> {
    let grid = &part.grids()[k];
    let [low, high] = part.corners();
    let one = |_| {
        let cell = grid.cells().map(|cells| numbers.below(cells));
        grid.position(cell, low[k] + (high[k] - low[k]) * numbers.next())
    };
    (0..count).map(one).collect()
}

/// Slabs of a stock that are cut in parallel, and bins of a slab along y and z.
const SLABS: usize = 48;
const BINS: [usize; 2] = [48, 32];
/// Pieces of moves on which a tool moves by no more than twice this, m.
const PIECE: f64 = 2.0 * MM;

/// For each point the index of the first move that reaches it.
pub fn first_removals(moves: &[MovingTool], points: &[Point3<f64>]) -> Vec<Option<u32>> {
    let Some(first) = points.first() else {
        return Vec::new();
    };
    let [low, high] = points.iter().fold([*first; 2], |[low, high], point| {
        [low.inf(point), high.sup(point)]
    });
    let counts = [SLABS, BINS[0], BINS[1]];
    let bin = |at: f64, k: usize| {
        let part = (at - low[k]) / (high[k] - low[k]).max(f64::MIN_POSITIVE);
        ((part * counts[k] as f64) as usize).min(counts[k] - 1)
    };
    let mut slabs = vec![vec![Vec::<u32>::new(); BINS[0] * BINS[1]]; SLABS];
    for (number, point) in (0..).zip(points) {
        let [x, y, z] = [0, 1, 2].map(|k| bin(point[k], k));
        slabs[x][y * BINS[1] + z].push(number);
    }
    let boxes: Vec<_> = (0_u32..)
        .zip(moves)
        .flat_map(|(number, of)| of.boxes(PIECE).map(move |piece| (number, piece)))
        .collect();
    let removed = slabs.par_iter_mut().enumerate().map(|(slab, bins)| {
        let mut removed = Vec::new();
        for (number, (parts, around)) in &boxes {
            if (0..3).any(|k| around[1][k] < low[k] || around[0][k] > high[k])
                || !(bin(around[0].x, 0)..=bin(around[1].x, 0)).contains(&slab)
            {
                continue;
            }
            for y in bin(around[0].y, 1)..=bin(around[1].y, 1) {
                for z in bin(around[0].z, 2)..=bin(around[1].z, 2) {
                    bins[y * BINS[1] + z].retain(|&index| {
                        let point = &points[index as usize];
                        let is_near = (0..3).all(|k| (around[0][k]..=around[1][k]).contains(&point[k]));
                        let is_reached = is_near && moves[*number as usize].reaches(point, *parts);
                        if is_reached {
                            removed.push((index, *number));
                        }
                        !is_reached
                    });
                }
            }
        }
        removed
    });
    let mut found = vec![None; points.len()];
    for (index, number) in removed.collect::<Vec<_>>().into_iter().flatten() {
        found[index as usize] = Some(number);
    }
    found
}

/// The least distance of a point from the tool on all moves, m; above `most` it is not searched.
pub fn least_distance(moves: &[MovingTool], point: &Point3<f64>, most: f64) -> f64 {
    moves
        .iter()
        .fold(most, |least, of| of.least_distance(point, least))
}
