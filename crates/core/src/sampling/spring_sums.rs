//! Results that are sums over drives and springs, at many joint positions for many samples of the compliances.
//!
//! ```text
//! y_j = f sum_k A_kj (c_k B_kj)
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `y_j` | value `j` of a point, such as the displacement of the tool along an axis under a load case |
//! | `A_kj`, `B_kj` | terms of drive or spring `k`, such as its screw along the axis, and the torque of the load case on it |
//! | `c_k` | its compliance in the sample, rad/(N m), m/N |
//! | `f` | factor of the sample: 1 and its model error |
//!
//! The terms depend on the joint positions alone: they are calculated once for all samples, for blocks of points that stay in the cache.
//! Valid for arms without torque curves, compensator and load-dependent equilibrium ([`SpringSums::applies`]).

use rayon::prelude::*;

use crate::source::{Arm, ArmState, StiffnessModel};
use crate::watch::{Cancelled, Watch};

/// Values of a block of points, about: its terms stay in the cache of a core.
const VALUES_AT_ONCE: usize = 1536;
/// Blocks whose terms are calculated together.
const BLOCKS_AT_ONCE: usize = 32;

/// An arm, joint positions, and samples.
#[derive(Clone, Copy, Debug)]
pub struct SpringSums<'a> {
    /// Its compliances are not used.
    pub arm: Arm<'a>,
    /// Joint positions, rad (m), point after point.
    pub joints: &'a [f64],
    /// Compliances of all drives, then of all springs, of each sample: rad/(N m), m/N; and the factor of the sample.
    pub samples: &'a [(Vec<f64>, f64)],
    /// Number of values of a point.
    pub width: usize,
}

/// Where the terms of one point are written.
#[derive(Debug)]
pub struct TermSlots<'b> {
    first: &'b mut [f64],
    second: &'b mut [f64],
    /// Values of the block, and the first of this point.
    stride: usize,
    at: usize,
}

impl TermSlots<'_> {
    /// Writes the terms `A` and `B` of drive or spring `k` for value `j`.
    pub fn set(&mut self, k: usize, j: usize, terms: [f64; 2]) {
        let slot = k * self.stride + self.at + j;
        [self.first[slot], self.second[slot]] = terms;
    }
}

/// The terms of a block of points, drive after drive.
struct Terms {
    first: Vec<f64>,
    second: Vec<f64>,
    values: usize,
}

impl SpringSums<'_> {
    /// Whether the deflection of every drive and spring of this model is proportional to its torque, in every posture by the same compliance.
    pub fn applies(model: &StiffnessModel) -> bool {
        model.is_affine() && model.structure.compensator.is_none()
    }

    /// Writes the values of all points of the first sample into `out`, then of the next; `terms` writes the terms of a point, by its index.
    ///
    /// # Errors
    /// [`Cancelled`] if the watch cancels.
    ///
    /// # Panics
    /// If `out` has another length.
    pub fn write(
        &self,
        terms: impl Fn(&ArmState<'_>, usize, TermSlots<'_>) + Sync,
        out: &mut [f64],
        watch: Watch<'_>,
    ) -> Result<(), Cancelled> {
        let dof = self.arm.robot.joints().len();
        let stretch = self.joints.len() / dof * self.width;
        assert_eq!(
            out.len(),
            stretch * self.samples.len(),
            "a value for each sample and point"
        );
        if out.is_empty() {
            return Ok(());
        }
        let springs = dof + self.arm.model.structure.springs.len();
        let points_at_once = (VALUES_AT_ONCE / self.width).max(1);
        let block = |arm_state: &mut ArmState<'_>, (number, joints): (usize, &[f64])| {
            let values = joints.len() / dof * self.width;
            let mut found = Terms {
                first: vec![0.0; springs * values],
                second: vec![0.0; springs * values],
                values,
            };
            for (point, q) in joints.chunks(dof).enumerate() {
                arm_state.set_joints(q);
                let slots = TermSlots {
                    first: &mut found.first,
                    second: &mut found.second,
                    stride: values,
                    at: point * self.width,
                };
                terms(arm_state, number * points_at_once + point, slots);
            }
            found
        };
        let blocks = self.joints.chunks(points_at_once * dof).enumerate();
        let blocks: Vec<(usize, &[f64])> = blocks.collect();
        let mut begin = 0;
        for group in blocks.chunks(BLOCKS_AT_ONCE) {
            if watch.is_cancelled() {
                return Err(Cancelled);
            }
            let found: Vec<Terms> = group
                .par_iter()
                .map_init(
                    || ArmState::new(self.arm),
                    |arm_state, block_of| block(arm_state, *block_of),
                )
                .collect();
            let values: usize = found.iter().map(|terms| terms.values).sum();
            let samples = out.par_chunks_mut(stretch).zip(self.samples);
            samples.for_each(|(out, (compliances, factor))| {
                if watch.is_cancelled() {
                    return;
                }
                let mut rest = &mut out[begin..begin + values];
                for terms in &found {
                    let (here, after) = rest.split_at_mut(terms.values);
                    terms.sum(compliances, *factor, here);
                    rest = after;
                }
            });
            begin += values;
            (watch.finished)(values / self.width * self.samples.len());
        }
        match watch.is_cancelled() {
            true => Err(Cancelled),
            false => Ok(()),
        }
    }
}

impl Terms {
    /// Writes the sums over all drives and springs.
    fn sum(&self, compliances: &[f64], factor: f64, out: &mut [f64]) {
        out.fill(0.0);
        let both = self
            .first
            .chunks(self.values)
            .zip(self.second.chunks(self.values));
        for ((first, second), c) in both.zip(compliances) {
            for ((out, a), b) in out.iter_mut().zip(first).zip(second) {
                *out += a * (c * b);
            }
        }
        if factor != 1.0 {
            for out in out.iter_mut() {
                *out *= factor;
            }
        }
    }
}

#[cfg(test)]
mod tests;
