//! The named branches of arms that are not exactly ortho-parallel, in lanes: three parallel axes, calibrated arms; and
//! exact ortho-parallel ones for models with more than the drives; each also on a rail.
//!
//! A closed form gives the chain positions of one branch of a block of poses. Of a calibrated arm they are starting
//! values: Newton's iteration on its own chain follows. Names and singularities come from the chain positions, joint
//! positions and margins from the conventions of the joints. Solutions are verified by forward kinematics by those who
//! use them, with the frames that they need anyway.
//!
//! In reading order: `found` (a solved branch), `target` (requested flange poses), `ortho_parallel` and `three_parallel`
//! (closed forms), `newton`, `name`, `position` (joint positions and margins), `rail`. [`BranchSolver`] runs them.

mod found;
mod name;
mod newton;
mod ortho_parallel;
mod position;
mod rail;
mod target;
mod three_parallel;

use crate::frame::Isometry;
use crate::kernel::lanes::whole::FramePlanes;
use crate::kernel::question::Question;
use crate::numbers::{BLOCK, Backend, Plane};
use crate::robot::inverse::{ClosedForm, Inverse};
use crate::robot::{Branch, Robot};
use crate::source::Arm;
use name::{CheckNames, NameConstants};
use newton::Newton;
use ortho_parallel::OrthoParallelBlock;
use position::{JointRows, TakePositions};
use rail::{RailBlock, arm_on};
use target::set_targets;
use three_parallel::ThreeParallelBlock;

pub(in crate::kernel::lanes) use found::{BranchPlanes, singularity, state};
pub(in crate::kernel::lanes) use target::find_missed;

/// Solves one branch after the other of a block of poses; one per thread.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct BranchSolver {
    backend: Backend,
    form: Form,
    names: NameConstants,
    /// Of a calibrated arm.
    newton: Option<Box<Newton>>,
    rows: JointRows,
    /// What carries the arm.
    rail: Option<Box<RailBlock>>,
    /// The requested flange poses in base, and as seen from an arm on a rail.
    targets: Box<FramePlanes<f64>>,
    seen: Option<Box<FramePlanes<f64>>>,
    /// Memory for tool poses as seen from an arm on a rail.
    poses: Vec<Isometry>,
    theta: Vec<Plane<f64>>,
    found: BranchPlanes,
}

#[derive(Clone, Debug)]
enum Form {
    OrthoParallel(Box<OrthoParallelBlock>),
    ThreeParallel(Box<ThreeParallelBlock>),
}

impl BranchSolver {
    /// For the robot of `question`; none if its branches have no names, or depend on the position of its rail.
    pub fn of(question: &Question<'_>, backend: Backend) -> Option<BranchSolver> {
        let robot = question.arm.robot;
        let Inverse::OnRail(rail) = robot.inverse() else {
            return BranchSolver::of_arm(question, backend);
        };
        let question = Question {
            arm: Arm {
                robot: &arm_on(rail, robot)?,
                ..question.arm
            },
            ..*question
        };
        let mut solver = BranchSolver::of_arm(&question, backend)?;
        solver.seen = Some(Box::new(FramePlanes::unknown()));
        solver.found = BranchPlanes::of(robot.joints().len());
        solver.rail = Some(Box::new(RailBlock::of(robot, rail, question.home)));
        solver.put_rail();
        Some(solver)
    }

    /// For an arm without a rail.
    fn of_arm(question: &Question<'_>, backend: Backend) -> Option<BranchSolver> {
        let robot: &Robot = question.arm.robot;
        let (form, exact) = match robot.inverse() {
            Inverse::Closed(form) => (form, true),
            Inverse::Polished(form) => (form, false),
            _ => return None,
        };
        Some(BranchSolver {
            backend,
            names: NameConstants::of(form),
            form: match form {
                ClosedForm::OrthoParallel(arm) => {
                    Form::OrthoParallel(Box::new(OrthoParallelBlock::new(question, arm, backend)))
                }
                ClosedForm::ThreeParallel(arm) => Form::ThreeParallel(Box::new(ThreeParallelBlock::new(arm))),
            },
            newton: (!exact).then(|| Box::new(Newton::of(robot.chain()))),
            rows: JointRows::of(robot),
            rail: None,
            targets: Box::new(FramePlanes::unknown()),
            seen: None,
            poses: Vec::new(),
            theta: vec![[0.0; BLOCK]; robot.joints().len()],
            found: BranchPlanes::of(robot.joints().len()),
        })
    }

    /// Moves the rail, if there is one, to its positions in `home`, rad (m); without that to the middle of its range.
    pub fn set_home(&mut self, home: Option<&[f64]>) {
        if let Some(rail) = &mut self.rail {
            rail.set_home(home);
            self.put_rail();
        }
    }

    fn put_rail(&mut self) {
        let positions = self.rail.iter().flat_map(|rail| &rail.positions);
        for (plane, position) in self.found.joints.iter_mut().zip(positions) {
            plane.fill(*position);
        }
    }

    /// Number of joints of the rail.
    pub fn first(&self) -> usize {
        self.rail.as_ref().map_or(0, |rail| rail.positions.len())
    }

    /// The joint of the rail that is nearest to a limit, and its distance, m; branches do not contain it.
    pub fn rail_margin(&self) -> Option<(usize, f64)> {
        self.rail.as_ref()?.margin
    }

    /// Whether the rail, if there is one, is inside its range.
    pub fn rail_is_inside(&self) -> bool {
        self.rail.as_ref().is_none_or(|rail| rail.is_inside())
    }

    /// Sets the poses, at most a block; the remaining lanes repeat the last.
    pub fn aim_at(&mut self, poses: &[Isometry], tool_from_flange: &Isometry) {
        set_targets(poses, tool_from_flange, &mut self.targets);
        let (poses, targets) = match (&self.rail, &mut self.seen) {
            (Some(rail), Some(seen)) => {
                self.poses.clear();
                self.poses
                    .extend(poses.iter().map(|pose| rail.arm_from_base * pose));
                set_targets(&self.poses, tool_from_flange, seen);
                (&*self.poses, &*seen)
            }
            _ => (poses, &self.targets),
        };
        match &mut self.form {
            Form::OrthoParallel(form) => form.aim_at(poses),
            Form::ThreeParallel(form) => form.aim_at(targets, self.backend),
        }
    }

    /// The requested flange poses, base.
    pub fn targets(&self) -> &FramePlanes<f64> {
        &self.targets
    }

    /// Solves this branch at every pose.
    pub fn solve(&mut self, branch: Branch) -> &BranchPlanes {
        let first = self.first();
        let BranchSolver {
            backend,
            form,
            names,
            newton,
            rows,
            targets,
            seen,
            theta,
            found,
            ..
        } = self;
        match form {
            Form::OrthoParallel(form) if newton.is_none() => {
                form.solve(branch);
                form.copy_to(branch, first, found);
                return found;
            }
            Form::OrthoParallel(form) => {
                form.solve(branch);
                form.start(branch, theta, &mut found.state);
            }
            Form::ThreeParallel(form) => {
                let filled = [&mut found.state, &mut found.singularity];
                form.solve(branch, *backend, theta, filled);
            }
        }
        if let Some(newton) = newton {
            let targets = seen.as_ref().unwrap_or(targets);
            newton.reach(*backend, targets, theta, &mut found.state);
            backend.run(CheckNames {
                names,
                branch,
                theta,
                state: &mut found.state,
                singularity: &mut found.singularity,
            });
        }
        backend.run(TakePositions {
            rows,
            theta,
            first,
            found,
        });
        found
    }
}
