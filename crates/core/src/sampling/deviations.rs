//! The deviation of the tool for samples of the uncertain inputs, at many joint positions and under several loads.

use nalgebra::Vector3;
use rayon::prelude::*;

use super::inputs::SampledArm;
use super::spring_sums::{SpringSums, TermSlots};
use crate::frame::Isometry;
use crate::kernel::{EvaluateError, evaluate_at_joints};
use crate::predict::deviation_of;
use crate::robot::Robot;
use crate::source::{ArmState, Links, Unstable};
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// Points with a load each that a thread evaluates together.
const PAIRS_AT_ONCE: usize = 256;

/// Samples of an arm, joint positions and loads.
#[derive(Clone, Copy, Debug)]
pub struct SampledDeviations<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// Flange to TCP.
    pub flange_from_tool: &'a Isometry,
    /// Its samples.
    pub samples: &'a [SampledArm],
    /// Joint positions, rad (m), point after point.
    pub joints: &'a [f64],
    /// Load cases (base, at the TCP): all of them at each point, or one for each point.
    pub cases: &'a [Wrench],
    /// Whether there is one load case for each point.
    pub paired: bool,
    /// Whether geometry, learnt residual, backlash and scatter are included; otherwise the deviation under the load alone.
    pub all_sources: bool,
}

impl SampledDeviations<'_> {
    /// Writes the displacements of the TCP (m, base) by sample, point, load case and axis.
    ///
    /// # Errors
    /// See [`EvaluateError`]; the point is that of the first sample with an unstable one.
    ///
    /// # Panics
    /// If `out` has another length than the result, or there are not as many load cases as points where they are paired.
    pub fn write(&self, out: &mut [f64], watch: Watch<'_>) -> Result<(), EvaluateError> {
        let Some(first) = self.samples.first() else {
            return Ok(());
        };
        let dof = self.robot.joints().len();
        let points = self.joints.len() / dof;
        let cases = if self.paired { 1 } else { self.cases.len() };
        let width = 3 * cases;
        assert_eq!(
            out.len(),
            self.samples.len() * points * width,
            "a vector for each sample, point and load"
        );
        assert!(
            !self.paired || self.cases.len() == points,
            "a load case for each point"
        );
        if out.is_empty() {
            return Ok(());
        }
        if !self.all_sources && SpringSums::applies(&first.model) {
            let samples: Vec<(Vec<f64>, f64)> = (self.samples.iter())
                .map(|sample| (sample.compliances(), 1.0 + sample.model_error))
                .collect();
            let sums = SpringSums {
                arm: first.arm(self.robot, self.flange_from_tool),
                joints: self.joints,
                samples: &samples,
                width,
            };
            sums.write(
                |arm_state, point, slots| elastic_terms(arm_state, self.loads_of(point), slots),
                out,
                watch,
            )?;
            return Ok(());
        }
        let each = out.par_chunks_mut(points * width).zip(self.samples);
        let failed = each
            .map(|(out, sample)| self.of_sample(sample, width, out, watch))
            .find_map_first(Result::err);
        failed.map_or(Ok(()), Err)
    }

    fn loads_of(&self, point: usize) -> &[Wrench] {
        match self.paired {
            true => &self.cases[point..=point],
            false => self.cases,
        }
    }

    /// All points of one sample.
    fn of_sample(
        &self,
        sample: &SampledArm,
        width: usize,
        out: &mut [f64],
        watch: Watch<'_>,
    ) -> Result<(), EvaluateError> {
        let arm = sample.arm(self.robot, self.flange_from_tool);
        let links = self.all_sources.then(|| sample.links());
        let write = |arm_state: &mut ArmState<'_>, cases: &[Wrench], out: &mut [f64]| {
            for (case, out) in cases.iter().zip(out.chunks_mut(3)) {
                let moved = displacement(arm_state, case, sample, links.as_deref())?;
                out.copy_from_slice(&moved);
            }
            Ok(())
        };
        if !self.paired {
            let at = |arm_state: &mut ArmState<'_>, out: &mut [f64]| write(arm_state, self.cases, out);
            return evaluate_at_joints(&arm, self.joints, out, at, watch);
        }
        let dof = arm.compliance.len();
        let blocks =
            (self.joints.par_chunks(PAIRS_AT_ONCE * dof)).zip(out.par_chunks_mut(PAIRS_AT_ONCE * width));
        let failed = blocks.enumerate().map_init(
            || ArmState::new(arm),
            |arm_state, (block, (joints, out))| {
                if watch.is_cancelled() {
                    return Err(Cancelled.into());
                }
                for (at, (q, out)) in joints.chunks(dof).zip(out.chunks_mut(width)).enumerate() {
                    let point = block * PAIRS_AT_ONCE + at;
                    arm_state.set_joints(q);
                    write(arm_state, self.loads_of(point), out)
                        .map_err(|why| EvaluateError::Unstable { point, why })?;
                }
                Ok(())
            },
        );
        failed.find_map_first(Result::err).map_or(Ok(()), Err)
    }
}

/// Displacement of the TCP; by the load alone without `links`.
fn displacement(
    arm_state: &mut ArmState<'_>,
    case: &Wrench,
    sample: &SampledArm,
    links: Option<&[f64]>,
) -> Result<[f64; 3], Unstable> {
    let Some(links) = links else {
        let moved = arm_state.elastic(case)?.linear * (1.0 + sample.model_error);
        return Ok(moved.into());
    };
    let all = deviation_of(arm_state, case, &mut Links::KeptByFriction(links))?.linear;
    let missed = (0..arm_state.screws().len()).map(|k| arm_state.part(k).linear * sample.model_error);
    Ok((all + missed.sum::<Vector3<f64>>() + sample.scatter).into())
}

/// The terms of the displacement under each load case.
pub fn elastic_terms(arm_state: &ArmState<'_>, cases: &[Wrench], mut slots: TermSlots<'_>) {
    for (k, screw) in arm_state.screws().iter().enumerate() {
        for (case, wrench) in cases.iter().enumerate() {
            let torque = screw.dot(wrench);
            for (axis, part) in screw.linear.iter().enumerate() {
                slots.set(k, 3 * case + axis, [*part, torque]);
            }
        }
    }
}

/// The terms of the compliance at the TCP, 6 x 6.
pub fn compliance_terms(arm_state: &ArmState<'_>, mut slots: TermSlots<'_>) {
    for (k, screw) in arm_state.screws().iter().enumerate() {
        let s = screw.to_vector();
        for (j, product) in (s * s.transpose()).iter().enumerate() {
            slots.set(k, j, [*product, 1.0]);
        }
    }
}

#[cfg(test)]
mod tests;
