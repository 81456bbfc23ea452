use std::f64::consts::PI;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{IsometryMatrix3, Matrix3, Point3, Vector3};
use armill_core::robot::forward::{forward, joint_axis};
use armill_core::robot::joint::{Coupling, Sign};
use armill_core::robot::{Amount, Motion};
use armill_core::robot::{Axis, Backlash, BacklashSide, Joint, JointCompliance, Mass, Spring, Structure};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::*;
use crate::robot::format::{self, Format, RobotReadOptions};
use armill_core::robot::{Attachment, Robot};

const UR10E: &str = include_str!("../../../../../robots/universal-robots/ur10e.toml");
const R2000IC: &str = include_str!("../../../../../robots/fanuc/r2000ic.toml");
const MH12: &str = include_str!("../../../../../robots/yaskawa/mh12.toml");

fn library(text: &str) -> RobotDescription {
    crate::robot::armill::read("arm.toml", "arm", text).unwrap()
}

fn read_again(text: &str, format: Format) -> RobotDescription {
    let options = RobotReadOptions {
        format: Some(format),
        tip: None,
    };
    format::read("arm".as_ref(), "arm", text.as_bytes(), &options)
        .unwrap_or_else(|problems| panic!("{problems}\n{text}"))
}

/// Greatest difference of the flange matrices of two robots at these positions, relative to the length of the arm.
fn apart(a: &Robot, b: &Robot, q: &[f64]) -> f64 {
    let [a_flange, b_flange] = [a, b].map(|robot| forward(robot, q).base_from_flange.to_homogeneous());
    (a_flange - b_flange).amax()
}

fn described(robot: Robot) -> RobotDescription {
    let mut found = RobotDescription::of_one_source(robot, "test", "here", "a test");
    found.title = "some <arm> & \"more\" -- -".to_owned();
    found
}

/// A motion of a calibrated chain: any axis, any amount.
fn constant() -> impl Strategy<Value = Motion> {
    let axis = (0..3_usize).prop_map(|index| Axis::ALL[index]);
    let small = prop_oneof![-1e-3..1e-3_f64, Just(0.0)];
    let angle = prop_oneof![small.clone(), -3.0..3.0_f64, Just(0.5 * PI), Just(-0.5 * PI)];
    prop_oneof![
        (axis.clone(), prop_oneof![small, -1.5..1.5_f64])
            .prop_map(|(axis, length)| Motion::Along(axis, Amount::Constant(length))),
        (axis, angle).prop_map(|(axis, angle)| Motion::About(axis, Amount::Constant(angle))),
    ]
}

/// An arm of up to seven joints, each with some constants before it, and joint positions.
fn arm() -> impl Strategy<Value = (Robot, Vec<f64>)> {
    let joint = (
        prop::collection::vec(constant(), 0..7),
        0..3_usize,
        prop::bool::weighted(0.15),
        any::<bool>(),
        -2.0..2.0_f64,
        -2.5..2.5_f64,
    );
    (
        prop::collection::vec(joint, 1..8),
        prop::collection::vec(constant(), 0..6),
    )
        .prop_map(|(parts, last)| {
            let (mut motions, mut joints, mut q) = (Vec::new(), Vec::new(), Vec::new());
            for (index, (constants, axis, slides, positive, offset, position)) in
                parts.into_iter().enumerate()
            {
                motions.extend(constants);
                let motion = if slides { Motion::Along } else { Motion::About };
                motions.push(motion(Axis::ALL[axis], Amount::Joint(index)));
                joints.push(Joint {
                    sign: if positive { Sign::Positive } else { Sign::Negative },
                    zero_offset: offset,
                    limits: Some(armill_core::robot::Limits {
                        lower: -2.6,
                        upper: 2.75,
                    }),
                    max_speed: (index % 2 == 0).then_some(1.25),
                    ..Joint::plain(format!("j{index}"))
                });
                q.push(position);
            }
            motions.extend(last);
            (Robot::new("arm", motions, joints).unwrap(), q)
        })
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(71),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn a_urdf_that_is_read_again_is_the_same_arm((robot, q) in arm()) {
        let found = described(robot);
        let exported = export(&found, ExportFormat::Urdf, &ExportOptions::default()).unwrap();
        let again = read_again(&exported.text, Format::Urdf);
        // Some hundred roundings of numbers up to ten metres, and of decimals of 1e-15.
        prop_assert!(apart(&found.robot, &again.robot, &q) < 1e-12, "{}", exported.text);
        for (own, read) in found.robot.joints().iter().zip(again.robot.joints()) {
            prop_assert_eq!(&own.name, &read.name);
            prop_assert_eq!(own.limits, read.limits);
            prop_assert_eq!(own.max_speed, read.max_speed);
        }
        // An independent reader: urdf-rs.
        let other = urdf_rs::read_from_string(&exported.text).unwrap();
        prop_assert_eq!(other.joints.len(), found.robot.joints().len() + 1);
    }

    #[test]
    fn denavit_hartenberg_tables_that_are_read_again_are_the_same_arm((robot, q) in arm()) {
        let found = described(robot);
        for convention in DhConvention::ALL {
            let options = ExportOptions { convention, ..ExportOptions::default() };
            match export(&found, ExportFormat::Dh, &options) {
                Ok(exported) => {
                    let again = read_again(&exported.text, Format::Dh);
                    // d of up to 1000 m, a few of them.
                    prop_assert!(apart(&found.robot, &again.robot, &q) < 1e-11, "{}", exported.text);
                }
                Err(error) => prop_assert!(matches!(error, ExportError::FarNormal { .. }), "{error}"),
            }
        }
    }

    /// Calibrated arms of Universal Robots: every axis tilted and shifted.
    #[test]
    fn a_calibrated_ur_is_read_again_from_its_calibration_file(
        small in prop::collection::vec(-3e-3..3e-3_f64, 36),
        q in prop::collection::vec(-3.0..3.0_f64, 6),
    ) {
        let found = calibrated_ur(&small);
        let exported = export(&found, ExportFormat::Ur, &ExportOptions::default()).unwrap();
        let again = read_again(&exported.text, Format::Ur);
        let controller = again.robot.frames()[0].base_from_frame;
        let flange = |robot: &Robot| forward(robot, &q).base_from_flange.to_homogeneous();
        let read = controller.inverse().to_homogeneous() * flange(&again.robot);
        prop_assert!((read - flange(&found.robot)).amax() < 1e-12, "{}", exported.text);
        prop_assert!(!exported.warnings.iter().any(|warning| warning.contains("flange")), "{:?}", exported.warnings);
    }
}

/// The UR10e with six small motions before each joint.
fn calibrated_ur(small: &[f64]) -> RobotDescription {
    let mut found = library(UR10E);
    let mut motions = Vec::new();
    for motion in found.robot.chain().motions() {
        if let Amount::Joint(joint) = motion.amount() {
            let own = &small[6 * joint..6 * joint + 6];
            motions.extend(
                Axis::ALL
                    .iter()
                    .zip(own)
                    .map(|(axis, by)| Motion::Along(*axis, Amount::Constant(*by))),
            );
            motions.extend(
                Axis::ALL
                    .iter()
                    .zip(&own[3..])
                    .map(|(axis, by)| Motion::About(*axis, Amount::Constant(*by))),
            );
        }
        motions.push(*motion);
    }
    found.robot = Robot::new("ur", motions, found.robot.joints().to_vec()).unwrap();
    found
}

#[test]
fn nominal_poses_of_a_ur_are_those_of_ur_description() {
    let exported = export(&library(UR10E), ExportFormat::Ur, &ExportOptions::default()).unwrap();
    let number = |link: &str, key: &str| -> f64 {
        let rest = exported.text.split(&format!("  {link}:\n")).nth(1).unwrap();
        let line = rest
            .lines()
            .find(|line| line.trim().starts_with(&format!("{key}:")))
            .unwrap();
        line.split(": ").nth(1).unwrap().parse().unwrap()
    };
    // config/ur10e/default_kinematics.yaml, without its roundings of 1e-9.
    for (link, [x, y, z, roll]) in [
        ("shoulder", [0.0, 0.0, 0.1807, 0.0]),
        ("upper_arm", [0.0, 0.0, 0.0, 0.5 * PI]),
        ("forearm", [-0.6127, 0.0, 0.0, 0.0]),
        ("wrist_1", [-0.57155, 0.0, 0.17415, 0.0]),
        ("wrist_2", [0.0, -0.11985, 0.0, 0.5 * PI]),
    ] {
        for (key, expected) in ["x", "y", "z", "roll", "pitch", "yaw"]
            .iter()
            .zip([x, y, z, roll, 0.0, 0.0])
        {
            assert!(
                (number(link, key) - expected).abs() < 1e-12,
                "{link} {key}\n{}",
                exported.text
            );
        }
    }
    assert!((number("wrist_3", "y") - 0.11655).abs() < 1e-12);
    assert!(exported.text.contains("\n  hash: calib_armill_"));
}

#[test]
fn other_arms_have_no_calibration_file_of_ur() {
    for text in [MH12, R2000IC] {
        let options = ExportOptions {
            coupling: Some(CoupledJoints::Own),
            ..ExportOptions::default()
        };
        let error = export(&library(text), ExportFormat::Ur, &options).unwrap_err();
        assert!(
            matches!(&error, ExportError::NotUr(why) if why.contains("axes")),
            "{error}"
        );
    }
    let one = described(
        Robot::new(
            "one",
            vec![Motion::About(Axis::Z, Amount::Joint(0))],
            vec![Joint::plain("a")],
        )
        .unwrap(),
    );
    let error = export(&one, ExportFormat::Ur, &ExportOptions::default()).unwrap_err();
    assert!(error.to_string().contains("1 joints, not six"), "{error}");
}

#[test]
fn what_is_behind_joint_six_of_a_ur_is_reported() {
    let mut found = library(UR10E);
    let mut motions = found.robot.chain().motions().to_vec();
    motions.push(Motion::Along(Axis::X, Amount::Constant(2e-4)));
    found.robot = Robot::new("ur", motions, found.robot.joints().to_vec()).unwrap();
    let exported = export(&found, ExportFormat::Ur, &ExportOptions::default()).unwrap();
    let warning = exported
        .warnings
        .iter()
        .find(|warning| warning.contains("0.2000 mm"))
        .unwrap();
    assert!(warning.contains("x y z roll pitch yaw = 0.0002 0 0"), "{warning}");
}

#[test]
fn a_coupled_joint_is_refused_followed_or_written_as_its_own_angle() {
    let found = library(R2000IC);
    let with = |format, coupling| {
        let options = ExportOptions {
            coupling,
            ..ExportOptions::default()
        };
        export(&found, format, &options)
    };
    for format in ExportFormat::ALL {
        let error = with(format, None).unwrap_err();
        assert!(matches!(error, ExportError::Coupled { .. }) && error.hint().contains("--coupling"));
    }
    for format in [ExportFormat::Ur, ExportFormat::Dh, ExportFormat::Mjcf] {
        let error = with(format, Some(CoupledJoints::Follower)).unwrap_err();
        assert!(matches!(error, ExportError::NoFollower(_)), "{error}");
    }
    // Its own angle: q3 + q2 in the place of q3.
    let own = with(ExportFormat::Urdf, Some(CoupledJoints::Own)).unwrap();
    assert!(
        own.warnings.iter().any(|warning| warning.contains("J3 +1 x J2")),
        "{:?}",
        own.warnings
    );
    let again = read_again(&own.text, Format::Urdf);
    let q = [0.3, -0.4, 0.2, 1.0, -0.7, 2.0];
    let flange = forward(&found.robot, &q).base_from_flange.to_homogeneous();
    let read = forward(&again.robot, &[q[0], q[1], q[2] + q[1], q[3], q[4], q[5]]);
    assert!((read.base_from_flange.to_homogeneous() - flange).amax() < 1e-12);
    let mimic = with(ExportFormat::Urdf, Some(CoupledJoints::Follower)).unwrap();
    assert!(
        mimic
            .text
            .contains("<mimic joint=\"J2\" multiplier=\"1\" offset=\"0\"/>"),
        "{}",
        mimic.text
    );
    let sdf = with(ExportFormat::Sdf, Some(CoupledJoints::Follower)).unwrap();
    assert!(sdf.text.contains("<mimic joint=\"J2\">"));
}

#[test]
fn the_limits_of_an_own_angle_contain_all_that_occur() {
    let joints = vec![
        Joint {
            limits: Some(armill_core::robot::Limits {
                lower: -1.0,
                upper: 2.0,
            }),
            ..Joint::plain("a")
        },
        Joint {
            coupling: vec![Coupling {
                joint: 0,
                factor: -0.5,
            }],
            limits: Some(armill_core::robot::Limits {
                lower: -0.3,
                upper: 0.4,
            }),
            ..Joint::plain("b")
        },
    ];
    let motions = vec![
        Motion::About(Axis::Z, Amount::Joint(0)),
        Motion::About(Axis::Y, Amount::Joint(1)),
    ];
    let found = described(Robot::new("two", motions, joints).unwrap());
    let options = ExportOptions {
        coupling: Some(CoupledJoints::Own),
        ..ExportOptions::default()
    };
    let text = export(&found, ExportFormat::Urdf, &options).unwrap().text;
    assert!(text.contains("lower=\"-1.3\" upper=\"0.9\""), "{text}");
}

/// Two joints, springs of every kind, masses at every place.
fn elastic() -> RobotDescription {
    let motions = vec![
        Motion::Along(Axis::Z, Amount::Constant(0.4)),
        Motion::About(Axis::Z, Amount::Joint(0)),
        Motion::Along(Axis::X, Amount::Constant(0.5)),
        Motion::About(Axis::Y, Amount::Joint(1)),
        Motion::Along(Axis::X, Amount::Constant(0.3)),
    ];
    let compliance = |value| JointCompliance {
        value,
        standard_uncertainty: 0.0,
    };
    let mass = |attachment, mass| Mass {
        attachment,
        mass,
        centre: Point3::new(0.1, 0.0, 0.2),
        inertia: Some(Matrix3::identity()),
        relative_uncertainty: 0.0,
    };
    let twist = |linear: Vector3<f64>, angular: Vector3<f64>| armill_core::spatial::Twist { linear, angular };
    let spring = |attachment, direction, value| Spring {
        attachment,
        direction,
        compliance: compliance(value),
    };
    let structure = Structure {
        springs: vec![
            spring(
                Attachment::Base,
                twist(Vector3::z() * 2.0, Vector3::zeros()),
                1e-8,
            ),
            // About z through (0, -0.1, 0).
            spring(
                Attachment::Joint(0),
                twist(Vector3::new(-0.1, 0.0, 0.0), Vector3::z()),
                2e-7,
            ),
            spring(Attachment::Joint(1), twist(Vector3::z(), Vector3::z()), 1e-7),
            spring(Attachment::Flange, twist(Vector3::zeros(), Vector3::x()), 4e-6),
        ],
        masses: vec![
            mass(Attachment::Base, 50.0),
            mass(Attachment::Joint(0), 20.0),
            mass(Attachment::Joint(0), 10.0),
            mass(Attachment::Joint(1), 5.0),
            mass(Attachment::Flange, 2.0),
            mass(Attachment::Tool, 1.0),
        ],
        backlash: vec![Some(Backlash {
            gap: 1e-4,
            standard_uncertainty: 0.0,
            side: BacklashSide::Motion,
        })],
        ..Structure::EMPTY
    };
    let robot = Robot::new("two", motions, ["a", "b"].map(Joint::plain).to_vec())
        .unwrap()
        .with_compliance(vec![compliance(1e-6), compliance(0.0)])
        .unwrap()
        .with_structure(structure)
        .unwrap();
    described(robot)
}

fn stiff(stiffness: ExportedStiffness) -> ExportOptions {
    ExportOptions {
        stiffness,
        joints: Some(vec![0.5, -0.25]),
        ..ExportOptions::default()
    }
}

#[test]
fn springs_are_passive_joints_with_the_inverse_of_their_compliance() {
    let options = stiff(ExportedStiffness::Passive);
    for format in [ExportFormat::Sdf, ExportFormat::Mjcf] {
        let exported = export(&elastic(), format, &options).unwrap();
        for words in [
            "a_spring",
            "base_structure_spring",
            "a_structure_spring",
            "flange_structure_spring",
        ] {
            assert!(
                exported.text.contains(&format!("name=\"{words}\"")),
                "{words}\n{}",
                exported.text
            );
        }
        // A rigid drive has none, and a screw is left out.
        for words in ["b_spring", "b_structure_spring"] {
            assert!(!exported.text.contains(words), "{words}");
        }
        // 1/1e-6, 1/(1e-8 2^2), 1/2e-7, 1/4e-6.
        for words in ["1000000", "25000000", "5000000", "250000"] {
            let [sdf, mjcf] = [
                format!("<spring_stiffness>{words}<"),
                format!("stiffness=\"{words}\""),
            ];
            assert!(
                exported.text.contains(&sdf) || exported.text.contains(&mjcf),
                "{words}\n{}",
                exported.text
            );
        }
        let said = exported.warnings.join("\n");
        for words in [
            "screw (pitch 1.000e0 m/rad)",
            "springs of the tool",
            "masses of the tool",
            "backlash",
        ] {
            assert!(
                said.contains(words) || words == "springs of the tool",
                "{words}\n{said}"
            );
        }
    }
    let mjcf = export(&elastic(), ExportFormat::Mjcf, &options).unwrap();
    assert!(
        mjcf.text.contains("pos=\"0 -0.1 0\" stiffness=\"5000000\""),
        "{}",
        mjcf.text
    );
    assert!(
        mjcf.text
            .contains("<key name=\"posture\" qpos=\"0 0.5 0 0 -0.25 0\"/>"),
        "{}",
        mjcf.text
    );
    assert!(
        mjcf.warnings
            .iter()
            .any(|warning| warning.contains("rotors of a are not known"))
    );
}

#[test]
fn a_joint_that_is_a_spring_keeps_the_given_posture() {
    let error = export(&elastic(), ExportFormat::Mjcf, &stiff(ExportedStiffness::Joints)).unwrap_err();
    assert_eq!(error, ExportError::Rigid("b".to_owned()));
    let mut found = elastic();
    found.robot = found
        .robot
        .with_compliance(vec![
            JointCompliance {
                value: 1e-6,
                standard_uncertainty: 0.0
            };
            2
        ])
        .unwrap();
    let mjcf = export(&found, ExportFormat::Mjcf, &stiff(ExportedStiffness::Joints)).unwrap();
    assert!(
        mjcf.text.contains("stiffness=\"1000000\" springref=\"-0.25\""),
        "{}",
        mjcf.text
    );
    assert!(!mjcf.text.contains("<motor"));
    let sdf = export(&found, ExportFormat::Sdf, &stiff(ExportedStiffness::Joints)).unwrap();
    assert!(
        sdf.text.contains("<spring_reference>0.5</spring_reference>"),
        "{}",
        sdf.text
    );
    let without = ExportOptions {
        joints: None,
        ..stiff(ExportedStiffness::Joints)
    };
    assert_eq!(
        export(&found, ExportFormat::Sdf, &without).unwrap_err(),
        ExportError::NoPosture
    );
    let many = ExportOptions {
        joints: Some(vec![0.0; 3]),
        ..without
    };
    let error = export(&found, ExportFormat::Sdf, &many).unwrap_err();
    assert_eq!(error, ExportError::PostureCount { given: 3, joints: 2 });
}

#[test]
fn stiffness_is_refused_where_it_is_not_known_or_not_expressed() {
    let mut found = elastic();
    for format in [
        ExportFormat::Urdf,
        ExportFormat::Xacro,
        ExportFormat::Ur,
        ExportFormat::Dh,
    ] {
        let error = export(&found, format, &stiff(ExportedStiffness::Passive)).unwrap_err();
        assert!(matches!(error, ExportError::NoStiffness(_)), "{error}");
    }
    found.robot = Robot::new(
        "two",
        found.robot.chain().motions().to_vec(),
        found.robot.joints().to_vec(),
    )
    .unwrap();
    let error = export(&found, ExportFormat::Sdf, &stiff(ExportedStiffness::Passive)).unwrap_err();
    assert_eq!(error, ExportError::NoCompliance);
    assert!(error.hint().contains("--compliance-class"));
}

#[test]
fn a_robot_without_stiffness_has_no_number_of_it() {
    for format in [ExportFormat::Sdf, ExportFormat::Mjcf] {
        let exported = export(&elastic(), format, &ExportOptions::default()).unwrap();
        assert!(
            !exported.text.contains("stiffness") && !exported.text.contains("_spring"),
            "{}",
            exported.text
        );
        assert!(
            exported
                .warnings
                .iter()
                .any(|warning| warning.contains("joint compliances, springs"))
        );
    }
}

#[test]
fn masses_are_read_again_from_a_urdf() {
    let found = elastic();
    let exported = export(
        &RobotDescription {
            robot: found.robot.clone(),
            ..found.clone()
        },
        ExportFormat::Urdf,
        &ExportOptions::default(),
    );
    // No limits: continuous joints.
    let again = read_again(&exported.unwrap().text, Format::Urdf);
    let q = [0.3, -0.8];
    let sum = |robot: &Robot| {
        let frames = forward(robot, &q);
        let masses = robot
            .structure()
            .masses
            .iter()
            .filter(|mass| mass.attachment != Attachment::Tool);
        masses
            .map(|mass| {
                let flange: IsometryMatrix3<f64> = frames.base_from_flange;
                let frame =
                    armill_core::robot::deflected_arm::attachment_frame(mass.attachment, &frames, &flange);
                let centre = frame * mass.centre;
                let about_base = Matrix3::identity() * centre.coords.norm_squared()
                    - centre.coords * centre.coords.transpose();
                let inertia = mass.inertia.unwrap_or_else(Matrix3::zeros);
                let turned = frame.rotation * inertia * frame.rotation.transpose();
                (
                    mass.mass,
                    centre.coords * mass.mass,
                    turned + about_base * mass.mass,
                )
            })
            .fold((0.0, Vector3::zeros(), Matrix3::zeros()), |a, b| {
                (a.0 + b.0, a.1 + b.1, a.2 + b.2)
            })
    };
    let (own, read) = (sum(&found.robot), sum(&again.robot));
    assert_eq!(own.0, read.0);
    assert!((own.1 - read.1).norm() < 1e-12 && (own.2 - read.2).norm() < 1e-11);
}

#[test]
fn a_prismatic_joint_without_limits_is_refused_in_a_urdf_only() {
    let motions = vec![Motion::Along(Axis::Y, Amount::Joint(0))];
    let found = described(Robot::new("rail", motions, vec![Joint::plain("rail")]).unwrap());
    for (format, fits) in [
        (ExportFormat::Urdf, false),
        (ExportFormat::Xacro, false),
        (ExportFormat::Sdf, true),
        (ExportFormat::Mjcf, true),
        (ExportFormat::Dh, true),
    ] {
        let exported = export(&found, format, &ExportOptions::default());
        assert_eq!(exported.is_ok(), fits, "{format:?}");
        if let Err(error) = exported {
            assert_eq!(error, ExportError::NoLimits("rail".to_owned()));
        }
    }
}

#[test]
fn frames_of_the_robot_file_come_back_from_a_urdf() {
    let found = library(MH12);
    let exported = export(&found, ExportFormat::Urdf, &ExportOptions::default()).unwrap();
    let again = read_again(&exported.text, Format::Urdf);
    assert_eq!(again.robot.frames(), found.robot.frames());
    assert_eq!(again.title, found.title);
    assert!(exported.text.contains("<cylinder") && exported.text.contains("<sphere"));
}

/// Two links, the second axis tilted in the plane of both by `tilt`.
fn nearly_parallel(tilt: f64) -> RobotDescription {
    let motions = vec![
        Motion::About(Axis::Z, Amount::Joint(0)),
        Motion::Along(Axis::X, Amount::Constant(0.7)),
        Motion::About(Axis::Y, Amount::Constant(tilt)),
        Motion::About(Axis::Z, Amount::Joint(1)),
        Motion::Along(Axis::X, Amount::Constant(0.5)),
    ];
    described(Robot::new("two", motions, ["a", "b"].map(Joint::plain).to_vec()).unwrap())
}

#[test]
fn nearly_parallel_axes_have_a_far_normal_which_hayati_has_not() {
    for tilt in [0.0, 1e-14, 1e-9, 1e-6, 1e-4, 1e-2, 0.3] {
        let found = nearly_parallel(tilt);
        for convention in DhConvention::ALL {
            let options = ExportOptions {
                convention,
                ..ExportOptions::default()
            };
            let exported = export(&found, ExportFormat::Dh, &options);
            let normal = 0.7 / tilt;
            match exported {
                Err(error) => {
                    assert!(
                        convention != DhConvention::Hayati && normal > 1000.0,
                        "{tilt}: {error}"
                    );
                    assert!(error.hint().contains("hayati"), "{error}");
                    let shown = format!("{normal:.3e} m away");
                    assert!(error.to_string().contains(&shown), "{error}\n{shown}");
                }
                Ok(exported) => {
                    let far = exported
                        .warnings
                        .iter()
                        .any(|warning| warning.contains("nearly parallel"));
                    let expected = convention != DhConvention::Hayati && tilt > 1e-11 && normal > 10.0;
                    assert_eq!(far, expected, "{tilt} {convention:?}");
                    let again = read_again(&exported.text, Format::Dh);
                    assert!(
                        apart(&found.robot, &again.robot, &[0.7, -1.9]) < 1e-10,
                        "{}",
                        exported.text
                    );
                }
            }
        }
    }
}

#[test]
fn the_table_of_an_arm_without_offsets_is_the_one_of_the_textbook() {
    let exported = export(&library(UR10E), ExportFormat::Dh, &ExportOptions::default()).unwrap();
    let rows: Vec<&str> = exported
        .text
        .lines()
        .filter(|line| line.starts_with('J'))
        .collect();
    assert_eq!(
        rows[..3],
        [
            "J1, revolute, 0, 180.7, 0, 90, 1, -360, 360",
            "J2, revolute, 180, 0, 612.7, 0, 1, -360, 360",
            "J3, revolute, 0, 0, 571.55, 0, 1, -180, 180",
        ],
        "{}",
        exported.text
    );
    assert!(!exported.text.contains("fixed"), "{}", exported.text);
}

#[test]
fn arguments_of_a_xacro_contain_what_the_calibration_moved() {
    let text = MH12.replace(
        "  { along = \"z\", length_mm = 614, symbol = \"lz\" },",
        "  { along = \"x\", length_mm = 0.3, symbol = \"calibrated\" },\n  { along = \"z\", length_mm = 614, symbol = \"lz\" },",
    );
    assert_ne!(text, MH12);
    let exported = export(&library(&text), ExportFormat::Xacro, &ExportOptions::default()).unwrap();
    let arguments = exported.arguments.unwrap();
    assert!(
        arguments.contains("\"U\":\n    # nominal: 0 0 0.614 0 0 0; moved by 0.3000 mm"),
        "{arguments}"
    );
    assert!(arguments.contains("    x: 0.0003\n"), "{arguments}");
    assert!(
        exported.text.contains("<xacro:armill_origin joint=\"U\"/>"),
        "{}",
        exported.text
    );
    let plain = export(&library(MH12), ExportFormat::Xacro, &ExportOptions::default()).unwrap();
    assert!(!plain.arguments.unwrap().contains("nominal:"));
}

#[test]
fn the_axes_of_frames_are_those_of_the_robot() {
    // The tree itself, before any format: axes and points at zero.
    let found = library(R2000IC);
    let options = ExportOptions {
        coupling: Some(CoupledJoints::Own),
        ..ExportOptions::default()
    };
    let linkage = Linkage::of(&found, &options).unwrap();
    let frames = forward(&found.robot, &[0.0; 6]);
    let mut here = Isometry::identity();
    for (index, body) in linkage.bodies.iter().enumerate() {
        here *= body.parent_from_body;
        let Some(joint) = index.checked_sub(1).filter(|joint| *joint < 6) else {
            continue;
        };
        let sign = found.robot.joints()[joint].sign.factor();
        let axis = here.rotation * body.joints[0].axis;
        assert!((axis - joint_axis(&found.robot, &frames, joint) * sign).norm() < 1e-14);
        assert!((here.translation.vector - frames.origin(joint).coords).norm() < 1e-14);
    }
}

#[test]
fn formats_are_known_by_name_and_by_ending() {
    for format in ExportFormat::ALL {
        assert_eq!(format.name().parse(), Ok(format));
    }
    assert_eq!(ExportFormat::of_ending("URDF"), Some(ExportFormat::Urdf));
    assert_eq!(ExportFormat::of_ending("step"), None);
    assert!(
        "step"
            .parse::<ExportFormat>()
            .unwrap_err()
            .contains("urdf, xacro, ur, dh, sdf, mjcf")
    );
    assert!(
        "craig"
            .parse::<DhConvention>()
            .unwrap_err()
            .contains("standard, modified, hayati")
    );
}

/// Names of the children of a model, or links and joints of a robot, in order.
fn names_in(text: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(text).unwrap();
    let root = document.root_element();
    let model = root
        .first_element_child()
        .filter(|child| child.has_tag_name("model"));
    let children = model.unwrap_or(root).children();
    children
        .filter_map(|child| Some(child.attribute("name")?.to_owned()))
        .collect()
}

#[test]
fn every_name_of_a_model_is_used_once() {
    let mut found = elastic();
    let joints = ["flange", "base"].map(Joint::plain).to_vec();
    found.robot = Robot::new("two", found.robot.chain().motions().to_vec(), joints)
        .unwrap()
        .with_compliance(vec![
            JointCompliance {
                value: 1e-6,
                standard_uncertainty: 0.0
            };
            2
        ])
        .unwrap()
        .with_structure(found.robot.structure().clone())
        .unwrap();
    let coupled = ExportOptions {
        coupling: Some(CoupledJoints::Follower),
        ..ExportOptions::default()
    };
    for (found, format, options) in [
        (&found, ExportFormat::Sdf, stiff(ExportedStiffness::Passive)),
        (&found, ExportFormat::Sdf, stiff(ExportedStiffness::Joints)),
        (&found, ExportFormat::Urdf, ExportOptions::default()),
        (
            &library(MH12),
            ExportFormat::Sdf,
            stiff(ExportedStiffness::Passive),
        ),
        (&library(R2000IC), ExportFormat::Sdf, coupled.clone()),
        (&library(R2000IC), ExportFormat::Urdf, coupled),
    ] {
        let text = export(found, format, &options).unwrap().text;
        let names = names_in(&text);
        assert!(names.len() > 5);
        for (index, name) in names.iter().enumerate() {
            assert!(!names[..index].contains(name), "{name}\n{text}");
        }
    }
}
