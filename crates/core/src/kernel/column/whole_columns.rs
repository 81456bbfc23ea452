//! Columns of arms with named branches by the whole model in lanes; poses that lanes cannot decide one after the other.

use super::one_by_one::{ArmMargins, OneByOne};
use super::postures::{Column, ColumnLoad, PostureStatus, SLOTS};
use crate::frame::Isometry;
use crate::kernel::lanes::{BranchMargins, BranchStatus, LoadedBranches, POINTS, PointLoads};
use crate::kernel::question::Question;
use crate::robot::Branch;

/// Fills blocks of poses; one per thread.
pub(super) struct WholeColumns {
    lanes: LoadedBranches,
    loads: PointLoads,
}

/// The arm, and what computes the poses that lanes cannot decide.
pub(super) struct WholeFill<'a, 'q> {
    pub margins: &'a ArmMargins<'q>,
    pub rest: &'a mut OneByOne<'q>,
}

impl WholeColumns {
    /// For this arm, with geometry and thermal growth only if `unloaded`; none if lanes do not know it.
    pub fn of(margins: &ArmMargins<'_>, unloaded: bool) -> Option<WholeColumns> {
        let question = Question::unloaded(margins.arm, margins.home);
        let kept = BranchMargins {
            wrist: margins.wrist,
            limits: margins.margin,
        };
        Some(WholeColumns {
            lanes: LoadedBranches::of(&question, kept, unloaded)?,
            loads: PointLoads::new(),
        })
    }

    /// Moves the rail, if there is one, to its positions in `home`, rad (m).
    pub fn set_home(&mut self, home: Option<&[f64]>) {
        self.lanes.set_home(home);
    }

    /// Fills `out`, which is clear.
    pub fn fill(
        &mut self,
        poses: &[Isometry],
        push: &ColumnLoad<'_>,
        with: WholeFill<'_, '_>,
        out: &mut Column,
    ) {
        let WholeFill { margins, rest } = with;
        let joint_count = margins.arm.robot.joints().len();
        for i in 0..poses.len().min(POINTS) {
            self.loads.set(i, push.cases.iter().copied(), &push.along);
        }
        for (block, poses) in poses.chunks(POINTS).enumerate() {
            let mut undecided = [false; POINTS];
            self.lanes.aim_at(poses, &self.loads);
            for (slot, branch) in Branch::ALL.into_iter().enumerate() {
                self.lanes.solve(branch, &self.loads);
                for (i, undecided) in undecided.iter_mut().enumerate().take(poses.len()) {
                    let at = (block * POINTS + i) * SLOTS + slot;
                    let status = match self.lanes.status(i) {
                        BranchStatus::Usable => PostureStatus::Usable,
                        BranchStatus::OutsideLimits => PostureStatus::OutsideLimits,
                        BranchStatus::Singular => PostureStatus::Singular,
                        BranchStatus::OutOfReach => continue,
                        BranchStatus::Undecided => {
                            *undecided = true;
                            continue;
                        }
                    };
                    out.statuses[at] = status;
                    if status == PostureStatus::Usable {
                        out.deviations[at] = self.lanes.deviation(i);
                    }
                    let joints = &mut out.joints[at * joint_count..][..joint_count];
                    for (joint, position) in joints.iter_mut().zip(self.lanes.joints(i)) {
                        *joint = position;
                    }
                }
            }
            for (i, pose) in poses.iter().enumerate().filter(|(i, _)| undecided[*i]) {
                let mut slots = out.slots_of(block * POINTS + i, joint_count);
                slots.clear();
                rest.pose(margins, pose, push, slots);
            }
        }
    }
}
