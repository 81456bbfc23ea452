//! Separate loads at every point: by unit loads and one by one.

use super::super::tests::{NOMINAL, analysis, cancelled_after, poses, springy};
use super::*;
use crate::arms::{self, Stream};
use crate::frame::Isometry;
use crate::robot::{Attachment, Backlash, BacklashSide, Mass, Robot};
use crate::source::{Gravity, StiffnessModel, ThermalGrowth};
use nalgebra::Unit;

/// Wrenches of point `i`, three per point.
fn load(i: usize, wrenches: &mut [Wrench]) {
    let mut stream = Stream(i as u64);
    for wrench in wrenches {
        *wrench = Wrench {
            force: stream.vector(400.0),
            moment: stream.vector(20.0),
        };
    }
}

fn stop(poses: &[Isometry], i: usize) -> Stop {
    Stop {
        base_from_tool: poses[i],
        normal: Unit::new_normalize(poses[i].rotation * Vector3::z()),
    }
}

fn rows<'a>(answers: &'a mut Answers, question: &Question<'_>) -> Rows<'a> {
    Rows {
        answers,
        wrenches: vec![Wrench::ZERO; question.cases.len()],
    }
}

/// Springs, and masses under gravity: still affine.
fn weighing() -> StiffnessModel {
    let mut model = springy();
    model.structure.masses = vec![Mass {
        attachment: Attachment::Joint(2),
        mass: 60.0,
        centre: nalgebra::Point3::new(0.1, 0.0, 0.2),
        inertia: None,
        relative_uncertainty: 0.0,
    }];
    model.gravity = Some(Gravity {
        acceleration: Vector3::new(0.0, 0.0, -9.81),
        reference: vec![0.3; 6],
    });
    model
}

/// The same of a calibrated arm that is worn and warm: along a path the load alone counts.
fn calibrated() -> StiffnessModel {
    let mut model = weighing();
    model.actual = Some(std::sync::Arc::new(arms::ALL[1].clone()));
    model.thermal = Some(ThermalGrowth::new(12e-6, 5.0, 1.0));
    let gap = Backlash {
        gap: 1e-4,
        standard_uncertainty: 0.0,
        side: BacklashSide::Motion,
    };
    model.structure.backlash = vec![Some(gap); 6];
    model
}

#[test]
fn unit_loads_agree_with_each_load_alone() {
    for (robot, model) in [
        (&arms::ALL[0], StiffnessModel::DRIVES.clone()),
        (&arms::ALL[4], springy()),
        (&arms::ALL[2], weighing()),
        (&arms::ALL[2], calibrated()),
    ] {
        let poses = poses(robot, 100, 21);
        analysis(robot, &model, NOMINAL, |question| {
            assert!(model.is_affine());
            let mut by_units = Answers::new(question, 100, AnswerDetail::DeviationsAlone);
            let mut one_by_one = by_units.clone();
            let stop = |i: usize| stop(&poses, i);
            rows(&mut by_units, question)
                .by_unit_loads(question, stop, |i, _, w| load(i, w), Watch::NONE)
                .unwrap();
            rows(&mut one_by_one, question)
                .one_by_one(question, stop, |i, _, w| load(i, w), Watch::NONE)
                .unwrap();
            assert!(by_units.evaluations().count() > 20);
            for i in 0..100 {
                let (Ok(a), Ok(b)) = (by_units.points[i], one_by_one.points[i]) else {
                    assert_eq!(by_units.points[i], one_by_one.points[i]);
                    continue;
                };
                if a.name != b.name || a.singularity.is_some() {
                    continue;
                }
                // 20 N m are scaled from one newton metre: a few more digits are lost than in one product.
                let within = 1e-10 * b.full;
                for (a, b) in by_units.deviations_at(i).iter().zip(one_by_one.deviations_at(i)) {
                    assert!((a - b).norm() < within, "{i}: {a} {b}");
                }
                assert!((a.in_plane - b.in_plane).abs() < within && (a.full - b.full).abs() < within);
                assert_eq!(a.worst_case, b.worst_case);
                assert_eq!((a.in_plane_uncertainty, b.in_plane_uncertainty), (None, None));
            }
        });
    }
}

#[test]
fn the_tip_compliance_given_to_the_load_is_that_of_the_posture() {
    let (robot, model) = (&arms::ALL[2], weighing());
    let poses = poses(robot, 40, 22);
    analysis(robot, &model, NOMINAL, |question| {
        let mut given = Vec::new();
        let answers = evaluate_loaded(
            question,
            40,
            |i| stop(&poses, i),
            |i, tip, wrenches| {
                given.push((i, *tip.unwrap()));
                load(i, wrenches);
            },
            Watch::NONE,
        )
        .unwrap();
        // In order, and only at reachable points.
        let reached: Vec<usize> = answers.evaluations().map(|(i, _)| i).collect();
        assert_eq!(given.iter().map(|(i, _)| *i).collect::<Vec<_>>(), reached);
        let mut arm_state = crate::source::ArmState::new(question.arm);
        for (i, tip) in given {
            arm_state.set_joints(answers.joints_at(i));
            let expected = arm_state.tip_compliance().unwrap();
            assert!((tip.by_force - expected.by_force).norm() < 1e-9 * expected.by_force.norm());
            assert!((tip.unloaded - expected.unloaded).norm() < 1e-12);
        }
    });
}

#[test]
fn a_load_dependent_model_gives_no_tip_compliance_and_cancels_between_points() {
    let model = StiffnessModel {
        load_dependent: true,
        ..springy()
    };
    let robot = &arms::ALL[4];
    let poses = poses(robot, 50, 23);
    analysis(robot, &model, NOMINAL, |question| {
        let mut requested = 0;
        let (stopped, done) = cancelled_after(7, |watch| {
            evaluate_loaded(
                question,
                50,
                |i| stop(&poses, i),
                |i, tip, wrenches| {
                    assert!(tip.is_none());
                    requested += 1;
                    load(i, wrenches);
                },
                watch,
            )
        });
        assert_eq!((stopped.unwrap_err(), done, requested), (Cancelled, 7, 7));
    });
}

#[test]
#[should_panic(expected = "a question needs at least one load case")]
fn a_path_without_load_is_refused() {
    analysis(&arms::ALL[0], StiffnessModel::DRIVES, NOMINAL, |question| {
        let without = Question {
            cases: &[],
            ..*question
        };
        let still = |_| Stop {
            base_from_tool: Isometry::identity(),
            normal: Vector3::z_axis(),
        };
        evaluate_loaded(&without, 1, still, |_, _, _| (), Watch::NONE).map(drop)
    })
    .unwrap();
}

#[test]
fn normal_and_cases_of_the_question_are_not_used_on_a_path() {
    let robot: &Robot = &arms::ALL[1];
    let poses = poses(robot, 90, 24);
    analysis(robot, StiffnessModel::DRIVES, NOMINAL, |question| {
        let others = [Wrench::from_force(Vector3::x() * 1e3); 3];
        let other = Question {
            cases: &others,
            normal: Vector3::z_axis(),
            ..*question
        };
        let of = |question: &Question<'_>| {
            evaluate_loaded(
                question,
                90,
                |i| stop(&poses, i),
                |i, _, w| load(i, w),
                Watch::NONE,
            )
            .unwrap()
        };
        let (a, b) = (of(question), of(&other));
        assert_eq!((a.points, a.deviations), (b.points, b.deviations));
        assert!(a.shares.is_empty() && a.share_count == 0);
    });
}
