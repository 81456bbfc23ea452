//! What a robot refuses, each by the smallest change of a valid one, and the coordinates of its joints.

use std::f64::consts::PI;

use super::*;
use crate::arms;
use crate::robot::joint::{Coupling, Limits, Sign};
use crate::robot::{Amount, Attachment, Axis, Mass, Spring};

/// A revolute joint, a slide and another revolute joint.
fn motions() -> Vec<Motion> {
    vec![
        Motion::About(Axis::Z, Amount::Joint(0)),
        Motion::Along(Axis::X, Amount::Joint(1)),
        Motion::About(Axis::Y, Amount::Joint(2)),
        Motion::Along(Axis::Z, Amount::Constant(0.5)),
    ]
}

fn joints() -> Vec<Joint> {
    let with = |name: &str, lower, upper| Joint {
        limits: Some(Limits { lower, upper }),
        ..Joint::plain(name)
    };
    vec![with("A", -2.0, 2.0), with("rail", 0.0, 3.0), with("B", -1.0, 3.0)]
}

fn robot() -> Robot {
    Robot::new("some", motions(), joints()).unwrap()
}

fn compliance(value: f64, standard_uncertainty: f64) -> JointCompliance {
    JointCompliance {
        value,
        standard_uncertainty,
    }
}

/// Why the valid robot is refused after one change of its joints.
fn refused(change: impl FnOnce(&mut Vec<Joint>)) -> RobotError {
    let mut changed = joints();
    change(&mut changed);
    Robot::new("broken", motions(), changed).unwrap_err()
}

#[test]
fn the_error_of_an_invalid_chain_is_that_of_the_chain() {
    let error = Robot::new("rigid", motions()[3..].to_vec(), Vec::new()).unwrap_err();
    assert_eq!(error, RobotError::Chain(ChainError::NoJoint(1)));
    assert_eq!(
        error.to_string(),
        "the chain of 1 elementary motions has no joint"
    );
}

#[test]
fn the_number_of_joints_must_be_that_of_the_chain() {
    let error = refused(|joints| drop(joints.pop()));
    assert_eq!(error.to_string(), "the chain has 3 joints, but 2 are described");
    assert!(matches!(
        refused(|joints| joints.push(Joint::plain("C"))),
        RobotError::JointCount {
            in_chain: 3,
            described: 4
        }
    ));
}

#[test]
fn every_number_of_a_joint_must_be_finite() {
    type Break = fn(&mut Joint, f64);
    let parts: [(&str, Break); 5] = [
        ("zero offset", |joint, value| joint.zero_offset = value),
        ("lower limit", |joint, value| {
            joint.limits = Some(Limits {
                lower: value,
                upper: 1.0,
            });
        }),
        ("upper limit", |joint, value| {
            joint.limits = Some(Limits {
                lower: -1.0,
                upper: value,
            });
        }),
        ("maximal speed", |joint, value| joint.max_speed = Some(value)),
        ("coupling factor", |joint, factor| {
            joint.coupling = vec![Coupling { joint: 0, factor }];
        }),
    ];
    for (what, set) in parts {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let error = refused(|joints| set(&mut joints[2], value));
            assert_eq!(error.to_string(), format!("joint B: its {what} is not finite"));
        }
    }
}

#[test]
fn a_range_must_not_be_empty() {
    for (lower, upper) in [(1.0, 1.0), (1.0, -1.0)] {
        let error = refused(|joints| joints[0].limits = Some(Limits { lower, upper }));
        assert_eq!(
            error.to_string(),
            format!("joint A: lower limit {lower} is not below upper limit {upper} (rad or m)")
        );
    }
    // The smallest range is valid.
    let mut least = joints();
    least[0].limits = Some(Limits {
        lower: 1.0,
        upper: 1.0_f64.next_up(),
    });
    Robot::new("least", motions(), least).unwrap();
}

#[test]
fn only_an_earlier_joint_can_be_coupled() {
    for other in [1, 2, 7] {
        let error = refused(|joints| {
            joints[1].coupling = vec![Coupling {
                joint: other,
                factor: 1.0,
            }];
        });
        assert_eq!(
            error.to_string(),
            format!(
                "joint rail is coupled to joint number {other}: it can only be coupled to an earlier joint"
            )
        );
    }
}

#[test]
fn compliances_are_one_per_joint_from_zero_to_the_softest() {
    let with = |list: &[JointCompliance]| robot().with_compliance(list.to_vec());
    let error = with(&[compliance(1e-6, 0.0); 2]).unwrap_err();
    assert_eq!(error.to_string(), "2 compliances for 3 joints");
    let sound = compliance(1e-6, 1e-7);
    for value in [-1e-300, SOFTEST.next_up(), f64::NAN, f64::INFINITY] {
        let error = with(&[sound, compliance(value, 0.0), sound]).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("joint rail: compliance {value} rad/(N m) is not a number from 0 to 1")
        );
        let error = with(&[sound, sound, compliance(0.0, value)]).unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("joint B: standard uncertainty of compliance"),
            "{error}"
        );
    }
    // Both ends of the range are in it: a rigid joint, and the softest.
    let ends = [compliance(0.0, 0.0), compliance(SOFTEST, SOFTEST), sound];
    assert_eq!(with(&ends).unwrap().compliance(), Some(&ends[..]));
}

#[test]
fn a_structure_is_checked_against_its_robot() {
    let structure = Structure {
        masses: vec![Mass {
            attachment: Attachment::Joint(3),
            mass: 1.0,
            centre: nalgebra::Point3::origin(),
            inertia: None,
            relative_uncertainty: 0.0,
        }],
        ..Structure::EMPTY
    };
    let error = robot().with_structure(structure.clone()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a mass names joint number 4, which does not exist or is prismatic"
    );
    // The same structure fits an arm with a joint more.
    arms::mh12().with_structure(structure).unwrap();
    let spring = Spring::about(
        Attachment::Joint(1),
        nalgebra::Vector3::x(),
        compliance(1e-7, 0.0),
    );
    let with_spring = Structure {
        springs: vec![spring],
        ..Structure::EMPTY
    };
    assert_eq!(
        robot().with_structure(with_spring.clone()).unwrap().structure(),
        &with_spring
    );
}

#[test]
fn joint_positions_are_recovered_from_chain_positions() {
    let mut stream = arms::Stream(1);
    for _ in 0..200 {
        let mut any = joints();
        for (index, joint) in any.iter_mut().enumerate() {
            joint.sign = if stream.next() < 0.5 {
                Sign::Positive
            } else {
                Sign::Negative
            };
            joint.zero_offset = stream.between(-PI, PI);
            joint.coupling = (0..index)
                .map(|joint| Coupling {
                    joint,
                    factor: stream.between(-2.0, 2.0),
                })
                .collect();
        }
        let robot = Robot::new("any", motions(), any).unwrap();
        let q: Vec<f64> = (0..3).map(|_| stream.between(-3.0, 3.0)).collect();
        let mut back = Vec::new();
        for index in 0..3 {
            let theta = robot.theta(index, &q);
            back.push(robot.joint_position(index, theta, &back));
        }
        for (a, b) in q.iter().zip(&back) {
            // Some sums of numbers of ten.
            assert!((a - b).abs() < 1e-13, "{q:?} {back:?}");
        }
    }
}

#[test]
fn chain_positions_follow_the_sign_the_zero_and_the_coupling() {
    let mut any = joints();
    any[2].sign = Sign::Negative;
    any[2].zero_offset = 0.25;
    any[2].coupling = vec![Coupling {
        joint: 0,
        factor: 0.5,
    }];
    let robot = Robot::new("any", motions(), any).unwrap();
    // -(q3 + q1 / 2) + 1/4
    assert_eq!(robot.theta(2, &[1.0, 0.0, 2.0]), -2.25);
    assert_eq!(robot.joint_position(2, -2.25, &[1.0, 0.0]), 2.0);
    assert_eq!(robot.theta(0, &[1.0, 0.0, 2.0]), 1.0);
}

#[test]
fn a_joint_is_prismatic_where_its_motion_is_along_an_axis() {
    let slides: Vec<bool> = (0..3).map(|joint| robot().slides(joint)).collect();
    assert_eq!(slides, [false, true, false]);
}

#[test]
fn middles_are_zero_where_there_are_no_limits() {
    assert_eq!(robot().middles(), [0.0, 1.5, 1.0]);
    let mut free = joints();
    free[2].limits = None;
    assert_eq!(
        Robot::new("free", motions(), free).unwrap().middles(),
        [0.0, 1.5, 0.0]
    );
}

#[test]
fn the_margin_is_that_of_the_joint_nearest_to_its_limit() {
    let robot = robot();
    assert_eq!(robot.limit_margin(&[0.0, 1.5, 2.5]), Some((2, 0.5)));
    assert_eq!(robot.limit_margin(&[0.0, 3.25, 1.0]), Some((1, -0.25)));
    // Outside at two joints: the one that is farther outside.
    assert_eq!(robot.limit_margin(&[2.5, 3.25, 1.0]), Some((0, -0.5)));
    // Exactly at a limit the margin is zero, and the joint is not outside.
    assert_eq!(robot.limit_margin(&[2.0, 1.0, 1.0]), Some((0, 0.0)));
    let free = Robot::new("free", motions(), ["A", "r", "B"].map(Joint::plain).to_vec()).unwrap();
    assert_eq!(free.limit_margin(&[9.0, 9.0, 9.0]), None);
}

#[test]
fn a_robot_returns_what_it_was_given() {
    let frame = NamedFrame {
        name: "controller".to_owned(),
        base_from_frame: Isometry::translation(0.0, 0.0, 0.45),
    };
    let pattern: BranchPattern = "back elbow-down flip".parse().unwrap();
    let robot = robot()
        .with_frames(vec![frame.clone()])
        .with_nominal_branch(pattern);
    assert_eq!(
        (robot.name(), robot.frames(), robot.nominal_branch()),
        ("some", &[frame][..], pattern)
    );
    assert_eq!(robot.compliance(), None);
    assert_eq!(robot.joints(), &joints()[..]);
    assert!(robot.ortho_parallel().is_none() && !robot.inverse().has_branches());
    assert_eq!(
        Robot::new("a", motions(), joints()).unwrap().nominal_branch(),
        BranchPattern::FRONT_ELBOW_UP
    );
}

const DRIVE: JointCompliance = JointCompliance {
    value: 2e-6,
    standard_uncertainty: 1e-7,
};

#[test]
fn replaced_compliances_remove_curves_and_covariance() {
    let joint = Joint::plain("A");
    let rising = crate::robot::TorqueCurve::new(vec![[-500.0, -1e-3], [500.0, 1e-3]]).unwrap();
    let curve = crate::robot::torque_curve::JointCurve {
        rising,
        falling: None,
    };
    let structure = Structure {
        springs: vec![Spring::about(Attachment::Base, nalgebra::Vector3::x(), DRIVE)],
        curves: vec![Some(curve)],
        covariance: Some(nalgebra::DMatrix::identity(2, 2) * 1e-14),
        ..Structure::EMPTY
    };
    let motions = vec![Motion::About(Axis::Z, Amount::Joint(0))];
    let robot = Robot::new("one joint", motions, vec![joint])
        .and_then(|robot| robot.with_compliance(vec![DRIVE]))
        .and_then(|robot| robot.with_structure(structure.clone()))
        .unwrap();
    let softer = JointCompliance { value: 5e-6, ..DRIVE };
    let other = robot.with_other_compliance(vec![softer]).unwrap();
    assert_eq!(other.compliance(), Some(&[softer][..]));
    let left = Structure {
        springs: structure.springs,
        ..Structure::EMPTY
    };
    assert_eq!(*other.structure(), left);
}
