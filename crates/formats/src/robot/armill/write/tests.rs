use armill_core::robot::inverse::posture_at;
use armill_core::robot::joint::{Coupling, Sign};
use armill_core::robot::model::NamedFrame;
use armill_core::robot::{Axis, Limits, Robot};
use proptest::prelude::*;

use super::super::read;
use super::*;

/// A quarter turn as some sources print it.
const QUARTER_CUT: f64 = std::f64::consts::FRAC_PI_2 - 5e-12;

fn described(robot: Robot) -> RobotDescription {
    RobotDescription::of_one_source(robot, "there", "a \"strange\" \\ place\n", "numbers")
}

fn amount() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(0.155),
        Just(std::f64::consts::FRAC_PI_2),
        Just(QUARTER_CUT),
        -4.0..4.0f64,
        -1e-9..1e-9f64,
    ]
}

fn robots() -> impl Strategy<Value = Robot> {
    let step = (amount(), 0..6usize);
    let joint = (any::<bool>(), amount(), any::<bool>(), 0..6usize);
    prop::collection::vec((prop::collection::vec(step, 0..4), joint), 1..8).prop_map(|links| {
        let axis = |kind: usize| Axis::ALL[kind % 3];
        let motion = |kind: usize, amount| match kind < 3 {
            true => Motion::Along(axis(kind), amount),
            false => Motion::About(axis(kind), amount),
        };
        let (mut motions, mut joints) = (Vec::new(), Vec::new());
        for (steps, (against, zero_offset, known, kind)) in links {
            motions.extend(
                steps
                    .into_iter()
                    .map(|(by, kind)| motion(kind, Amount::Constant(by))),
            );
            let index = joints.len();
            motions.push(motion(kind, Amount::Joint(index)));
            let coupling = (known && index > 0).then_some(Coupling {
                joint: index.saturating_sub(1),
                factor: 0.1 + zero_offset,
            });
            joints.push(Joint {
                sign: if against { Sign::Negative } else { Sign::Positive },
                zero_offset,
                coupling: coupling.into_iter().collect(),
                limits: known.then_some(Limits {
                    lower: zero_offset - 1.0,
                    upper: zero_offset + 2.0,
                }),
                max_speed: known.then_some(3.8397),
                ..Joint::plain(format!("j \"{index}\""))
            });
        }
        Robot::new("a", motions, joints).unwrap()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_written_file_reads_back_as_the_same_arm(
        robot in robots(),
        seeds in prop::collection::vec(-3.0..3.0f64, 8),
        at in prop::array::uniform3(amount()),
        turn in prop::array::uniform3(-3.0..3.0f64),
    ) {
        let frame = NamedFrame {
            name: "controller".to_owned(),
            base_from_frame: armill_core::frame::from_xyz_and_fixed_angles(at.into(), turn.into()),
        };
        let robot = robot.with_frames(vec![frame]);
        let text = write(&described(robot.clone()));
        let again = read("a.toml", "a", &text).map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?;
        let again = again.robot;
        let q = &seeds[..robot.joints().len()];
        let pose = |robot: &Robot| posture_at(robot, q, &Isometry::identity()).base_from_tool.to_homogeneous();
        // Eight links of a few metres, each number within 1e-15.
        prop_assert!((pose(&robot) - pose(&again)).norm() < 1e-12, "{text}");
        let frames = |robot: &Robot| robot.frames()[0].base_from_frame.to_homogeneous();
        prop_assert!((frames(&robot) - frames(&again)).norm() < 1e-12);
        for (a, b) in robot.joints().iter().zip(again.joints()) {
            prop_assert_eq!(&a.name, &b.name);
            prop_assert_eq!(&a.coupling, &b.coupling);
            prop_assert_eq!(a.limits.is_some(), b.limits.is_some());
            if let (Some(a), Some(b)) = (a.limits, b.limits) {
                prop_assert!((a.lower - b.lower).abs() < 1e-8 && (a.upper - b.upper).abs() < 1e-8);
            }
        }
    }
}

#[test]
fn round_numbers_are_written_round() {
    assert_eq!(millimetres(0.155, CHAIN), "155");
    assert_eq!(millimetres(-0.1475, CHAIN), "-147.5");
    assert_eq!(degrees(std::f64::consts::PI, CHAIN), "180");
    assert_eq!(degrees(-0.0, CHAIN), "0");
    assert_eq!(degrees(3.839724354387525, RANGE), "220");
    // A quarter turn cut after the eleventh decimal stays what it is.
    assert!(degrees(QUARTER_CUT, CHAIN).starts_with("89.99999999971"));
}

#[test]
fn missing_numbers_are_written_as_comments() {
    let robot = Robot::new(
        "a",
        vec![Motion::About(Axis::Z, Amount::Joint(0))],
        vec![Joint::plain("A")],
    )
    .unwrap();
    let text = write(&described(robot));
    for words in [
        "# - the joints' compliances",
        "# - 1 of 1 joints: limits",
        "# compliance_rad_per_n_m = ...",
        "# Inverse: numeric from many starts",
    ] {
        assert!(text.contains(words), "no `{words}` in\n{text}");
    }
}

#[test]
fn rotations_beyond_a_turn_and_close_limits_are_written_readably() {
    for (angle, limits) in [
        (11.0, [0.0, 1.7e-11]),
        (-7.0, [1.0, 1.0 + 3e-16]),
        (6.3, [-1e-300, 0.0]),
    ] {
        let motions = vec![
            Motion::About(Axis::Z, Amount::Constant(angle)),
            Motion::Along(Axis::X, Amount::Constant(1.0)),
            Motion::About(Axis::Y, Amount::Joint(0)),
        ];
        let joint = Joint {
            limits: Some(Limits {
                lower: limits[0],
                upper: limits[1],
            }),
            ..Joint::plain("A")
        };
        let robot = Robot::new("odd", motions, vec![joint]).unwrap();
        let text = write(&described(robot.clone()));
        let back = read("odd.toml", "odd", &text).unwrap().robot;
        let pose = |robot: &Robot| {
            let posture = posture_at(robot, &[0.3], &Isometry::identity());
            posture.base_from_tool.to_homogeneous()
        };
        assert!((pose(&robot) - pose(&back)).norm() < 1e-14, "{text}");
        let kept = back.joints()[0].limits.unwrap();
        assert!((kept.lower - limits[0]).abs() < 1e-15 && (kept.upper - limits[1]).abs() < 1e-15);
    }
}
