//! Effect of backlash and geometry on the tool along a path, in addition to the load.
//!
//! Friction moves the links within the backlash from point to point. At the start of every cut each link is on the side
//! given by its first motion, as after a run-in. Where a torque determines the side, the load and gravity at the point
//! decide.

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::kernel::Answers;
use crate::path::{LoadedTrack, Track};
use crate::predict::unloaded;
use crate::source::{Arm, ArmState, backlash};
use crate::spatial::Wrench;

/// Effect of backlash and geometry, with the link offsets.
#[derive(Clone, Debug, Default)]
pub struct BacklashGeometry {
    /// Offset of each link in its backlash, as kept there by friction: link minus motor, in chain coordinates, rad (m),
    /// one per joint and point.
    pub link_offsets: Vec<f64>,
    /// Displacement of the tool (m, base) under each load case, one per case and point; zeros at unreachable points.
    pub displacements: Vec<Vector3<f64>>,
}

/// Adds backlash and geometry to the answers along `path`; `None` if the model has neither.
pub(super) fn add_backlash_and_geometry(
    arm: &Arm<'_>,
    path: LoadedTrack<'_>,
    answers: &mut Answers,
) -> Option<BacklashGeometry> {
    let LoadedTrack { track, load } = path;
    arm.model.has_unloaded_deviation().then(|| {
        let link_offsets = friction_offsets(arm, track, answers);
        let (joints, cases) = (answers.joint_count, answers.case_count);
        let mut displacements = vec![Vector3::zeros(); answers.deviations.len()];
        let make = || (ArmState::new(*arm), vec![Wrench::ZERO; cases]);
        displacements
            .par_chunks_mut(cases)
            .enumerate()
            .filter(|(index, _)| answers.points[*index].is_ok())
            .for_each_init(make, |(arm_state, wrenches), (index, moved)| {
                arm_state.set_joints(answers.joints_at(index));
                track.wrenches(load, index, wrenches);
                let link_offsets = &link_offsets[index * joints..][..joints];
                for (moved, wrench) in moved.iter_mut().zip(wrenches.iter()) {
                    *moved = unloaded(arm_state, link_offsets, wrench).linear;
                }
            });
        for index in 0..answers.points.len() {
            answers.add_displacement(
                index,
                &displacements[index * cases..][..cases],
                track.stop(index).normal,
            );
        }
        BacklashGeometry {
            link_offsets,
            displacements,
        }
    })
}

/// Offset of each link due to friction, at each point.
fn friction_offsets(arm: &Arm<'_>, track: &Track, answers: &Answers) -> Vec<f64> {
    let joints = answers.joint_count;
    let mut offsets = vec![0.0; answers.points.len() * joints];
    let theta = |index: usize, joint: usize| arm.robot.theta(joint, answers.joints_at(index));
    for stretch in track.path.stretches() {
        let reached: Vec<usize> = stretch.filter(|index| answers.points[*index].is_ok()).collect();
        for (joint, gap) in arm.model.structure.joints_with_backlash() {
            let moves = reached
                .windows(2)
                .map(|pair| theta(pair[1], joint) - theta(pair[0], joint));
            let links = backlash::along([0.0].into_iter().chain(moves), gap.gap);
            for (index, link) in reached.iter().zip(links) {
                offsets[index * joints + joint] = link;
            }
        }
    }
    offsets
}

impl BacklashGeometry {
    /// Offset of each link at point `index`, for this number of joints.
    pub fn link_offsets_at(&self, index: usize, joints: usize) -> &[f64] {
        &self.link_offsets[index * joints..][..joints]
    }
}

#[cfg(test)]
mod tests;
