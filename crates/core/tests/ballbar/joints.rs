//! Reversals of joints of arms on circles, and the backlash that was put in. Reference: forward and inverse kinematics
//! with link offsets, and the deviation along a path.

use std::f64::consts::TAU;

use armill_core::frame::Isometry;
use armill_core::kernel::{Question, evaluate};
use armill_core::load::{LoadCases, LoadFrame, PathLoad};
use armill_core::map::{along_path, radial_deviations};
use armill_core::measure::ballbar::joints::{
    BacklashFit, BacklashOptions, Circle, CirclePlanOptions, Domain, Followed, Normal, Observed,
    fit_backlash, follow, propose,
};
use armill_core::measure::ballbar::{CircularTest, Direction, Run};
use armill_core::nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use armill_core::path::{Shape, Track};
use armill_core::robot::forward::forward;
use armill_core::robot::inverse::tool_on;
use armill_core::robot::{Amount, Backlash, BacklashSide, Motion, Robot};
use armill_core::source::StiffnessModel;
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;

use crate::arms;
use crate::arms::circles::{self, RADIUS, circle, three, tool};
use crate::machine::Random;

const GAPS: [f64; 6] = [1.2e-4, 0.8e-4, 1.5e-4, 2.5e-4, 2e-4, 3e-4];

fn question<'a>(robot: &'a Robot, model: &'a StiffnessModel, tool: &'a Isometry) -> Question<'a> {
    circles::question(robot, (robot.compliance().unwrap(), model), tool)
}

fn followed(robot: &Robot, circle: &Circle) -> Followed {
    let tool = tool();
    follow(
        &question(robot, StiffnessModel::DRIVES, &tool),
        circle,
        720,
        Watch::NONE,
    )
    .unwrap()
}

/// What a bar shows both ways, half a degree apart, with noise.
fn measured(of: &Followed, gaps: &[f64], (noise, runs, seed): (f64, usize, u64)) -> CircularTest {
    let mut random = Random(seed);
    let angles: Vec<f64> = (0..720)
        .map(|k| (0.5 * f64::from(k) + 0.1).to_radians())
        .collect();
    let run = |direction: Direction, random: &mut Random| {
        let shown = of.deviation(gaps, direction, &angles);
        let noisy = shown.iter().map(|dr| dr + noise * random.normal()).collect();
        Run::new(direction, angles.clone(), noisy).unwrap()
    };
    let all = (0..runs).flat_map(|_| Direction::BOTH);
    let all: Vec<Run> = all.map(|direction| run(direction, &mut random)).collect();
    CircularTest::new(of.radius, all).unwrap()
}

fn found(circles: &[Followed], tests: &[CircularTest], requested: &BacklashOptions) -> BacklashFit {
    let observed: Vec<Observed<'_>> = circles
        .iter()
        .zip(tests)
        .map(|(followed, test)| Observed { followed, test })
        .collect();
    fit_backlash(&observed, requested).unwrap().unwrap()
}

/// The tool pose at an angle of the circle.
fn pose(circle: &Circle, a: f64) -> Isometry {
    let shape = Shape::Circle {
        centre: circle.centre,
        radius: circle.radius,
    };
    let at = Point3::new(-RADIUS * a.cos(), RADIUS * a.sin(), 0.0);
    let still = circle.placing.base_from_tool(&shape.sampled(1.0).points[0]);
    Isometry::from_parts((circle.placing.base_from_path * at).coords.into(), still.rotation)
}

/// Joint positions at one angle of the circle, computed separately.
fn joints_at(question: &Question<'_>, circle: &Circle, a: f64) -> Vec<f64> {
    let cases = [Wrench::ZERO];
    let requested = Question {
        cases: &cases,
        ..*question
    };
    let answers = evaluate(&requested, 1, |_| pose(circle, a), Watch::NONE).unwrap();
    answers.joints_at(0).to_vec()
}

#[test]
fn joints_turn_back_where_inverse_kinematics_says() {
    let (robot, tool) = (arms::mh12(), tool());
    let question = question(&robot, StiffnessModel::DRIVES, &tool);
    for circle in three() {
        let of = followed(&robot, &circle);
        assert!(of.reversals.len() >= 10, "{:?}", of.reversals);
        for reversal in &of.reversals {
            let step = 1e-3;
            let at = [-step, 0.0, step]
                .map(|by| joints_at(&question, &circle, reversal.angle + by)[reversal.joint]);
            let speed = (at[2] - at[0]) / (2.0 * step);
            let bend = (at[2] - 2.0 * at[1] + at[0]) / (step * step);
            // Where the speed is zero, accurate to finite differences: a third derivative of some units times the step
            // squared.
            assert!((speed / bend).abs() < 1e-5, "{reversal:?}: {speed} {bend}");
        }
    }
}

/// The arm with gaps, as a study has it.
fn with_gaps(gaps: &[f64]) -> StiffnessModel {
    let mut model = StiffnessModel::DRIVES.clone();
    model.structure.backlash = gaps
        .iter()
        .map(|gap| {
            Some(Backlash {
                gap: *gap,
                standard_uncertainty: 0.0,
                side: BacklashSide::Motion,
            })
        })
        .collect();
    model
}

#[test]
fn the_effect_is_the_deviation_that_a_path_has() {
    let (robot, tool) = (arms::mh12(), tool());
    for circle in three() {
        let of = followed(&robot, &circle);
        let model = with_gaps(&GAPS);
        let requested = question(&robot, &model, &tool);
        let shape = Shape::Circle {
            centre: circle.centre,
            radius: circle.radius,
        };
        let track = Track {
            path: shape.sampled(TAU * RADIUS / 7200.0),
            placing: circle.placing,
            base_from_part: circle.placing.base_from_path,
            spins: None,
            homes: None,
        };
        let load = PathLoad::Cases(LoadCases {
            frame: LoadFrame::Base,
            cases: vec![Wrench::ZERO],
        });
        let along = along_path(&requested, &track, load, Watch::NONE).unwrap();
        let radial = &radial_deviations(&track, &along.answers, circle.centre)[0].outward;
        let angles: Vec<f64> = (0..720).map(|k| TAU * f64::from(k) / 720.0).collect();
        let mut given = vec![0.0; angles.len()];
        for (joint, gap) in GAPS.iter().enumerate() {
            let effect = of.effect(joint, *gap, Direction::Anticlockwise, &angles);
            given.iter_mut().zip(effect).for_each(|(sum, one)| *sum += one);
        }
        // A path begins where its first move pushes, a circle behind a whole turn: alike once gaps are crossed.
        for (k, (given, path)) in given.iter().zip(radial.iter().step_by(10)).enumerate().skip(60) {
            // Where a joint turns back between two points is known here and not there: that leaves the square of half
            // the pitch, 4e-4, as the joint bends, over the lever.
            assert!((given - path).abs() < 2e-8, "{k}: {given} {path}");
        }
        // And to first order what a bar shows.
        let shown = of.deviation(&GAPS, Direction::Anticlockwise, &angles);
        let off = shown.iter().zip(&given).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 2.0 * (3e-4_f64).powi(2) / RADIUS);
    }
}

#[test]
fn links_half_a_backlash_behind_agree_with_forward_kinematics() {
    let (robot, tool) = (arms::mh12(), tool());
    let circle = three()[0];
    let of = followed(&robot, &circle);
    let model = with_gaps(&[0.0; 6]);
    let question = question(&robot, &model, &tool);
    let (joint, gap) = (1, 2e-5);
    for direction in Direction::BOTH {
        for deg in (3..360).step_by(10) {
            let a = f64::from(deg).to_radians();
            let near = |b: f64| (a - b + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            if of
                .reversals
                .iter()
                .any(|r| r.joint == joint && near(r.angle).abs() < 0.1)
            {
                continue;
            }
            let joints = |a: f64| joints_at(&question, &circle, a);
            let (q, next) = (joints(a), joints(a + 1e-4 * direction.sign()));
            let speed = next[joint] - q[joint];
            let mut behind = q.clone();
            behind[joint] -= 0.5 * gap * speed.signum();
            let place = tool_on(&forward(&robot, &behind), &tool).translation.vector;
            let centre = circle.placing.base_from_path.translation.vector;
            let given = of.effect(joint, gap, direction, &[a])[0];
            let moved = place - pose(&circle, a).translation.vector;
            let outwards = (pose(&circle, a).translation.vector - centre).normalize();
            assert!((given - moved.dot(&outwards)).abs() < gap * gap, "{deg}");
        }
    }
}

#[test]
fn gaps_come_back_from_three_circles() {
    let robot = arms::mh12();
    let circles = three().map(|circle| followed(&robot, &circle));
    let tests = [0, 1, 2].map(|k| measured(&circles[k], &GAPS, (0.0, 1, 1)));
    let all = found(&circles, &tests, &BacklashOptions::of_all(6));
    assert!(all.together.is_empty() && all.unseen.is_empty(), "{all:?}");
    assert!(
        all.inflation.iter().all(|(_, inflation)| *inflation < 5.0),
        "{all:?}"
    );
    for (joint, gap) in GAPS.iter().enumerate() {
        // Second order of the radius, 1e-4 of 100 um, through singular values of a tenth.
        let given = all.of(joint).unwrap();
        assert!(
            (given.gap - gap).abs() < 2e-3 * gap,
            "{joint}: {given:?} for {gap}"
        );
    }
    // A larger gap of one joint is found at that joint.
    let mut more = GAPS;
    more[3] = 0.0;
    let tests = [0, 1, 2].map(|k| measured(&circles[k], &more, (0.0, 1, 1)));
    let all = found(&circles, &tests, &BacklashOptions::of_all(6));
    assert!(all.of(3).unwrap().gap.abs() < 1e-6, "{all:?}");
}

#[test]
fn twice_the_uncertainty_contains_the_backlash_with_given_noise_and_with_estimated_noise() {
    let robot = arms::mh12();
    let circles = three().map(|circle| followed(&robot, &circle));
    for (noise, runs) in [(Some(2e-6), 1), (None, 1), (None, 2)] {
        let (mut contained, mut all) = (0, 0);
        for seed in 0..30 {
            let tests = [0, 1, 2].map(|k| measured(&circles[k], &GAPS, (2e-6, runs, 100 * seed + k as u64)));
            let requested = BacklashOptions {
                noise,
                ..BacklashOptions::of_all(6)
            };
            let given = found(&circles, &tests, &requested);
            assert_eq!(given.estimates.len(), 6);
            for gap in &given.estimates {
                all += 1;
                contained += usize::from((gap.gap - GAPS[gap.joint]).abs() < 2.0 * gap.u);
                assert!((given.covariance[(gap.joint, gap.joint)].sqrt() / gap.u - 1.0).abs() < 1e-12);
            }
        }
        // 95 %, of 180: between 90 and 100 by chance alone; those from residuals are a little wide.
        assert!(
            contained * 100 >= all * 90,
            "{noise:?} {runs}: {contained} of {all}"
        );
    }
}

#[test]
fn on_the_circle_of_the_paper_three_joints_reverse_together_and_are_not_identifiable() {
    let robot = arms::mh12();
    let tool = Isometry::identity();
    let paper = circle([1.0, 0.0, 0.8], 0.0);
    let requested = question(&robot, StiffnessModel::DRIVES, &tool);
    let of = follow(&requested, &paper, 720, Watch::NONE).unwrap();
    for joint in [1, 2, 4] {
        let turns: Vec<f64> = (of.reversals.iter().filter(|r| r.joint == joint))
            .map(|r| r.angle.to_degrees())
            .collect();
        assert!(
            turns.iter().any(|a| (a - 90.0).abs() < 1e-6) && turns.iter().any(|a| (a - 270.0).abs() < 1e-6),
            "{joint}: {turns:?}"
        );
    }
    let test = measured(&of, &GAPS, (1e-6, 2, 5));
    let one = found(
        std::slice::from_ref(&of),
        std::slice::from_ref(&test),
        &BacklashOptions::of_all(6),
    );
    assert!(!one.together.is_empty(), "{one:?}");
    // With planned circles in addition all of them are.
    let domain = Domain {
        middle: Point3::new(0.9, 0.0, 0.7),
        half: Vector3::new(0.15, 0.3, 0.2),
        along: 3,
        normals: Normal::ALL.to_vec(),
        radii: vec![RADIUS],
    };
    let plan = propose(
        &requested,
        &domain.candidates(),
        std::slice::from_ref(&of),
        &CirclePlanOptions {
            count: 3,
            joints: (0..6).collect(),
            most_lobes: 6,
            inflation: 10.0,
            noise: 1e-6,
        },
        Watch::NONE,
    )
    .unwrap();
    let [all, reached] = plan.candidates;
    assert!(all == 108 && reached > 20, "{reached}");
    // The plan assumes gaps alike, so sets may part otherwise: the same joints are lost.
    let lost = |sets: &[Vec<usize>]| {
        let mut lost = sets.concat();
        lost.sort_unstable();
        lost
    };
    assert_eq!(lost(&plan.begun.together), lost(&one.together));
    assert!(lost(&one.together).len() >= 2, "{one:?}");
    let mut circles = vec![of];
    let mut tests = vec![test];
    for chosen in &plan.circles {
        let whole = follow(&requested, &chosen.candidate.circle, 720, Watch::NONE).unwrap();
        tests.push(measured(&whole, &GAPS, (1e-6, 2, 7)));
        circles.push(whole);
    }
    let four = found(&circles, &tests, &BacklashOptions::of_all(6));
    let last = &plan.circles[2].known;
    assert_eq!(four.unseen, last.unseen);
    assert!(four.together.is_empty() && last.together.is_empty(), "{four:?}");
    assert!(four.estimates.len() >= 5, "{four:?}");
    for gap in &four.estimates {
        assert!((gap.gap - GAPS[gap.joint]).abs() < 4.0 * gap.u, "{gap:?}");
        // What the plan expected of one run each way at this noise; two runs and a circle more are surer.
        let expected = last.estimates.iter().find(|one| one.joint == gap.joint).unwrap();
        assert!(
            gap.u < 1.5 * expected.u && gap.u > 0.3 * expected.u,
            "{gap:?} {expected:?}"
        );
    }
}

#[test]
fn an_arm_turned_about_its_base_has_the_same_gaps() {
    let robot = arms::mh12();
    let about = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.7);
    let turn = Isometry::from_parts(Translation3::identity(), about);
    for before in three() {
        let mut after = before;
        after.placing.base_from_path = turn * before.placing.base_from_path;
        let tool = tool();
        let requested = question(&robot, StiffnessModel::DRIVES, &tool);
        // The tool turns with the cell, about its own axis if the plane is horizontal.
        let of = follow(&requested, &before, 720, Watch::NONE).unwrap();
        let [given, turned] = [turn * pose(&before, 0.0), pose(&after, 0.0)];
        let spin = (turned.rotation.inverse() * given.rotation).scaled_axis().z;
        after.placing.spin = armill_core::path::Spin::Fixed(spin);
        let there = follow(&requested, &after, 720, Watch::NONE).unwrap();
        assert_eq!(of.reversals.len(), there.reversals.len());
        for one in &of.reversals {
            let mut others = there.reversals.iter().filter(|other| other.joint == one.joint);
            // Rounding of the joints, 1e-14, over the pitch of the stations and how much the joint bends.
            assert!(
                others.any(|other| (one.angle - other.angle).sin().abs() < 1e-8),
                "{one:?}"
            );
        }
        let angles: Vec<f64> = (0..360).map(f64::from).map(f64::to_radians).collect();
        for direction in Direction::BOTH {
            let [here, there] = [&of, &there].map(|of| of.deviation(&GAPS, direction, &angles));
            let off = here.iter().zip(&there).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-11);
        }
    }
}

#[test]
fn an_arm_twice_as_large_shows_the_same_gaps_twice_as_large() {
    let robot = arms::mh12();
    let motions = robot.chain().motions().iter().map(|motion| match motion {
        Motion::Along(axis, Amount::Constant(length)) => Motion::Along(*axis, Amount::Constant(2.0 * length)),
        other => *other,
    });
    let larger = Robot::new("larger", motions.collect(), robot.joints().to_vec())
        .unwrap()
        .with_compliance(robot.compliance().unwrap().to_vec())
        .unwrap();
    let tools = [1.0, 2.0].map(|size| Isometry::translation(0.03 * size, -0.02 * size, 0.15 * size));
    let before = three()[1];
    let mut after = before;
    after.placing.base_from_path.translation.vector *= 2.0;
    after.radius *= 2.0;
    let one = follow(
        &question(&robot, StiffnessModel::DRIVES, &tools[0]),
        &before,
        720,
        Watch::NONE,
    )
    .unwrap();
    let two = follow(
        &question(&larger, StiffnessModel::DRIVES, &tools[1]),
        &after,
        720,
        Watch::NONE,
    )
    .unwrap();
    let angles: Vec<f64> = (0..360).map(f64::from).map(f64::to_radians).collect();
    let [small, large] = [&one, &two].map(|of| of.deviation(&GAPS, Direction::Clockwise, &angles));
    for (small, large) in small.iter().zip(&large) {
        assert!((2.0 * small - large).abs() < 1e-11, "{small} {large}");
    }
    let [small, large] = [&one, &two].map(|of| {
        let requested = BacklashOptions {
            joints: vec![0, 3],
            ..BacklashOptions::of_all(6)
        };
        let gaps = [GAPS[0], 0.0, 0.0, GAPS[3], 0.0, 0.0];
        found(
            std::slice::from_ref(of),
            &[measured(of, &gaps, (0.0, 1, 1))],
            &requested,
        )
    });
    for (small, large) in small.estimates.iter().zip(&large.estimates) {
        assert!((small.gap - large.gap).abs() < 1e-9, "{small:?} {large:?}");
    }
}

#[test]
fn a_torque_that_determines_the_side_of_the_backlash_leaves_no_step() {
    let (robot, tool) = (arms::mh12(), tool());
    let mut model = with_gaps(&GAPS);
    model.structure.backlash[1].as_mut().unwrap().side = BacklashSide::Torque;
    model.structure.masses = vec![armill_core::robot::Mass {
        attachment: armill_core::robot::Attachment::Tool,
        mass: 8.0,
        centre: Point3::origin(),
        inertia: None,
        relative_uncertainty: 0.0,
    }];
    model.gravity = Some(armill_core::source::Gravity {
        acceleration: Vector3::new(0.0, 0.0, -9.8),
        reference: vec![0.0; 6],
    });
    let of = follow(&question(&robot, &model, &tool), &three()[0], 720, Watch::NONE).unwrap();
    let angles: Vec<f64> = (0..720).map(|k| f64::from(k).to_radians() / 2.0).collect();
    let [one, other] = Direction::BOTH.map(|direction| of.effect(1, 1e-4, direction, &angles));
    assert_eq!(one, other);
    let jump = one.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    assert!(jump.fold(0.0, f64::max) < 2e-6);
    let [one, other] = Direction::BOTH.map(|direction| of.effect(2, 1e-4, direction, &angles));
    assert!(
        one.iter()
            .zip(&other)
            .any(|(one, other)| (one - other).abs() > 2e-5)
    );
}

#[test]
fn unreachable_circles_are_reported() {
    let (robot, tool) = (arms::mh12(), tool());
    let far = circle([2.5, 0.0, 0.8], 0.0);
    let error = follow(
        &question(&robot, StiffnessModel::DRIVES, &tool),
        &far,
        90,
        Watch::NONE,
    )
    .unwrap_err();
    assert!(
        error.to_string().starts_with("at 0 deg of the circle: "),
        "{error}"
    );
}

#[test]
fn a_joint_at_rest_to_rounding_does_not_move_its_link() {
    // The tool straight down: R stays where it is.
    let (robot, tool) = (arms::mh12(), tool());
    let flat = circle([0.85, 0.25, 0.45], 90.0);
    let requested = question(&robot, StiffnessModel::DRIVES, &tool);
    let of = follow(&requested, &flat, 720, Watch::NONE).unwrap();
    assert!(
        of.reversals.iter().all(|reversal| reversal.joint != 3),
        "{:?}",
        of.reversals
    );
    let angles: Vec<f64> = (0..360).map(|k| (f64::from(k) + 0.3).to_radians()).collect();
    for direction in Direction::BOTH {
        assert!(of.effect(3, 1e-4, direction, &angles).iter().all(|dr| *dr == 0.0));
    }
}
