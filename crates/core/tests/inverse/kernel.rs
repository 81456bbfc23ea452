//! Each kind of inverse in the kernel: the same results as `predict`, the best branch, no jumps along a path.

use armill_core::frame::Isometry;
use armill_core::kernel::{Answers, BranchChoice, Question, evaluate, evaluate_in_order};
use armill_core::load::InputUncertainty;
use armill_core::nalgebra::{Unit, Vector3};
use armill_core::robot::Robot;
use armill_core::robot::inverse::posture_at;
use armill_core::source::elastic::predict;
use armill_core::source::{Arm, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;

use crate::arms::{self, other};

/// Evaluates `robot` along a wave of tool poses, half a millimetre to one apart.
fn along<T>(robot: &Robot, choice: BranchChoice, then: impl FnOnce(&Question<'_>, &[Isometry]) -> T) -> T {
    let tool = arms::bent_tool();
    // In the middle of each reach, away from singularities; 2 m is the middle of the rail.
    let q: &[f64] = match robot.name() {
        name if name.contains("rail") => &[2.0, 0.2, 0.3, -0.4, 0.5, 0.7, 0.3],
        name if name.contains("mh12") => &[0.2, 0.3, -0.4, 0.5, 0.7, 0.3],
        name if name.contains("ur10") => &[0.3, -1.2, 1.6, -0.5, 1.1, 0.4],
        name if name.contains("iiwa") => &[0.3, 0.6, -0.4, -1.2, 0.5, 0.9, -0.2],
        _ => &[0.3, 0.5, -0.4, 0.7, 1.1, 0.4],
    };
    let start = posture_at(robot, q, &tool).base_from_tool;
    let poses: Vec<Isometry> = (0..400)
        .map(|k| {
            Isometry::translation(0.0, 5e-4 * f64::from(k) - 0.1, 0.05 * (0.02 * f64::from(k)).sin()) * start
        })
        .collect();
    let cases = [
        Wrench::from_force(Vector3::new(3.0, -5.0, 5.0)),
        Wrench::from_force(Vector3::new(-20.0, 4.0, 1.0)),
    ];
    let question = Question {
        homes: None,
        arm: Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model: StiffnessModel::DRIVES,
            flange_from_tool: &tool,
        },
        home: None,
        uncertainty: InputUncertainty::NONE,
        cases: &cases,
        normal: Unit::new_normalize(Vector3::new(-0.8, 0.3, 0.5)),
        choice,
        clearance: None,
    };
    then(&question, &poses)
}

/// Arms of different inverses: closed form, polished, on a rail, searched, with a fixed joint.
fn kinds() -> [Robot; 5] {
    [
        other::ur10(),
        other::calibrated(&arms::mh12(), 5e-4),
        other::on_rail(&arms::mh12()),
        other::oblique(),
        other::iiwa14(),
    ]
}

const NOMINAL: &str = "front elbow-up";

fn choices() -> [BranchChoice; 2] {
    [BranchChoice::Of(NOMINAL.parse().unwrap()), BranchChoice::Best]
}

#[test]
fn the_kernel_agrees_with_predict_for_every_kind_and_any_number_of_threads() {
    for robot in kinds() {
        for choice in choices() {
            along(&robot, choice, |question, poses| {
                let on = |threads: usize| -> Answers {
                    let pool = rayon::ThreadPoolBuilder::new()
                        .num_threads(threads)
                        .build()
                        .unwrap();
                    pool.install(|| evaluate(question, poses.len(), |i| poses[i], Watch::NONE).unwrap())
                };
                let (answers, again) = (on(1), on(3));
                assert_eq!(answers.points, again.points, "{}", robot.name());
                assert_eq!(answers.joints, again.joints);
                assert_eq!(answers.deviations, again.deviations);
                let mut checked = 0;
                for (i, evaluation) in answers.evaluations() {
                    let posture = posture_at(&robot, answers.joints_at(i), question.arm.flange_from_tool);
                    let away = posture.base_from_tool.translation.vector - poses[i].translation.vector;
                    assert!(away.norm() < 1e-9, "{}", robot.name());
                    if evaluation.singularity.is_none() {
                        assert_eq!(posture.name, evaluation.name);
                    }
                    for (case, wrench) in question.cases.iter().enumerate() {
                        let witness = predict(&posture, question.arm.compliance, wrench).twist.linear;
                        let away = answers.deviations_at(i)[case] - witness;
                        // The pose is accurate to 1e-9 m and rad, and so are the screws, relative to a metre.
                        assert!(away.norm() < 1e-8 * witness.norm());
                    }
                    checked += 1;
                }
                assert!(checked > 300, "{}: {checked}", robot.name());
            });
        }
    }
}

#[test]
fn best_is_nowhere_worse_than_nominal() {
    for robot in kinds() {
        let [nominal, best] = choices().map(|choice| {
            along(&robot, choice, |question, poses| {
                evaluate(question, poses.len(), |i| poses[i], Watch::NONE).unwrap()
            })
        });
        let mut compared = 0;
        for (nominal, best) in nominal.points.iter().zip(&best.points) {
            let (Ok(nominal), Ok(best)) = (nominal, best) else {
                continue;
            };
            if nominal.within_limits() {
                assert!(
                    best.in_plane <= nominal.in_plane * (1.0 + 1e-6),
                    "{}",
                    robot.name()
                );
                compared += 1;
            }
        }
        assert!(compared > 100, "{}: {compared}", robot.name());
    }
}

#[test]
fn along_a_path_no_joint_jumps() {
    for robot in kinds() {
        along(&robot, choices()[0], |question, poses| {
            let answers = evaluate_in_order(question, poses.len(), |i| poses[i], Watch::NONE).unwrap();
            assert!(answers.evaluations().count() == poses.len(), "{}", robot.name());
            for i in 1..poses.len() {
                let (a, b) = (answers.joints_at(i - 1), answers.joints_at(i));
                let step = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                // 1.1 mm a step at most; away from singularities a joint turns by some 10 rad/m.
                assert!(step < 0.05, "{} at {i}: {step} rad\n{a:?}\n{b:?}", robot.name());
            }
        });
    }
}

#[test]
fn a_map_of_an_iiwa_is_continuous() {
    for choice in choices() {
        along(&other::iiwa14(), choice, |question, poses| {
            let answers = evaluate(question, poses.len(), |i| poses[i], Watch::NONE).unwrap();
            assert_eq!(answers.evaluations().count(), poses.len());
            assert!((0..poses.len()).all(|i| answers.joints_at(i)[2] == 0.0));
            let evaluation: Vec<_> = answers.evaluations().collect();
            for ((_, a), (i, b)) in evaluation.iter().zip(&evaluation[1..]) {
                // Half a millimetre to one apart, of a reach of 0.8 m: some parts in a thousand. The best posture
                // may come to a limit: the deviation then has a step.
                let step = (a.in_plane - b.in_plane).abs() / a.in_plane;
                assert!(step < 0.01 || choice == BranchChoice::Best, "{i}: {step}");
            }
        });
    }
}
