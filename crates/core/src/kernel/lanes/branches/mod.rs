//! The named branches of arms that are not exactly ortho-parallel, in lanes: three parallel axes, calibrated arms; and
//! exact ortho-parallel ones for models with more than the drives.
//!
//! A closed form gives the chain positions of one branch of a block of poses. Of a calibrated arm they are starting
//! values: Newton's iteration on its own chain follows. Names and singularities come from the chain positions, joint
//! positions and margins from the conventions of the joints. Solutions are verified by forward kinematics by those who
//! use them, with the frames that they need anyway.
//!
//! In reading order: `found` (a solved branch), `target` (requested flange poses), `ortho_parallel` and `three_parallel`
//! (closed forms), `newton`, `name`, `position` (joint positions and margins). [`BranchSolver`] runs them.

mod found;
mod name;
mod newton;
mod ortho_parallel;
mod position;
mod target;
mod three_parallel;

use crate::frame::Isometry;
use crate::kernel::lanes::whole::FramePlanes;
use crate::kernel::question::Question;
use crate::numbers::{BLOCK, Backend, Plane};
use crate::robot::inverse::{ClosedForm, Inverse};
use crate::robot::{Branch, Robot};
use name::{CheckNames, NameConstants};
use newton::Newton;
use ortho_parallel::OrthoParallelBlock;
use position::{JointRows, TakePositions};
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
    targets: Box<FramePlanes<f64>>,
    theta: Vec<Plane<f64>>,
    found: BranchPlanes,
}

#[derive(Clone, Debug)]
enum Form {
    OrthoParallel(Box<OrthoParallelBlock>),
    ThreeParallel(Box<ThreeParallelBlock>),
}

impl BranchSolver {
    /// For the robot of `question`; none if its branches have no names, or if it is on a rail.
    pub fn of(question: &Question<'_>, backend: Backend) -> Option<BranchSolver> {
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
            targets: Box::new(FramePlanes::unknown()),
            theta: vec![[0.0; BLOCK]; robot.joints().len()],
            found: BranchPlanes::of(robot.joints().len()),
        })
    }

    /// Sets the poses, at most a block; the remaining lanes repeat the last.
    pub fn aim_at(&mut self, poses: &[Isometry], tool_from_flange: &Isometry) {
        set_targets(poses, tool_from_flange, &mut self.targets);
        match &mut self.form {
            Form::OrthoParallel(form) => form.aim_at(poses),
            Form::ThreeParallel(form) => form.aim_at(&self.targets, self.backend),
        }
    }

    /// The requested flange poses.
    pub fn targets(&self) -> &FramePlanes<f64> {
        &self.targets
    }

    /// Solves this branch at every pose.
    pub fn solve(&mut self, branch: Branch) -> &BranchPlanes {
        let BranchSolver {
            backend,
            form,
            names,
            newton,
            rows,
            targets,
            theta,
            found,
        } = self;
        match form {
            Form::OrthoParallel(form) if newton.is_none() => {
                form.solve(branch);
                form.copy_to(branch, found);
                return found;
            }
            Form::OrthoParallel(form) => {
                form.solve(branch);
                form.start(branch, theta, &mut found.state);
            }
            Form::ThreeParallel(form) => form.solve(branch, *backend, theta, &mut found.state),
        }
        if let Some(newton) = newton {
            newton.reach(*backend, targets, theta, &mut found.state);
        }
        backend.run(CheckNames {
            names,
            branch: newton.is_some().then_some(branch),
            theta,
            state: &mut found.state,
            singularity: &mut found.singularity,
        });
        backend.run(TakePositions { rows, theta, found });
        found
    }
}
