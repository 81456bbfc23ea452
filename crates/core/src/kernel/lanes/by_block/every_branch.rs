//! Every named branch of a block of poses, each verified by forward kinematics.

use crate::frame::Isometry;
use crate::kernel::answer::AT_LIMIT;
use crate::kernel::lanes::branches::{BranchPlanes, BranchSolver, find_missed, state};
use crate::kernel::lanes::whole::{ChainConstants, FindFlange, FramePlanes};
use crate::kernel::question::Question;
use crate::numbers::{BLOCK, Backend, Plane};
use crate::robot::Branch;

/// Solves a block of flange poses; one per thread.
pub(in crate::kernel) struct EveryBranch {
    backend: Backend,
    solver: BranchSolver,
    chain: ChainConstants,
    /// The flange that the joint positions give, and memory for the frame before it.
    flange: Box<[FramePlanes<f64>; 2]>,
    missed: Plane<f64>,
    /// In the order of [`Branch::ALL`].
    found: Vec<BranchPlanes>,
}

impl EveryBranch {
    /// For the robot of `question`, whose tool is the flange; none if its branches have no names.
    pub fn of(question: &Question<'_>) -> Option<EveryBranch> {
        let backend = Backend::fastest();
        let robot = question.arm.robot;
        let joints = robot.joints().len();
        Some(EveryBranch {
            backend,
            solver: BranchSolver::of(question, backend)?,
            chain: ChainConstants::of(robot),
            flange: Box::new([FramePlanes::unknown(), FramePlanes::unknown()]),
            missed: [0.0; BLOCK],
            found: vec![BranchPlanes::of(joints); Branch::ALL.len()],
        })
    }

    /// Solves these flange poses, at most a block.
    pub fn solve(&mut self, poses: &[Isometry]) {
        self.solver.aim_at(poses, &Isometry::identity());
        for (branch, kept) in Branch::ALL.into_iter().zip(&mut self.found) {
            let found = self.solver.solve(branch);
            let [flange, before] = &mut *self.flange;
            self.backend.run(FindFlange {
                chain: &self.chain,
                joints: &found.joints,
                flange,
                before,
            });
            kept.copy_from(found);
            self.backend
                .run(find_missed(self.solver.targets(), flange, &mut self.missed));
            for (state, missed) in kept.state.iter_mut().zip(&self.missed) {
                if *state == state::REACHED && *missed != 0.0 {
                    *state = state::UNDECIDED;
                }
            }
        }
    }

    /// Whether lanes decide every branch of point `index`, and at least one reaches the pose.
    pub fn decides(&self, index: usize) -> bool {
        let mut states = self.found.iter().map(|found| found.state[index]);
        let reached = states.clone().any(|state| state == state::REACHED);
        reached && states.all(|state| state != state::UNDECIDED)
    }

    /// Gives `visit` the branches that reach pose `index`, and whether their joints are inside their limits; appends
    /// their joint positions (rad) to `joints`.
    pub fn take(&self, index: usize, joints: &mut Vec<f64>, mut visit: impl FnMut(Branch, bool)) {
        for (branch, found) in Branch::ALL.into_iter().zip(&self.found) {
            if found.state[index] == state::REACHED {
                joints.extend(found.joints.iter().map(|plane| plane[index]));
                let inside = found.margin[index] >= -AT_LIMIT && self.solver.rail_is_inside();
                visit(branch, inside);
            }
        }
    }
}
