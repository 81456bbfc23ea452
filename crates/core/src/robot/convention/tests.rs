//! Each part by itself, on an arm of our own; library arms and whole distortions are tested with the library.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{UnitQuaternion, Vector3};

use super::change::{joint_changes, positions_of_the_file, visit_sets};
use super::frames::{Free, FreeBase, fit};
use super::*;
use crate::frame::Isometry;
use crate::robot::inverse::posture_at;
use crate::robot::joint::{Coupling, Sign};
use crate::robot::{Amount, Axis, Joint, Motion};
use crate::watch::Watch;

const Q: [[f64; 6]; 2] = [
    [0.2, -0.6, 0.4, 0.7, -0.9, 1.1],
    [-0.4, -1.0, 0.8, -0.5, 0.6, -2.0],
];

fn arm(change: impl Fn(&mut [Joint])) -> Robot {
    let (along, about) = (
        |axis, m| Motion::Along(axis, Amount::Constant(m)),
        |axis, joint| Motion::About(axis, Amount::Joint(joint)),
    );
    let motions = vec![
        along(Axis::Z, 0.5),
        about(Axis::Z, 0),
        along(Axis::X, 0.2),
        about(Axis::Y, 1),
        along(Axis::Z, 0.9),
        about(Axis::Y, 2),
        along(Axis::X, 0.8),
        about(Axis::X, 3),
        about(Axis::Y, 4),
        along(Axis::X, 0.1),
        about(Axis::X, 5),
        Motion::About(Axis::Y, Amount::Constant(FRAC_PI_2)),
    ];
    let mut joints = vec![Joint::plain("j"); 6];
    joints[2].sign = Sign::Negative;
    joints[3].zero_offset = 0.3;
    change(&mut joints);
    Robot::new("arm", motions, joints).unwrap()
}

fn flanges(robot: &Robot) -> Vec<Isometry> {
    Q.iter()
        .map(|q| posture_at(robot, q, &Isometry::identity()).base_from_tool)
        .collect()
}

fn readings(poses: &[Isometry]) -> Vec<Reading> {
    let reading = |(q, pose): (&[f64; 6], &Isometry)| Reading {
        joints: q.to_vec(),
        counted_from_tool: *pose,
    };
    Q.iter().zip(poses).map(reading).collect()
}

fn compared<R>(robot: &Robot, read: &[Reading], use_it: impl Fn(&Comparison<'_>) -> R) -> R {
    use_it(&Comparison {
        robot,
        base_from_counted: &Isometry::identity(),
        flange_from_tool: &Isometry::identity(),
        readings: read,
        within: Apart {
            metres: 1e-6,
            radians: 1e-6,
        },
    })
}

#[test]
fn changed_joints_stand_where_an_arm_with_these_joints_stands() {
    let file = arm(|_| {});
    let pendant = arm(|joints| {
        joints[0].sign = Sign::Negative;
        joints[1].zero_offset = FRAC_PI_2;
        joints[2].coupling = vec![Coupling {
            joint: 1,
            factor: -1.0,
        }];
        joints[3].sign = Sign::Negative;
        joints[3].zero_offset = 0.3 + PI;
    });
    let changes = [
        Change::Sign { joint: 0 },
        Change::Zero {
            joint: 1,
            by: FRAC_PI_2,
            free: false,
        },
        Change::Coupling {
            joint: 2,
            other: 1,
            factor: -1.0,
        },
        Change::Sign { joint: 3 },
        Change::Zero {
            joint: 3,
            by: PI,
            free: false,
        },
    ];
    for q in Q {
        let positions = positions_of_the_file(&file, &changes, &q);
        for joint in 0..6 {
            let (a, b) = (file.theta(joint, &positions), pendant.theta(joint, &q));
            assert!((a - b).abs() < 1e-14, "joint {joint}: {a} and {b} rad");
        }
    }
}

#[test]
fn sets_hold_no_two_changes_of_one_zero() {
    let listed = joint_changes(&arm(|_| {}));
    // Six signs, three zeros for each of six joints, two couplings.
    assert_eq!(listed.len(), 6 + 18 + 2);
    let count = |size| {
        let mut count = 0;
        let visited = visit_sets(&listed, size, &mut |set| {
            assert_eq!(set.len(), size);
            count += 1;
            Ok::<(), ()>(())
        });
        visited.map(|()| count)
    };
    assert_eq!(count(0), Ok(1));
    assert_eq!(count(1), Ok(26));
    // Pairs, less three of each joint's zeros, less the two couplings.
    assert_eq!(count(2), Ok(26 * 25 / 2 - 6 * 3 - 1));
}

#[test]
fn height_turn_and_unit_are_found_from_the_readings() {
    let file = arm(|_| {});
    let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), FRAC_PI_2);
    let shown = |flange: &Isometry| {
        let mut pose = Isometry::translation(0.0, 0.0, -0.3) * flange * turn;
        pose.translation.vector /= 25.4;
        pose
    };
    let poses: Vec<Isometry> = flanges(&file).iter().map(shown).collect();
    let free = Free {
        base: FreeBase::Height,
        flange: true,
        inches: true,
    };
    compared(&file, &readings(&poses), |comparison| {
        let (changes, apart) = fit(comparison, &flanges(&file), free).unwrap();
        assert!(apart.metres < 1e-12 && apart.radians < 1e-7, "{apart:?}");
        let [
            Change::FlangeTurn { turn: found },
            Change::BaseHeight { by },
            Change::Inches,
        ] = changes[..]
        else {
            panic!("{changes:?}");
        };
        assert!(found.angle_to(&turn) < 1e-7 && (by - 0.3).abs() < 1e-12);
    });
}

#[test]
fn frames_that_would_change_nothing_are_no_explanation() {
    let file = arm(|_| {});
    compared(&file, &readings(&flanges(&file)), |comparison| {
        for count in 1..=2 {
            for free in Free::counting(count).into_iter().filter(|free| !free.inches) {
                assert_eq!(fit(comparison, &flanges(&file), free), None, "{free:?}");
            }
        }
    });
}

#[test]
fn a_base_elsewhere_is_found_as_a_shift() {
    let file = arm(|_| {});
    let shift = Vector3::new(0.1, -0.2, 0.3);
    let moved: Vec<Isometry> = flanges(&file)
        .iter()
        .map(|flange| Isometry::from_parts(shift.into(), UnitQuaternion::identity()).inverse() * flange)
        .collect();
    let verdict = compared(&file, &readings(&moved), |comparison| {
        inspect(comparison, Watch::NONE).unwrap().verdict
    });
    let Verdict::Explained { explanation, .. } = verdict else {
        panic!("{verdict:?}");
    };
    let [Change::BaseShift { by }] = explanation.changes[..] else {
        panic!("{explanation:?}");
    };
    assert!((by - shift).norm() < 1e-12);
}

#[test]
fn fewer_changes_are_preferred() {
    // A turn of the wrist by half a turn at joints 4 and 6 with joint 5 counted the other way is no change at all.
    let file = arm(|_| {});
    let same = arm(|joints| {
        joints[3].zero_offset += PI;
        joints[4].sign = Sign::Negative;
        joints[5].zero_offset += PI;
    });
    let verdict = compared(&file, &readings(&flanges(&same)), |comparison| {
        inspect(comparison, Watch::NONE).unwrap().verdict
    });
    let Verdict::Explained { explanation, .. } = verdict else {
        panic!("{verdict:?}");
    };
    assert_eq!(explanation.changes, []);
}
