//! What moves the tool along a path beside its load: backlash and geometry.
//!
//! Links are dragged through their gaps from point to point; on every cut each begins on the flank that its first move
//! pushes, as after a run-in. Where a torque holds a flank, that of the load and gravity at the point decides.

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::kernel::Answers;
use crate::load::PathLoad;
use crate::path::Track;
use crate::predict::geometry_and_backlash;
use crate::source::{Arm, ArmState, backlash};
use crate::spatial::Wrench;

/// What moved the tool beside the load, and where links lay.
#[derive(Clone, Debug, Default)]
pub struct Unloaded {
    /// Where friction dragged each link to in its gap: link minus motor, chain's counting, rad (m), one a joint and point.
    pub dragged: Vec<f64>,
    /// Displacement of the tool (m, base) under each load case, one a case and point; zeros where it is not held.
    pub moved: Vec<Vector3<f64>>,
}

/// Moves the tool along `track` by what is beside its load; `None` where that is nothing.
pub(super) fn move_unloaded(
    arm: &Arm<'_>,
    (track, load): (&Track, &PathLoad),
    answers: &mut Answers,
) -> Option<Unloaded> {
    arm.model.moves_unloaded().then(|| {
        let dragged = drag(arm, track, answers);
        let (joints, cases) = (answers.joint_count, answers.case_count);
        let mut moved = vec![Vector3::zeros(); answers.deviations.len()];
        let make = || (ArmState::new(*arm), vec![Wrench::ZERO; cases]);
        moved
            .par_chunks_mut(cases)
            .enumerate()
            .filter(|(index, _)| answers.points[*index].is_ok())
            .for_each_init(make, |(arm_state, wrenches), (index, moved)| {
                arm_state.set_joints(answers.joints_at(index));
                track.wrenches(load, index, wrenches);
                let dragged = &dragged[index * joints..][..joints];
                for (moved, wrench) in moved.iter_mut().zip(wrenches.iter()) {
                    *moved = geometry_and_backlash(arm_state, dragged, wrench).linear;
                }
            });
        for index in 0..answers.points.len() {
            answers.move_on(index, &moved[index * cases..][..cases], track.stop(index).normal);
        }
        Unloaded { dragged, moved }
    })
}

/// Where friction drags each link to at each point.
fn drag(arm: &Arm<'_>, track: &Track, answers: &Answers) -> Vec<f64> {
    let joints = answers.joint_count;
    let mut placements = vec![0.0; answers.points.len() * joints];
    let theta = |index: usize, joint: usize| arm.robot.theta(joint, answers.joints_at(index));
    for stretch in track.path.stretches() {
        let evaluation: Vec<usize> = stretch.filter(|index| answers.points[*index].is_ok()).collect();
        for (joint, gap) in arm.model.structure.gaps() {
            let moves = evaluation
                .windows(2)
                .map(|pair| theta(pair[1], joint) - theta(pair[0], joint));
            let links = backlash::along([0.0].into_iter().chain(moves), gap.gap);
            for (index, link) in evaluation.iter().zip(links) {
                placements[index * joints + joint] = link;
            }
        }
    }
    placements
}

impl Unloaded {
    /// Where each link was dragged to at point `index`, of so many joints.
    pub fn dragged_at(&self, index: usize, joints: usize) -> &[f64] {
        &self.dragged[index * joints..][..joints]
    }
}

#[cfg(test)]
mod tests;
