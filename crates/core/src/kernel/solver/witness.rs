//! Lanes against the plain row of `predict.rs`: random poses of eight arms, the best of all postures, four load cases.
//!
//! At the joint positions that lanes find, the plain row gives the deviation of every case, the envelope, the shares and
//! the uncertainty. Differences are relative to the largest deviation of the point. A point that lanes cannot decide is
//! handed over to the general solver: how many are, and how many of these are near a singularity. `cargo xtask bench
//! --witness` runs the long test.

use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use super::super::tests::{analysis, joints};
use super::*;
use crate::arms;
use crate::kernel::Answers;
use crate::load::InputUncertainty;
use crate::robot::inverse::posture_at;
use crate::robot::{Attachment, Backlash, BacklashSide, JointCompliance, Mass, Spring};
use crate::source::StiffnessModel;
use crate::source::stiffness_model::Gravity;

/// Poses of the long test.
const MANY: usize = 1_000_000;
/// Poses that one thread takes at once.
const TOGETHER: usize = 100 * BLOCK;
/// Largest difference, relative.
const ALLOWED: f64 = 1e-12;
/// The same at poses that are flagged as near a singularity: there a rounding of the pose is multiplied.
const ALLOWED_SINGULAR: f64 = 1e-10;

/// What was compared.
#[derive(Default)]
struct Comparison {
    points: usize,
    handed_over: usize,
    /// Of these.
    singular: usize,
    /// Of the points that lanes decide: those not flagged as near a singularity, and those flagged.
    largest: [f64; 2],
}

impl Comparison {
    fn and(self, other: Comparison) -> Comparison {
        Comparison {
            points: self.points + other.points,
            handed_over: self.handed_over + other.handed_over,
            singular: self.singular + other.singular,
            largest: std::array::from_fn(|i| self.largest[i].max(other.largest[i])),
        }
    }
}

/// Three ortho-parallel arms, one of them also 1 um and two 3 mm off; two with three parallel axes, one of them 1 mm
/// off.
fn eight_arms() -> [(&'static str, Robot); 8] {
    let off = arms::other::calibrated;
    [
        ("yaskawa/mh12", arms::mh12()),
        ("kuka/kr120r2500pro", arms::kr120()),
        ("staubli/tx2-90", arms::tx2_90()),
        ("yaskawa/mh12, 1 um off", off(&arms::mh12(), 1e-6)),
        ("yaskawa/mh12, 3 mm off", off(&arms::mh12(), 3e-3)),
        ("kuka/kr120r2500pro, 3 mm off", off(&arms::kr120(), 3e-3)),
        ("ur/ur10", arms::other::ur10()),
        ("ur/ur10e, 1 mm off", off(&arms::other::ur10e(), 1e-3)),
    ]
}

/// The drives alone; two bending springs at each joint, masses and gravity; backlash on the side of the torque as well.
fn models() -> [(&'static str, StiffnessModel); 3] {
    let bending = JointCompliance {
        value: 3e-7,
        standard_uncertainty: 3e-8,
    };
    let mut springs = StiffnessModel::DRIVES.clone();
    springs.structure.springs = (0..6)
        .flat_map(|joint| {
            [Vector3::x(), Vector3::y()].map(|axis| Spring::about(Attachment::Joint(joint), axis, bending))
        })
        .collect();
    springs.structure.masses = [1, 2, 5]
        .map(|joint| Mass {
            attachment: Attachment::Joint(joint),
            mass: 25.0,
            centre: Point3::new(0.1, 0.02, 0.2),
            inertia: None,
            relative_uncertainty: 0.0,
        })
        .to_vec();
    springs.gravity = Some(Gravity {
        acceleration: Vector3::new(0.0, 0.0, -9.81),
        reference: vec![0.2; 6],
    });
    let mut backlash = springs.clone();
    let gap = Backlash {
        gap: 1e-4,
        standard_uncertainty: 1e-5,
        side: BacklashSide::Torque,
    };
    backlash.structure.backlash = vec![Some(gap); 6];
    [
        ("drives", StiffnessModel::DRIVES.clone()),
        ("18 springs, gravity", springs),
        ("18 springs, gravity, backlash", backlash),
    ]
}

/// Compares this many poses, blocks of them on all threads.
fn compared(robot: &Robot, model: &StiffnessModel, count: usize) -> Comparison {
    analysis(robot, model, BranchChoice::Best, |question| {
        let question = Question {
            uncertainty: InputUncertainty {
                relative: if model.is_drives_alone() { 0.0 } else { 0.1 },
                ..InputUncertainty::NONE
            },
            ..*question
        };
        let parts = (0..count).into_par_iter().step_by(TOGETHER);
        parts
            .map(|first| part(&question, first, TOGETHER.min(count - first)))
            .reduce(Comparison::default, Comparison::and)
    })
}

/// The comparison of poses `first` and following.
fn part(question: &Question<'_>, first: usize, count: usize) -> Comparison {
    let arm = question.arm;
    let mut stream = arms::Stream(1 + first as u64);
    let poses: Vec<Isometry> = (0..count)
        .map(|_| posture_at(arm.robot, &joints(&mut stream, arm.robot), arm.flange_from_tool).base_from_tool)
        .collect();
    let mut lanes = Lanes::of(question, Order::Any, AnswerDetail::Shares).expect("lanes know the arm");
    let mut general = General::new(question, AnswerDetail::Shares);
    let mut answers = Answers::new(question, count, AnswerDetail::Shares);
    let mut decided = Vec::with_capacity(count);
    for (poses, mut slots) in poses.chunks(BLOCK).zip(answers.blocks(BLOCK)) {
        lanes.solve(poses);
        decided.extend_from_slice(&lanes.write(&mut slots)[..poses.len()]);
    }
    let mut found = Comparison {
        points: count,
        ..Comparison::default()
    };
    let mut joints = vec![0.0; answers.joint_count];
    let mut deviations = vec![Vector3::zeros(); answers.case_count];
    let mut shares = vec![0.0; answers.share_count];
    for (i, pose) in poses.iter().enumerate() {
        let (Ok(lanes), true) = (answers.points[i], decided[i]) else {
            found.handed_over += 1;
            general.forget();
            let singular = general
                .answer(question, pose, None)
                .is_ok_and(|evaluation| evaluation.singularity.is_some());
            found.singular += usize::from(singular);
            continue;
        };
        let plain = general
            .answer_in(question, answers.joints_at(i))
            .expect("a posture that lanes find has an equilibrium");
        general.write(&mut joints, &mut deviations, &mut shares);
        let largest = &mut found.largest[usize::from(plain.singularity.is_some())];
        let mut close = |a: f64, b: f64| *largest = largest.max((a - b).abs() / plain.full);
        close(lanes.in_plane, plain.in_plane);
        close(lanes.full, plain.full);
        close(lanes.normal.abs(), plain.normal.abs());
        close(
            lanes.in_plane_uncertainty.unwrap_or(0.0),
            plain.in_plane_uncertainty.unwrap_or(0.0),
        );
        for (lanes, plain) in answers.shares_at(i).iter().zip(&shares) {
            close(*lanes, *plain);
        }
        for (lanes, plain) in answers.deviations_at(i).iter().zip(&deviations) {
            close((lanes - plain).norm(), 0.0);
        }
    }
    found
}

/// Fails where a difference is not allowed.
fn check(arm: &str, model: &str, found: &Comparison) {
    let [elsewhere, singular] = found.largest;
    assert!(elsewhere < ALLOWED, "{arm} {model}: {elsewhere:e}");
    assert!(
        singular < ALLOWED_SINGULAR,
        "{arm} {model}, near a singularity: {singular:e}"
    );
}

/// Rows for `cargo xtask bench --witness`: arm, model, points, largest difference away from singularities and near them,
/// points handed over, of these near a singularity.
#[test]
#[ignore = "takes minutes: cargo xtask bench --witness"]
#[allow(clippy::print_stdout)]
fn lanes_are_the_plain_row_on_a_million_poses() {
    for (arm, robot) in eight_arms() {
        for (name, model) in models() {
            let found = compared(&robot, &model, MANY);
            let [elsewhere, singular] = found.largest;
            println!(
                "witness\t{arm}\t{name}\t{}\t{elsewhere:.1e}\t{singular:.1e}\t{}\t{}",
                found.points, found.handed_over, found.singular
            );
            check(arm, name, &found);
        }
    }
}

#[test]
fn lanes_are_the_plain_row_on_a_few_poses() {
    for (arm, robot) in eight_arms() {
        for (name, model) in models() {
            let found = compared(&robot, &model, 10 * BLOCK);
            check(arm, name, &found);
            assert!(
                found.handed_over < found.points / 4,
                "{arm} {name}: {}",
                found.handed_over
            );
        }
    }
}
