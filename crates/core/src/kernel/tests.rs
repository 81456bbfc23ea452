//! Points through lanes, one after the other, under separate loads and at known joints: the same physics.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use nalgebra::{Point3, Unit, Vector3};

use super::*;
use crate::arms::{self, Stream};
use crate::load::InputUncertainty;
use crate::robot::inverse::{ToolAt, postures};
use crate::robot::{
    Attachment, BranchPattern, JointCompliance, Mass, PostureName, Robot, Spring, Structure, Unreachable,
};
use crate::source::stiffness_model::Gravity;
use crate::source::{Arm, StiffnessModel};
use crate::spatial::Wrench;

pub(super) fn cases() -> Vec<Wrench> {
    vec![
        Wrench::from_force(Vector3::new(3.0, -5.0, 5.0)),
        Wrench {
            force: Vector3::new(-20.0, 4.0, 1.0),
            moment: Vector3::new(0.4, -1.5, 2.0),
        },
        Wrench::from_force(Vector3::new(1.0, 8.0, -30.0)),
    ]
}

/// A question for `robot` with a bent tool and an oblique plane.
pub(super) fn analysis<T>(
    robot: &Robot,
    model: &StiffnessModel,
    choice: BranchChoice,
    then: impl FnOnce(&Question<'_>) -> T,
) -> T {
    let (tool, cases) = (arms::bent_tool(), cases());
    then(&Question {
        homes: None,
        arm: Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model,
            flange_from_tool: &tool,
        },
        home: None,
        cases: &cases,
        uncertainty: InputUncertainty::NONE,
        normal: Unit::new_normalize(Vector3::new(-0.8, 0.3, 0.5)),
        choice,
        clearance: None,
    })
}

pub(super) const NOMINAL: BranchChoice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);

/// Joint positions inside the limits; a rail is in the middle, where inverse kinematics has it without a home.
pub(super) fn joints(stream: &mut Stream, robot: &Robot) -> Vec<f64> {
    let mut q = stream.joints(robot);
    let rail = robot.inverse().rail_joints();
    q[..rail].copy_from_slice(&robot.home(None)[..rail]);
    q
}

/// Tool poses of joint positions inside the limits.
pub(super) fn poses(robot: &Robot, count: usize, seed: u64) -> Vec<Isometry> {
    let mut stream = Stream(seed);
    let pose = |_| {
        let q = joints(&mut stream, robot);
        crate::robot::inverse::posture_at(robot, &q, &arms::bent_tool()).base_from_tool
    };
    (0..count).map(pose).collect()
}

/// A spring at the base: not drives only, and affine.
pub(super) fn springy() -> StiffnessModel {
    let compliance = JointCompliance {
        value: 4e-8,
        standard_uncertainty: 1e-9,
    };
    StiffnessModel {
        structure: Structure {
            springs: vec![Spring::about(Attachment::Base, Vector3::y(), compliance)],
            ..Structure::EMPTY
        },
        ..StiffnessModel::DRIVES.clone()
    }
}

/// Arms and models that lanes know: drives alone; a spring and gravity, torque curves, a compensator; calibrated arms,
/// three parallel axes; rails.
pub(super) fn subjects() -> Vec<(Robot, StiffnessModel)> {
    let mut heavy = springy();
    heavy.structure.masses = vec![Mass {
        attachment: Attachment::Joint(2),
        mass: 40.0,
        centre: Point3::new(0.1, 0.0, 0.3),
        inertia: None,
        relative_uncertainty: 0.0,
    }];
    heavy.gravity = Some(Gravity {
        acceleration: Vector3::new(0.0, 0.0, -9.81),
        reference: vec![0.2; 6],
    });
    let mut curved = heavy.clone();
    curved.structure.curves = (0..6).map(|joint| Some(arms::curves(joint))).collect();
    let mut balanced = heavy.clone();
    balanced.structure.compensator = Some(arms::compensator(1));
    let mut both = curved.clone();
    both.structure.curves[2] = None;
    both.structure.compensator = Some(arms::compensator(2));
    let mut railed = curved.clone();
    railed.structure.curves.insert(0, None);
    railed.gravity.as_mut().unwrap().reference.push(0.2);
    let calibrated = arms::other::calibrated(&arms::kr120(), 1e-3);
    let on_rail = arms::other::on_rail;
    let drives = || StiffnessModel::DRIVES.clone();
    let all = arms::all().into_iter().map(|robot| (robot, drives()));
    let others = [
        (arms::mh12(), heavy.clone()),
        (arms::irb2400(), curved.clone()),
        (arms::kr120(), balanced),
        (calibrated.clone(), drives()),
        (calibrated.clone(), heavy.clone()),
        (calibrated, both),
        (arms::other::ur10(), curved),
        (arms::other::ur10(), drives()),
        (arms::other::ur10e(), heavy),
        (on_rail(&arms::mh12()), drives()),
        (on_rail(&arms::tx2_90()), railed.clone()),
        (on_rail(&arms::other::ur10e()), drives()),
        (on_rail(&arms::other::calibrated(&arms::kr120(), 1e-4)), railed),
    ];
    all.chain(others).collect()
}

/// A watch that cancels once this number of points is finished; returns the number finished.
pub(super) fn cancelled_after<T>(count: usize, work: impl FnOnce(Watch<'_>) -> T) -> (T, usize) {
    let (done, cancel) = (AtomicUsize::new(0), AtomicBool::new(count == 0));
    let finished = |points: usize| {
        let before = done.fetch_add(points, Ordering::Relaxed);
        if before + points >= count {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let out = work(Watch {
        finished: &finished,
        cancel: &cancel,
    });
    (out, done.load(Ordering::Relaxed))
}

#[test]
fn work_ends_at_the_block_in_which_it_is_cancelled() {
    let robot = &arms::ALL[0];
    let poses = poses(robot, 300, 1);
    analysis(robot, StiffnessModel::DRIVES, NOMINAL, |question| {
        let (stopped, done) =
            cancelled_after(100, |watch| evaluate_in_order(question, 300, |i| poses[i], watch));
        assert_eq!((stopped.unwrap_err(), done), (Cancelled, 160));
        let (stopped, done) = cancelled_after(0, |watch| evaluate(question, 300, |i| poses[i], watch));
        assert_eq!((stopped.unwrap_err(), done), (Cancelled, 0));
        // All threads stop: fewer points than requested.
        let (whole, done) = cancelled_after(1000, |watch| evaluate(question, 300, |i| poses[i], watch));
        assert!(whole.is_ok() && done == 300);
    });
}

#[test]
fn many_points_have_the_bits_of_few_on_any_number_of_threads() {
    const FEW: usize = 3 * BLOCK;
    let robot = &arms::ALL[0];
    let poses = poses(robot, FEW, 3);
    // More than one piece of three threads, the last one and its last block not full.
    let count = 3 * AT_ONCE + 5 * BLOCK + 7;
    analysis(robot, StiffnessModel::DRIVES, BranchChoice::Best, |question| {
        let few = evaluate(question, FEW, |i| poses[i], Watch::NONE).unwrap();
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let many = pool
                .unwrap()
                .install(|| evaluate(question, count, |i| poses[i % FEW], Watch::NONE))
                .unwrap();
            assert_eq!(many.points.len(), count);
            for i in 0..count {
                assert_eq!(many.points[i], few.points[i % FEW]);
                assert_eq!(many.joints_at(i), few.joints_at(i % FEW));
                assert_eq!(many.deviations_at(i), few.deviations_at(i % FEW));
                assert_eq!(many.shares_at(i), few.shares_at(i % FEW));
            }
        }
    });
}

#[test]
fn points_in_order_and_in_any_order_agree_away_from_wrist_singularities() {
    let robot = &arms::ALL[4];
    let poses = poses(robot, 200, 2);
    analysis(robot, StiffnessModel::DRIVES, NOMINAL, |question| {
        let any = evaluate(question, 200, |i| poses[i], Watch::NONE).unwrap();
        let ordered = evaluate_in_order(question, 200, |i| poses[i], Watch::NONE).unwrap();
        assert_eq!(any.points, ordered.points);
        assert_eq!(
            (any.joints, any.deviations, any.shares),
            (ordered.joints, ordered.deviations, ordered.shares)
        );
    });
}

#[test]
fn repeatability_and_model_error_give_the_same_uncertainty_with_and_without_lanes() {
    let robot = &arms::ALL[0];
    let poses = poses(robot, 100, 9);
    let of = |model: &StiffnessModel| {
        analysis(robot, model, NOMINAL, |question| {
            evaluate(question, 100, |i| poses[i], Watch::NONE).unwrap()
        })
    };
    // A spring of zero compliance keeps points out of lanes.
    let rigid = |repeatability, model_error| {
        let mut model = springy();
        model.structure.springs[0].compliance = JointCompliance {
            value: 0.0,
            standard_uncertainty: 0.0,
        };
        model.structure.repeatability = repeatability;
        model.structure.model_error = model_error;
        model
    };
    let mut drives = StiffnessModel::DRIVES.clone();
    drives.structure.repeatability = 2e-5;
    drives.structure.model_error = 0.2;
    let [plain, lanes, general] = [&rigid(0.0, 0.0), &drives, &rigid(2e-5, 0.2)].map(of);
    let all = plain.points.iter().zip(&lanes.points).zip(&general.points);
    let mut count = 0;
    for ((plain, lanes), general) in all {
        let (Ok(plain), Ok(lanes), Ok(general)) = (plain, lanes, general) else {
            continue;
        };
        let expected = plain
            .in_plane_uncertainty
            .unwrap()
            .hypot(2e-5)
            .hypot(0.2 * plain.in_plane);
        for given in [lanes, general] {
            assert!((given.in_plane_uncertainty.unwrap() - expected).abs() < 1e-12 * expected);
        }
        count += 1;
    }
    assert!(count > 20, "{count}");
}

#[test]
#[should_panic(expected = "a question needs at least one load case")]
fn a_question_without_load_is_refused() {
    analysis(&arms::ALL[0], StiffnessModel::DRIVES, NOMINAL, |question| {
        let without = Question {
            cases: &[],
            ..*question
        };
        evaluate(&without, 1, |_| Isometry::identity(), Watch::NONE).map(drop)
    })
    .unwrap();
}

#[test]
fn zero_points_give_zero_answers() {
    analysis(&arms::ALL[0], StiffnessModel::DRIVES, NOMINAL, |question| {
        let none = evaluate(question, 0, |_| Isometry::identity(), Watch::NONE).unwrap();
        assert!(none.points.is_empty() && none.worst().is_none() && none.best().is_none());
    });
}

#[test]
fn the_flip_with_the_larger_margin_is_used_unless_one_is_named() {
    let mut stream = Stream(3);
    for robot in arms::all() {
        let tool = arms::bent_tool();
        for _ in 0..20 {
            let q = stream.joints(&robot);
            let made = crate::robot::inverse::posture_at(&robot, &q, &tool);
            let Some(branch) = made.name.branch().filter(|_| made.singularity.is_none()) else {
                continue;
            };
            let pattern = BranchPattern {
                wrist: None,
                ..branch.into()
            };
            let at = ToolAt::on(&tool);
            let all = postures(&robot, &made.base_from_tool, at).unwrap();
            let room = |name: PostureName| {
                let found = all.iter().find(|posture| posture.name == name).unwrap();
                robot.limit_margin(&found.joints).unwrap().1
            };
            analysis(
                &robot,
                StiffnessModel::DRIVES,
                BranchChoice::Of(pattern),
                |question| {
                    let answers = evaluate(question, 1, |_| made.base_from_tool, Watch::NONE).unwrap();
                    let evaluation = answers.points[0].unwrap();
                    let own = room(evaluation.name);
                    assert!((own - evaluation.limit_margin).abs() < 1e-9);
                    for posture in &all {
                        let flips = posture
                            .name
                            .branch()
                            .is_some_and(|branch| pattern.matches(branch));
                        assert!(!flips || room(posture.name) <= own + 1e-9, "{}", robot.name());
                    }
                },
            );
            // A named branch is used whatever its margin.
            analysis(
                &robot,
                StiffnessModel::DRIVES,
                BranchChoice::Of(branch.into()),
                |question| {
                    let answers = evaluate(question, 1, |_| made.base_from_tool, Watch::NONE).unwrap();
                    assert_eq!(answers.points[0].unwrap().name, made.name);
                },
            );
        }
    }
}

#[test]
fn the_load_case_without_equilibrium_is_named() {
    let robot = &arms::ALL[0];
    let poses = poses(robot, 20, 4);
    let model = StiffnessModel {
        load_dependent: true,
        ..StiffnessModel::DRIVES.clone()
    };
    analysis(robot, &model, NOMINAL, |question| {
        for unstable in 0..3 {
            let mut cases = cases();
            // A hundred tonnes.
            cases[unstable] = Wrench::from_force(Vector3::new(7e5, -4e5, 6e5));
            let requested = Question {
                cases: &cases,
                ..*question
            };
            let answers = evaluate(&requested, 20, |i| poses[i], Watch::NONE).unwrap();
            let mut given = 0;
            for point in &answers.points {
                if let Err(Unreachable::Unstable { case }) = point {
                    assert_eq!(*case, unstable);
                    given += 1;
                }
            }
            assert!(given > 0);
        }
    });
}

#[test]
fn best_reports_how_far_the_best_posture_exceeds_the_limits() {
    // Joint 2 has a range that no posture of these poses meets.
    let mut joints = arms::mh12().joints().to_vec();
    joints[1].limits = Some(crate::robot::Limits {
        lower: 1e-3,
        upper: 2e-3,
    });
    let robot = Robot::new("narrow", arms::mh12().chain().motions().to_vec(), joints)
        .unwrap()
        .with_compliance(arms::mh12().compliance().unwrap().to_vec())
        .unwrap();
    let poses = poses(&arms::ALL[0], 30, 5);
    let tool = arms::bent_tool();
    analysis(&robot, StiffnessModel::DRIVES, BranchChoice::Best, |question| {
        let answers = evaluate(question, 30, |i| poses[i], Watch::NONE).unwrap();
        for (point, pose) in answers.points.iter().zip(&poses) {
            let Err(Unreachable::OutsideLimits { joint, by }) = point else {
                panic!("{point:?}");
            };
            let at = ToolAt::on(&tool);
            let margins = postures(&robot, pose, at).unwrap();
            let least = margins
                .iter()
                .map(|posture| robot.limit_margin(&posture.joints).unwrap())
                .max_by(|a, b| a.1.total_cmp(&b.1))
                .unwrap();
            let crate::robot::Overrun::Turned(by) = by else {
                panic!("a turning joint");
            };
            // Of two flips with the same margin either may be reported.
            assert!((by + least.1).abs() < 1e-9, "{by} {least:?}");
            assert!(*joint < 6);
        }
    });
}

#[test]
fn a_rail_outside_its_range_is_reported_in_metres() {
    let railed = arms::other::on_rail(&arms::ALL[0]);
    let mut home = vec![0.0; 7];
    home[0] = 6.5;
    let tool = arms::bent_tool();
    let pose = crate::robot::inverse::posture_at(&railed, &[6.5, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6], &tool)
        .base_from_tool;
    analysis(&railed, StiffnessModel::DRIVES, BranchChoice::Best, |question| {
        let requested = Question {
            home: Some(&home),
            ..*question
        };
        let answers = evaluate(&requested, 1, |_| pose, Watch::NONE).unwrap();
        let miss = answers.points[0].unwrap_err();
        // The rail ends at 5 m.
        assert!(
            miss.to_string().ends_with("joint number 1 by 1500.0 mm"),
            "{miss}"
        );
        assert!((miss.amount().unwrap() - 1.5).abs() < 1e-12);
    });
}
