//! Each part separately, on our own arm; library arms and whole distortions are tested with the library.

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
        reference_from_tool: *pose,
    };
    Q.iter().zip(poses).map(reading).collect()
}

fn compared<R>(robot: &Robot, read: &[Reading], use_it: impl Fn(&Comparison<'_>) -> R) -> R {
    use_it(&Comparison {
        robot,
        base_from_reference: &Isometry::identity(),
        flange_from_tool: &Isometry::identity(),
        readings: read,
        within: PoseDifference {
            metres: 1e-6,
            radians: 1e-6,
        },
    })
}

#[test]
fn changed_joints_match_an_arm_with_these_joints() {
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
fn sets_contain_no_two_changes_of_one_zero() {
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
fn height_rotation_and_unit_are_found_from_the_readings() {
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
fn frames_without_effect_are_not_an_explanation() {
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
    // Half a turn of joints 4 and 6 with joint 5 reversed changes nothing.
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

/// More postures than [`Q`], all general.
const MORE: [[f64; 6]; 4] = [
    Q[0],
    Q[1],
    [1.1, -0.3, 0.2, 1.9, 0.7, -0.4],
    [-1.3, -0.8, 0.6, -1.2, -1.4, 2.3],
];

/// Readings of the file's arm, with these changes of its joints.
fn shown(file: &Robot, changes: &[Change], at: &[[f64; 6]]) -> Vec<Reading> {
    let reading = |q: &[f64; 6]| {
        let positions = positions_of_the_file(file, changes, q);
        Reading {
            joints: q.to_vec(),
            reference_from_tool: posture_at(file, &positions, &Isometry::identity()).base_from_tool,
        }
    };
    at.iter().map(reading).collect()
}

fn verdict(file: &Robot, read: &[Reading]) -> Verdict {
    compared(file, read, |comparison| {
        inspect(comparison, Watch::NONE).unwrap().verdict
    })
}

/// The changes of the only explanation.
fn explained(file: &Robot, read: &[Reading]) -> Vec<Change> {
    match verdict(file, read) {
        Verdict::Explained { explanation, .. } => explanation.changes,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_free_zero_and_a_coupling_are_found() {
    let file = arm(|_| {});
    let off = arm(|joints| joints[1].zero_offset += 0.1234);
    let readings = |pendant: &Robot| -> Vec<Reading> {
        let of = |q: &[f64; 6]| Reading {
            joints: q.to_vec(),
            reference_from_tool: posture_at(pendant, q, &Isometry::identity()).base_from_tool,
        };
        MORE.iter().map(of).collect()
    };
    let [
        Change::Zero {
            joint: 1,
            by,
            free: true,
        },
    ] = explained(&file, &readings(&off))[..]
    else {
        panic!("no free zero");
    };
    assert!((by - 0.1234).abs() < 1e-9, "{by}");
    for factor in [1.0, -1.0] {
        let coupled = arm(|joints| joints[2].coupling = vec![Coupling { joint: 1, factor }]);
        let change = Change::Coupling {
            joint: 2,
            other: 1,
            factor,
        };
        assert_eq!(explained(&file, &readings(&coupled)), [change]);
    }
}

#[test]
fn two_equally_simple_explanations_are_undecided() {
    // With joint 5 straight, joints 4 and 6 turn about one axis: their zeros are not distinguishable.
    let file = arm(|_| {});
    let straight = MORE.map(|mut q| {
        q[4] = 0.0;
        q
    });
    let zero = |joint| Change::Zero {
        joint,
        by: FRAC_PI_2,
        free: false,
    };
    let Verdict::Undecided(explanations) = verdict(&file, &shown(&file, &[zero(3)], &straight)) else {
        panic!("decided");
    };
    let changes: Vec<&[Change]> = explanations.iter().map(|e| &e.changes[..]).collect();
    assert!(
        changes.contains(&&[zero(3)][..]) && changes.contains(&&[zero(5)][..]),
        "{changes:?}"
    );
    assert!(explanations.iter().all(|e| e.apart.metres < 1e-6));
    // A bent wrist decides.
    assert_eq!(explained(&file, &shown(&file, &[zero(3)], &MORE)), [zero(3)]);
}

#[test]
fn a_tilted_axis_is_unexplained() {
    let file = arm(|_| {});
    let mut motions = file.chain().motions().to_vec();
    motions.insert(4, Motion::About(Axis::X, Amount::Constant(0.05)));
    let tilted = Robot::new("tilted", motions, file.joints().to_vec()).unwrap();
    let read: Vec<Reading> = MORE[..3]
        .iter()
        .map(|q| Reading {
            joints: q.to_vec(),
            reference_from_tool: posture_at(&tilted, q, &Isometry::identity()).base_from_tool,
        })
        .collect();
    assert_eq!(verdict(&file, &read), Verdict::Unexplained);
}

#[test]
fn two_changes_are_explained_by_at_most_two() {
    let file = arm(|_| {});
    let listed = joint_changes(&file);
    let mut stream = crate::arms::Stream(71);
    let pick = |stream: &mut crate::arms::Stream| listed[(stream.next() * listed.len() as f64) as usize];
    for _ in 0..25 {
        let (first, second) = (pick(&mut stream), pick(&mut stream));
        let mut fits = false;
        visit_sets(&[first, second], 2, &mut |_| {
            fits = true;
            Ok::<(), ()>(())
        })
        .unwrap();
        let made = if fits { vec![first, second] } else { vec![first] };
        let explanations = match verdict(&file, &shown(&file, &made, &MORE)) {
            Verdict::Explained { explanation, .. } => vec![explanation],
            Verdict::Undecided(explanations) => explanations,
            Verdict::Unexplained => panic!("{made:?} is unexplained"),
        };
        let count = |changes: &[Change]| changes.iter().map(Change::count).sum::<usize>();
        for explanation in explanations {
            assert!(
                count(&explanation.changes) <= count(&made),
                "{made:?}: {explanation:?}"
            );
            // The readings agree with every explanation.
            assert!(explanation.apart.metres < 1e-6 && explanation.apart.radians < 1e-6);
        }
    }
}

#[test]
fn a_joint_at_zero_hides_its_sign() {
    let file = arm(|_| {});
    let at_zero = MORE.map(|mut q| {
        q[0] = 0.0;
        q
    });
    let Verdict::Explained { explanation, unseen } = verdict(&file, &shown(&file, &[], &at_zero)) else {
        panic!("the file is right");
    };
    assert_eq!(explanation.changes, []);
    assert!(unseen.contains(&Change::Sign { joint: 0 }), "{unseen:?}");
    assert!(!unseen.contains(&Change::Sign { joint: 1 }));
}

#[test]
fn readings_of_a_right_file_agree_and_differences_are_reported() {
    let file = arm(|_| {});
    let mut read = shown(&file, &[], &MORE);
    read[2].reference_from_tool = Isometry::translation(0.0, 0.03, 0.04) * read[2].reference_from_tool;
    let apart = compared(&file, &read, |comparison| {
        inspect(comparison, Watch::NONE).unwrap().of_the_file
    });
    assert!((apart[2].metres - 0.05).abs() < 1e-12 && apart[2].radians < 1e-7);
    assert!([0, 1, 3].into_iter().all(|i| apart[i].metres < 1e-12));
}

#[test]
fn refuses_too_many_revolute_joints_with_a_reason() {
    let count = search::MOST_TURNING + 1;
    let motions = (0..count).flat_map(|joint| {
        let axis = if joint % 2 == 0 { Axis::Z } else { Axis::Y };
        [
            Motion::About(axis, Amount::Joint(joint)),
            Motion::Along(Axis::X, Amount::Constant(0.1)),
        ]
    });
    let snake = Robot::new("snake", motions.collect(), vec![Joint::plain("j"); count]).unwrap();
    let refused = compared(&snake, &[], |comparison| {
        inspect(comparison, Watch::NONE).unwrap_err()
    });
    assert_eq!(refused, NotInspected::TooManyJoints { turning: 13 });
    assert!(
        refused.to_string().starts_with("13 revolute joints exceed"),
        "{refused}"
    );
}

#[test]
fn a_search_is_cancelled_between_two_sets() {
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
    let file = arm(|_| {});
    let read = shown(
        &file,
        &[Change::Sign { joint: 0 }, Change::Sign { joint: 2 }],
        &MORE,
    );
    let (tried, cancel) = (AtomicUsize::new(0), AtomicBool::new(false));
    let finished = |sets: usize| {
        let before = tried.fetch_add(sets, Ordering::Relaxed);
        cancel.store(before + sets >= 7, Ordering::Relaxed);
    };
    let watch = Watch {
        finished: &finished,
        cancel: &cancel,
    };
    let stopped = compared(&file, &read, |comparison| inspect(comparison, watch).unwrap_err());
    assert_eq!(stopped, NotInspected::Cancelled(crate::watch::Cancelled));
    assert_eq!(tried.load(Ordering::Relaxed), 7);
}

#[test]
fn sets_are_in_the_order_of_the_list_and_an_error_ends_them() {
    let listed = [0, 1, 2, 3].map(|joint| Change::Sign { joint });
    let mut seen = Vec::new();
    let visited = visit_sets(&listed, 2, &mut |set| {
        let joints: Vec<usize> = set
            .iter()
            .filter_map(|change| match change {
                Change::Sign { joint } => Some(*joint),
                _ => None,
            })
            .collect();
        seen.push([joints[0], joints[1]]);
        if seen.len() == 4 { Err("enough") } else { Ok(()) }
    });
    assert_eq!(visited, Err("enough"));
    assert_eq!(seen, [[0, 1], [0, 2], [0, 3], [1, 2]]);
}

#[test]
fn the_worse_of_two_distances_is_the_worse_of_each() {
    let (a, b) = (
        PoseDifference {
            metres: 1.0,
            radians: 0.1,
        },
        PoseDifference {
            metres: 0.5,
            radians: 0.2,
        },
    );
    let worse = a.or_worse(b);
    assert_eq!((worse.metres, worse.radians), (1.0, 0.2));
    assert!(a.is_within(&worse) && b.is_within(&worse) && !worse.is_within(&a));
    let pose = Isometry::translation(0.3, 0.0, 0.4) * Isometry::rotation(Vector3::z() * 0.7);
    let found = PoseDifference::between(&Isometry::identity(), &pose);
    assert!((found.metres - 0.5).abs() < 1e-15 && (found.radians - 0.7).abs() < 1e-12);
}
