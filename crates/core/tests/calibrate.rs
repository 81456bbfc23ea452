//! Kinematic calibration from measured poses: known errors are recovered, parameters that are not identifiable are
//! reported.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(missing_docs, clippy::unwrap_used)]

mod arms;

use armill_core::calibrate::{
    Calibrated, MeasuredPose, ParameterLocation, ParameterSet, Prior, Question, Refusal, fit,
};
use armill_core::frame::Isometry;
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::robot::forward::forward;
use armill_core::robot::{Amount, Axis, Motion, Robot};

fn flange(robot: &Robot, joints: &[f64]) -> Isometry {
    let flange = forward(robot, joints).base_from_flange;
    Isometry::from_parts(
        flange.translation,
        UnitQuaternion::from_rotation_matrix(&flange.rotation),
    )
}

fn frames() -> [Isometry; 2] {
    [
        Isometry::new(Vector3::new(2.0, -3.0, 0.4), Vector3::new(0.3, -1.2, 2.0)),
        Isometry::new(Vector3::new(0.03, -0.02, 0.11), Vector3::new(-0.5, 0.2, 1.0)),
    ]
}

/// `robot` with six small motions after each joint but the last.
fn bent(robot: &Robot, stream: &mut arms::Stream) -> Robot {
    let mut motions = Vec::new();
    for motion in robot.chain().motions() {
        motions.push(*motion);
        if let Amount::Joint(joint) = motion.amount()
            && joint + 1 < robot.joints().len()
        {
            for axis in Axis::ALL {
                motions.push(Motion::Along(axis, Amount::Constant(stream.between(-1e-3, 1e-3))));
            }
            for axis in Axis::ALL {
                motions.push(Motion::About(axis, Amount::Constant(stream.between(-2e-3, 2e-3))));
            }
        }
    }
    Robot::new("bent", motions, robot.joints().to_vec()).unwrap()
}

fn measured(robot: &Robot, count: usize, turns: bool, stream: &mut arms::Stream) -> Vec<MeasuredPose> {
    let [tracker_from_base, flange_from_point] = frames();
    (0..count)
        .map(|_| {
            let joints = stream.joints(robot);
            let point = tracker_from_base * flange(robot, &joints) * flange_from_point;
            MeasuredPose {
                joints,
                position: point.translation.vector,
                rotation: turns.then_some(point.rotation),
            }
        })
        .collect()
}

fn question(requested: ParameterSet) -> Question {
    Question {
        requested,
        flange_from_point: Isometry::translation(0.0, 0.0, 0.1),
        turn_length: 0.3,
        prior: None,
    }
}

fn largest(found: &Calibrated, robot: &Robot, poses: &[MeasuredPose]) -> f64 {
    found
        .errors_of(robot, poses)
        .unwrap()
        .of_position()
        .unwrap()
        .largest
}

#[test]
fn a_bent_arm_is_predicted_where_it_was_not_measured_to_rounding() {
    let mut stream = arms::Stream(5);
    for robot in [
        arms::mh12(),
        arms::other::ur10(),
        arms::other::on_rail(&arms::mh12()),
        arms::other::iiwa14(),
    ] {
        for turns in [false, true] {
            let real = bent(&robot, &mut stream);
            let [train, validation] = [60, 40].map(|count| measured(&real, count, turns, &mut stream));
            let plain = fit(&robot, &train, &question(ParameterSet::BaseAndTool)).unwrap();
            let found = fit(&robot, &train, &question(ParameterSet::Geometry)).unwrap();
            // Mistakes of a thousandth are millimetres before; the selection leaves at most the product of two of them.
            assert!(largest(&plain, &robot, &validation) > 1e-3, "{}", robot.name());
            let after = largest(&found, &robot, &validation);
            assert!(after < 6e-6, "{} {turns}: {after}", robot.name());
            let angle = found
                .errors_of(&robot, &validation)
                .unwrap()
                .of_turn()
                .map_or(0.0, |turn| turn.largest);
            assert!(angle < 6e-6, "{}: {angle}", robot.name());
        }
    }
}

#[test]
fn the_calibrated_chain_reaches_what_the_fit_predicts() {
    let mut stream = arms::Stream(6);
    let robot = arms::other::ur10();
    let train = measured(&bent(&robot, &mut stream), 60, true, &mut stream);
    let found = fit(&robot, &train, &question(ParameterSet::Geometry)).unwrap();
    let calibrated = found.bare_robot(&robot).unwrap();
    for (pose, error) in train.iter().zip(&found.errors.position) {
        let point = found.tracker_from_base * flange(&calibrated, &pose.joints) * found.flange_from_point;
        assert!((pose.position - point.translation.vector - error).norm() < 1e-12);
    }
}

#[test]
fn six_turning_joints_have_four_errors_each_and_base_and_tool_whatever_the_arm() {
    // Everett: 4 R + 6, less what parallel axes share; positions alone do not see how the body is turned.
    let mut stream = arms::Stream(7);
    let robot = bent(&arms::mh12(), &mut stream);
    for (turns, count) in [(true, 30), (false, 27)] {
        let train = measured(&robot, 200, turns, &mut stream);
        let found = fit(&robot, &train, &question(ParameterSet::Geometry)).unwrap();
        // Axes that are parallel within 2 mrad: one length is still identified by less than a thousandth of its effect.
        let kept = found.estimates.len();
        assert!((count - 1..=count).contains(&kept), "{turns}: {kept}");
        assert_eq!(kept + found.redundant.len(), found.unknowns.len());
    }
}

#[test]
fn the_zero_of_the_first_joint_is_the_turn_of_the_base() {
    let mut stream = arms::Stream(8);
    let robot = arms::mh12();
    let found = fit(
        &robot,
        &measured(&robot, 40, true, &mut stream),
        &question(ParameterSet::Zeros),
    )
    .unwrap();
    let first = &found.redundant[0];
    assert_eq!(found.unknowns[first.unknown].place, ParameterLocation::After(0));
    assert_eq!(
        first
            .same_as
            .iter()
            .map(|k| found.unknowns[*k].place)
            .collect::<Vec<_>>(),
        [ParameterLocation::Base]
    );
    assert_eq!(found.redundant.len(), 1);
}

#[test]
fn wrong_zeros_are_found_within_their_uncertainties() {
    let robot = arms::mh12();
    let (mut inside, mut all) = (0, 0);
    for seed in 0..40 {
        let mut stream = arms::Stream(100 + seed);
        let mut joints = robot.joints().to_vec();
        let wrong: Vec<f64> = (0..6).map(|_| stream.between(-3e-3, 3e-3)).collect();
        for (joint, wrong) in joints.iter_mut().zip(&wrong) {
            joint.zero_offset += wrong;
        }
        let real = Robot::new("real", robot.chain().motions().to_vec(), joints).unwrap();
        let mut poses = measured(&real, 30, false, &mut stream);
        for pose in &mut poses {
            // Sum of twelve uniform numbers: nearly normal, standard deviation 1.
            pose.position +=
                Vector3::from_fn(|_, _| 5e-5 * (0..12).map(|_| stream.between(-0.5, 0.5)).sum::<f64>());
        }
        let found = fit(&robot, &poses, &question(ParameterSet::Zeros)).unwrap();
        for estimate in &found.estimates {
            if let ParameterLocation::After(joint) = estimate.unknown.place {
                all += 1;
                inside +=
                    usize::from((estimate.value - wrong[joint]).abs() < 1.96 * estimate.standard_uncertainty);
            }
        }
    }
    // 160 intervals of 95 %: fewer than 141 or all of them would be a chance below 1 in 1000.
    assert_eq!(all, 160);
    assert!((141..160).contains(&inside), "{inside}");
}

#[test]
fn turning_and_shifting_the_tracker_changes_nothing_but_the_frame() {
    let mut stream = arms::Stream(9);
    let robot = arms::mh12();
    let train = measured(&bent(&robot, &mut stream), 40, true, &mut stream);
    let moved_from_tracker = Isometry::new(Vector3::new(-1.0, 4.0, 0.2), Vector3::new(1.0, 2.0, -0.4));
    let moved: Vec<MeasuredPose> = train
        .iter()
        .map(|pose| MeasuredPose {
            joints: pose.joints.clone(),
            position: (moved_from_tracker
                * Isometry::translation(pose.position.x, pose.position.y, pose.position.z))
            .translation
            .vector,
            rotation: pose
                .rotation
                .map(|rotation| moved_from_tracker.rotation * rotation),
        })
        .collect();
    let [here, there] =
        [&train, &moved].map(|poses| fit(&robot, poses, &question(ParameterSet::Geometry)).unwrap());
    let back = moved_from_tracker.inverse() * there.tracker_from_base;
    assert!((back.to_homogeneous() - here.tracker_from_base.to_homogeneous()).norm() < 1e-8);
    for (a, b) in here.estimates.iter().zip(&there.estimates) {
        assert!((a.value - b.value).abs() < 1e-8, "{:?}", a.unknown);
    }
}

#[test]
fn invalid_measurements_are_refused() {
    let robot = arms::mh12();
    let mut stream = arms::Stream(10);
    let poses = measured(&robot, 12, true, &mut stream);
    let requested = question(ParameterSet::Geometry);
    assert!(matches!(
        fit(&robot, &poses[..3], &requested),
        Err(Refusal::TooFew { poses: 3, .. })
    ));
    let mut wrong = poses.clone();
    wrong[4].position.x = f64::NAN;
    assert!(matches!(
        fit(&robot, &wrong, &requested),
        Err(Refusal::Pose { index: 4, .. })
    ));
    wrong = poses.clone();
    wrong[2].joints.pop();
    assert!(matches!(
        fit(&robot, &wrong, &requested),
        Err(Refusal::Pose { index: 2, .. })
    ));
    wrong = poses.clone();
    wrong[7].rotation = None;
    assert_eq!(
        fit(&robot, &wrong, &requested),
        Err(Refusal::TurnsMissing { with: 11, poses: 12 })
    );
    let no_length = Question {
        turn_length: 0.0,
        ..requested
    };
    assert_eq!(fit(&robot, &poses, &no_length), Err(Refusal::TurnLength(0.0)));
}

#[test]
fn an_arm_that_did_not_move_identifies_nothing() {
    let robot = arms::mh12();
    let pose = measured(&robot, 1, false, &mut arms::Stream(3)).remove(0);
    let found = fit(&robot, &vec![pose; 20], &question(ParameterSet::Geometry)).unwrap();
    assert_eq!(found.estimates.len(), 3);
    assert!(found.errors.of_position().unwrap().largest < 1e-12);
}

fn with_prior(length: f64, angle: f64) -> Question {
    Question {
        prior: Some(Prior { length, angle }),
        ..question(ParameterSet::Geometry)
    }
}

/// Poses with readings that are off by noise of this standard deviation (m), and by a sag that no geometry has.
fn rough(
    robot: &Robot,
    count: usize,
    [noise, sag]: [f64; 2],
    stream: &mut arms::Stream,
) -> Vec<MeasuredPose> {
    let mut poses = measured(robot, count, false, stream);
    for pose in &mut poses {
        let mut draw = || (0..12).map(|_| stream.between(-0.5, 0.5)).sum::<f64>();
        let by = Vector3::new(draw(), draw(), draw()) * noise;
        let lever = pose.joints[1].sin() * pose.joints[2].cos();
        pose.position += by + Vector3::new(0.2, -0.3, 1.0) * sag * lever * lever;
    }
    poses
}

#[test]
fn a_wide_prior_changes_nothing_and_a_narrow_one_keeps_the_nominal_values() {
    let mut stream = arms::Stream(31);
    let robot = arms::other::ur10();
    let poses = rough(&bent(&robot, &mut stream), 80, [1e-4, 0.0], &mut stream);
    let free = fit(&robot, &poses, &question(ParameterSet::Geometry)).unwrap();
    let wide = fit(&robot, &poses, &with_prior(1e3, 1e3)).unwrap();
    assert_eq!(free.effective_parameters, free.estimates.len() as f64);
    assert!((wide.effective_parameters - free.effective_parameters).abs() < 1e-6);
    for (a, b) in free.estimates.iter().zip(&wide.estimates) {
        assert!((a.value - b.value).abs() < 1e-9, "{:?}", a.unknown);
        let ratio = a.standard_uncertainty / b.standard_uncertainty;
        assert!((ratio - 1.0).abs() < 1e-6, "{:?} {ratio}", a.unknown);
    }
    let narrow = fit(&robot, &poses, &with_prior(1e-9, 1e-9)).unwrap();
    let plain = fit(&robot, &poses, &question(ParameterSet::BaseAndTool)).unwrap();
    assert!(
        (narrow.effective_parameters - plain.estimates.len() as f64).abs() < 1e-3,
        "{}",
        narrow.effective_parameters
    );
    for (a, b) in narrow.errors.position.iter().zip(&plain.errors.position) {
        assert!((a - b).norm() < 1e-7);
    }
    let of_chain = narrow
        .estimates
        .iter()
        .filter(|one| matches!(one.unknown.place, ParameterLocation::After(_)));
    assert!(of_chain.clone().count() > 10);
    for one in of_chain {
        // Nothing is known but what was known before.
        assert!(one.value.abs() < 1e-8 && (one.standard_uncertainty / 1e-9 - 1.0).abs() < 1e-3);
    }
}

#[test]
fn the_scatter_is_that_of_the_readings_that_the_unknowns_leave() {
    let mut stream = arms::Stream(33);
    let robot = arms::other::ur10();
    let poses = rough(&bent(&robot, &mut stream), 300, [1e-4, 0.0], &mut stream);
    let found = fit(&robot, &poses, &with_prior(1e-3, 2e-3)).unwrap();
    let squares: f64 = found.errors.position.iter().map(Vector3::norm_squared).sum();
    let s = (squares / (900.0 - found.effective_parameters)).sqrt();
    assert!((found.standard_deviation / s - 1.0).abs() < 1e-9);
    // 870 degrees of freedom give a standard deviation to 2.4 %.
    assert!((s / 1e-4 - 1.0).abs() < 0.08, "{s}");
    assert!(found.effective_parameters < found.estimates.len() as f64 && found.effective_parameters > 9.0);
}

#[test]
fn with_few_poses_a_prior_predicts_others_better_than_none() {
    // Twelve poses have 36 readings for 25 unknowns.
    let mut stream = arms::Stream(35);
    let robot = arms::other::ur10();
    let mut sums = [0.0; 3];
    for _ in 0..10 {
        let real = bent(&robot, &mut stream);
        let few = rough(&real, 12, [3e-4, 0.0], &mut stream);
        let others = rough(&real, 100, [0.0, 0.0], &mut stream);
        let of = |question: &Question| {
            let found = fit(&robot, &few, question).unwrap();
            let errors = found.errors_of(&robot, &others).unwrap();
            errors.of_position().unwrap().rms
        };
        // Small motions of `bent` are even to 1 mm and 2 mrad: 0.58 of that is their standard deviation.
        let requested = [
            question(ParameterSet::BaseAndTool),
            question(ParameterSet::Geometry),
            with_prior(0.58e-3, 1.16e-3),
        ];
        for (sum, question) in sums.iter_mut().zip(&requested) {
            *sum += of(question) / 10.0;
        }
    }
    let [plain, free, prior] = sums;
    assert!(
        prior < 0.9 * free && prior < 0.5 * plain,
        "{plain} {free} {prior}"
    );
}

#[test]
fn a_prior_of_zero_or_infinite_width_is_refused() {
    let mut stream = arms::Stream(37);
    let robot = arms::other::ur10();
    let poses = measured(&robot, 40, false, &mut stream);
    for (length, angle) in [(0.0, 1.0), (1.0, -1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
        let refused = fit(&robot, &poses, &with_prior(length, angle)).unwrap_err();
        assert!(matches!(refused, Refusal::Prior(_)), "{refused}");
    }
    // Perfect poses leave no scatter, and no parameter is fixed.
    let found = fit(&robot, &poses, &with_prior(1e-3, 1e-3)).unwrap();
    assert!(found.estimates.iter().all(|one| one.value.abs() < 1e-9));
}
