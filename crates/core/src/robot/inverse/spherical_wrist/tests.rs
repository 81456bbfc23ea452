//! The range limits of wrists that are not perpendicular, and the arm seen from its flange.

use super::*;
use crate::arms::Stream;
use crate::arms::other::{self, DhRow};
use crate::robot::{Amount, Motion, Robot};

fn wrist_of(rows: &[DhRow; 6]) -> (Robot, SphericalWrist) {
    let robot = other::free("some", rows);
    let form = SphericalWrist::recognise(robot.chain()).unwrap();
    (robot, form)
}

/// The chain from flange to base: its joints in reversed order, each position with the other sign.
fn reversed(chain: &Chain) -> Chain {
    let motions = chain.motions().iter().rev().map(|motion| match *motion {
        Motion::Along(axis, Amount::Constant(value)) => Motion::Along(axis, Amount::Constant(-value)),
        Motion::About(axis, Amount::Constant(value)) => Motion::About(axis, Amount::Constant(-value)),
        Motion::Along(axis, Amount::Joint(joint)) => Motion::Along(axis, Amount::Joint(5 - joint)),
        Motion::About(axis, Amount::Joint(joint)) => Motion::About(axis, Amount::Joint(5 - joint)),
    });
    Chain::new(motions.collect()).unwrap()
}

fn same(a: &[f64; 6], b: &[f64; 6]) -> bool {
    let away = |(a, b): (&f64, &f64)| (a - b).sin().abs() + (1.0 - (a - b).cos());
    // Joints near the end of a branch are accurate to the root of rounding.
    a.iter().zip(b).map(away).all(|away| away < 1e-5)
}

#[test]
fn an_arm_and_the_same_arm_seen_from_its_flange_have_the_same_postures() {
    let mut stream = Stream(21);
    for rows in [other::SKEWED, other::TILTED_WRIST, other::SPHERICAL_SHOULDER] {
        let (robot, form) = wrist_of(&rows);
        let there = reversed(robot.chain());
        let mirrored = SphericalWrist::recognise(&there).unwrap();
        assert_ne!(form.reversed, mirrored.reversed);
        for _ in 0..50 {
            let theta = [0; 6].map(|_| stream.between(-PI, PI));
            let pose = robot.chain().base_from_flange(&theta);
            let own = form.chain_positions(&pose, None);
            let seen = mirrored.chain_positions(&pose.inverse(), None);
            assert_eq!(own.len(), seen.len());
            assert!(own.iter().any(|found| same(found, &theta)), "{theta:?} {own:?}");
            for [a, b, c, d, e, f] in seen {
                let back = [-f, -e, -d, -c, -b, -a];
                assert!(own.iter().any(|found| same(found, &back)), "{back:?} {own:?}");
            }
        }
    }
}

/// The rotation that puts axis 6 at the angle `gamma` (rad) from axis 4.
fn axis_6_at(form: &SphericalWrist, gamma: f64) -> Rotation3<f64> {
    let [z4, z6] = [3, 5].map(|i| form.lines[i].axis);
    let normal = nalgebra::Unit::new_normalize(z4.cross(&z6));
    Rotation3::from_axis_angle(&normal, gamma - z4.cross(&z6).norm().atan2(z4.dot(&z6)))
}

#[test]
fn a_wrist_reaches_from_the_difference_of_its_angles_to_their_sum() {
    for rows in [other::SKEWED, other::TILTED_WRIST] {
        let (_, form) = wrist_of(&rows);
        let (least, most) = ((form.alpha - form.beta).abs(), form.alpha + form.beta);
        let count = |gamma: f64| form.wrist(&axis_6_at(&form, gamma), None).len();
        assert_eq!((count(most - 1e-3), count(most + 1e-3)), (2, 0), "{least} {most}");
        assert_eq!(count(0.5 * (least + most)), 2);
        if least > 0.01 {
            assert_eq!((count(least + 1e-3), count(least - 1e-3)), (2, 0));
        }
    }
}

#[test]
fn both_postures_of_a_wrist_make_the_whole_turn() {
    let mut stream = Stream(22);
    let (_, form) = wrist_of(&other::TILTED_WRIST);
    let mut twice = 0;
    for _ in 0..200 {
        let expected = Rotation3::new(stream.vector(2.0));
        let found = form.wrist(&expected, None);
        for [d, e, f] in &found {
            let made = form.lines[3].rotation(*d) * form.lines[4].rotation(*e) * form.lines[5].rotation(*f);
            assert!((made.matrix() - expected.matrix()).norm() < 1e-7);
        }
        twice += usize::from(found.len() == 2);
    }
    assert!(twice > 50, "{twice}");
}

#[test]
fn a_straight_wrist_leaves_its_first_joint_where_it_was() {
    // Axes 4 and 6 in line: the wrist of a puma at zero.
    let (_, form) = wrist_of(&other::PUMA_LIKE);
    let straight = form.lines[3].rotation(0.8);
    let z6 = form.lines[5].axis;
    let gamma = form.lines[3].axis.cross(&(straight * z6)).norm();
    assert!(gamma < 1e-12);
    for kept in [0.3, -1.1] {
        let found = form.wrist(&straight, Some(kept));
        assert!(found.iter().all(|[d, ..]| *d == kept), "{found:?}");
    }
    let [d, _, f] = form.wrist(&straight, None)[0];
    let side = form.lines[3].axis.dot(&z6).signum();
    assert!(
        (d - f * side).abs() < 1e-9,
        "joints 4 and 6 share the turn: {d} {f}"
    );
}

#[test]
fn wrists_with_neighbouring_axes_nearly_parallel_are_refused() {
    for (alpha, taken) in [(0.04, false), (0.06, true), (PI - 0.04, false)] {
        let mut rows = other::SKEWED;
        rows[3][2] = alpha;
        let robot = other::free("some", &rows);
        assert_eq!(
            SphericalWrist::recognise(robot.chain()).is_some(),
            taken,
            "{alpha}"
        );
    }
}

#[test]
fn axes_that_miss_a_point_by_a_micrometre_are_a_calibrated_wrist() {
    let mut rows = other::SKEWED;
    rows[4][1] = 1e-6;
    let robot = other::free("some", &rows);
    assert!(SphericalWrist::recognise(robot.chain()).is_none());
    assert!(!SphericalWrist::next_to(robot.chain()).unwrap().is_exact());
    rows[4][1] = 5.0 * CALIBRATED;
    let robot = other::free("some", &rows);
    assert!(SphericalWrist::next_to(robot.chain()).is_none());
}
