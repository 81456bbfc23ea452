//! The kernel against the plain version in `predict.rs`, and against itself on every back end.
//!
//! `lanes`: each number of the lanes against the plain version; `same_bits`: back ends and counts of points against
//! each other; `whole_answers`: what `evaluate` and `evaluate_at_joints` give.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used)]

#[path = "../arms/mod.rs"]
mod arms;
mod lanes;
mod same_bits;
mod whole_answers;

use armill_core::frame::Isometry;
use armill_core::kernel::lanes::{Backend, Batch, Poses, Precision, flag};
use armill_core::kernel::{BranchChoice, Question};
use armill_core::load::InputUncertainty;
use armill_core::nalgebra::{Unit, Vector3};
use armill_core::robot::inverse::posture_at;
use armill_core::robot::{Posture, Robot};
use armill_core::source::{Arm, StiffnessModel};
use armill_core::spatial::Wrench;

use arms::Stream;

/// How far (rad) outside their limits joints may be: 20 deg.
const BEYOND: f64 = 0.35;

/// Three cases, one with a moment; five where many are needed.
fn cases(count: usize) -> Vec<Wrench> {
    let mut all = vec![
        Wrench::from_force(Vector3::new(3.0, -5.0, 5.0)),
        Wrench {
            force: Vector3::new(-20.0, 4.0, 1.0),
            moment: Vector3::new(0.4, -1.5, 2.0),
        },
        Wrench::from_force(Vector3::new(1.0, 8.0, -30.0)),
        Wrench::from_force(Vector3::new(1.0, 2.0, 3.0)),
        Wrench::from_force(Vector3::new(25.0, -25.0, 10.0)),
    ];
    all.truncate(count);
    all
}

/// Answers `question` with a bent tool and an oblique plane.
fn analysis<T>(
    robot: &Robot,
    cases: &[Wrench],
    choice: BranchChoice,
    then: impl FnOnce(&Question<'_>) -> T,
) -> T {
    let tool = arms::bent_tool();
    then(&Question {
        homes: None,
        arm: Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model: StiffnessModel::DRIVES,
            flange_from_tool: &tool,
        },
        uncertainty: InputUncertainty::NONE,
        home: None,
        cases,
        normal: Unit::new_normalize(Vector3::new(-0.8, 0.3, 0.5)),
        choice,
        clearance: None,
    })
}

/// Lanes for the arm of `question`.
fn batch<T: Precision>(question: &Question<'_>, backend: Backend) -> Batch<T> {
    Batch::new(question, question.arm.robot.ortho_parallel().unwrap(), backend)
}

/// Random postures of `robot`.
fn some(robot: &Robot, count: usize) -> Vec<Posture> {
    let mut stream = Stream(7);
    (0..count)
        .map(|_| posture_at(robot, &stream.joints_beyond(robot, BEYOND), &arms::bent_tool()))
        .collect()
}

/// Poses of postures, an array a number.
struct Soa<T>([Vec<T>; 12]);

impl<T: Precision> Soa<T> {
    fn of<'a>(poses: impl Iterator<Item = &'a Isometry>) -> Soa<T> {
        let mut arrays: [Vec<T>; 12] = std::array::from_fn(|_| Vec::new());
        for pose in poses {
            let rotation = pose.rotation.to_rotation_matrix().matrix().transpose();
            let numbers = rotation.iter().chain(pose.translation.vector.iter());
            for (array, value) in arrays.iter_mut().zip(numbers) {
                array.push(T::from_f64(*value));
            }
        }
        Soa(arrays)
    }

    fn poses(&self) -> Poses<'_, T> {
        Poses::Free {
            rotations: std::array::from_fn(|k| &self.0[k][..]),
            at: std::array::from_fn(|k| &self.0[9 + k][..]),
        }
    }
}

/// Tool poses of these postures.
fn poses_of<T: Precision>(postures: &[Posture]) -> Soa<T> {
    Soa::of(postures.iter().map(|posture| &posture.base_from_tool))
}

/// Near any singularity.
const NEAR_SINGULAR: u32 = flag::NEAR_WRIST | flag::NEAR_ELBOW | flag::NEAR_SHOULDER;
