//! The postures that a finder returns, their order, and what it remembers between poses.

use std::f64::consts::PI;

use super::*;
use crate::arms::{self, Stream, other};

fn expected<'a>(robot: &Robot, q: &[f64], near: Option<&'a [f64]>) -> InverseTarget<'a> {
    let flange = crate::robot::forward::forward(robot, q).base_from_flange;
    InverseTarget {
        base_from_flange: Isometry::from_parts(flange.translation, flange.rotation.into()),
        near,
        home: None,
    }
}

fn patterns() -> Vec<BranchPattern> {
    let words = [
        "front",
        "back elbow-up",
        "elbow-down flip",
        "no-flip",
        "front elbow-up no-flip",
    ];
    words.iter().map(|words| words.parse().unwrap()).collect()
}

#[test]
fn matching_returns_those_of_all_that_match() {
    let mut stream = Stream(41);
    for robot in [arms::hung(), other::ur10e(), other::on_rail(&arms::kr120())] {
        let mut finder = Finder::new(&robot);
        for _ in 0..50 {
            let q = stream.joints(&robot);
            let expected = expected(&robot, &q, None);
            let Ok(all) = finder.all(&expected) else { continue };
            let all = all.to_vec();
            for pattern in patterns() {
                let of_all: Vec<&InverseSolution> = all
                    .iter()
                    .filter(|found| found.name.branch().is_some_and(|branch| pattern.matches(branch)))
                    .collect();
                match finder.matching(&expected, pattern) {
                    Ok(matching) => {
                        assert_eq!(matching.len(), of_all.len());
                        for (a, b) in matching.iter().zip(of_all) {
                            assert_eq!(
                                (a.name, &a.joints, a.singularity),
                                (b.name, &b.joints, b.singularity)
                            );
                        }
                    }
                    Err(_) => assert!(of_all.is_empty()),
                }
            }
        }
    }
}

#[test]
fn postures_of_one_pose_are_distinct_and_reach_it() {
    let mut stream = Stream(42);
    let arms = [
        other::calibrated(&arms::mh12(), 5e-4),
        other::free("skewed", &other::SKEWED),
        other::iiwa14(),
        other::oblique(),
    ];
    for robot in arms {
        let mut finder = Finder::new(&robot);
        for _ in 0..5 {
            let q = stream.joints(&robot);
            let expected = expected(&robot, &q, None);
            finder.forget();
            let found = finder.all(&expected).unwrap_or_default().to_vec();
            for (i, a) in found.iter().enumerate() {
                let frames = crate::robot::forward::forward(&robot, &a.joints);
                assert_eq!(verify(&frames, &expected.base_from_flange), Ok(()));
                for b in &found[..i] {
                    let away = a
                        .joints
                        .iter()
                        .zip(&b.joints)
                        .map(|(a, b)| (0.5 * (a - b)).sin().abs());
                    assert!(
                        away.fold(0.0, f64::max) > 0.4 * SAME,
                        "{}: {a:?} {b:?}",
                        robot.name()
                    );
                }
            }
        }
    }
}

#[test]
fn postures_without_names_are_sorted_by_distance() {
    let robot = other::free("skewed", &other::SKEWED);
    let mut finder = Finder::new(&robot);
    let mut stream = Stream(43);
    let mut several = 0;
    for _ in 0..40 {
        let q = stream.joints(&robot);
        let near: Vec<f64> = q.iter().map(|q| q + stream.between(-0.05, 0.05)).collect();
        let found = finder.all(&expected(&robot, &q, Some(&near))).unwrap().to_vec();
        let away = |found: &InverseSolution| -> f64 {
            found.joints.iter().zip(&near).map(|(a, b)| (a - b).powi(2)).sum()
        };
        assert!(found.windows(2).all(|pair| away(&pair[0]) <= away(&pair[1])));
        // The posture of the pose is among them, unless its range ends between the two.
        let made: f64 = q.iter().zip(&near).map(|(a, b)| (a - b).powi(2)).sum();
        assert!(
            away(&found[0]) <= made + 1e-9 || q.iter().any(|q| q.abs() > PI - 0.06),
            "{made}"
        );
        several += usize::from(found.len() > 1);
        let one = finder
            .matching(&expected(&robot, &q, Some(&near)), BranchPattern::default())
            .unwrap();
        assert_eq!((one.len(), &one[0].joints), (1, &found[0].joints));
    }
    assert!(several > 20, "{several}");
}

#[test]
fn a_finder_after_forget_equals_a_new_one() {
    let robot = other::oblique();
    let mut stream = Stream(44);
    let mut used = Finder::new(&robot);
    for _ in 0..4 {
        let q = stream.joints(&robot);
        let expected = expected(&robot, &q, None);
        used.forget();
        let again: Vec<Vec<f64>> = used
            .all(&expected)
            .unwrap_or_default()
            .iter()
            .map(|found| found.joints.clone())
            .collect();
        let mut new = Finder::new(&robot);
        let fresh: Vec<Vec<f64>> = new
            .all(&expected)
            .unwrap_or_default()
            .iter()
            .map(|found| found.joints.clone())
            .collect();
        assert_eq!(again, fresh);
    }
}

#[test]
fn a_finder_follows_a_path_by_continuation() {
    let robot = other::oblique();
    let mut finder = Finder::new(&robot);
    let q = [0.3, -0.4, 0.5, -0.6, 0.7, -0.8];
    let mut before = finder.all(&expected(&robot, &q, None)).unwrap()[0].joints.clone();
    for step in 1..=20 {
        let moved = q.map(|q| q + 0.01 * f64::from(step));
        let found = finder
            .matching(&expected(&robot, &moved, None), BranchPattern::default())
            .unwrap();
        let away = found[0]
            .joints
            .iter()
            .zip(&before)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        // Each joint moved by 0.01 rad, or what another posture needs for that.
        assert!(away < 0.2, "step {step}: {away}");
        before.clone_from(&found[0].joints);
    }
}

#[test]
fn whole_turns_are_chosen_near_the_previous_joint_position() {
    // Joints of a UR turn by 360 deg to either side.
    let robot = other::ur10e();
    let mut finder = Finder::new(&robot);
    let q = [0.3, -1.2, 1.4, 5.0, 1.2, -5.5];
    let (called, _) = name(&robot, &q);
    let pattern = BranchPattern::from(called.branch().unwrap());
    let joint_position = |finder: &mut Finder<'_>, near: Option<&[f64]>| {
        finder.matching(&expected(&robot, &q, near), pattern).unwrap()[0]
            .joints
            .clone()
    };
    let near = joint_position(&mut finder, Some(&q));
    let middle = joint_position(&mut finder, None);
    for joint in 0..6 {
        assert!((near[joint] - q[joint]).abs() < 1e-9);
        assert!(middle[joint].abs() <= PI + 1e-9);
        assert!(
            ((middle[joint] - q[joint]) / TAU).fract().abs() < 1e-9
                || (0.5 * (middle[joint] - q[joint])).sin().abs() < 1e-9
        );
    }
    // A position outside the limits is not taken.
    let beyond = [0.3, -1.2, 1.4, 5.0, 1.2, -5.5 - TAU];
    let back = joint_position(&mut finder, Some(&beyond));
    assert!((back[5] - (-5.5 + TAU)).abs() < 1e-9, "{}", back[5]);
}

#[test]
fn out_of_reach_names_the_branch_that_misses_by_least() {
    let robot = arms::mh12();
    let mut finder = Finder::new(&robot);
    let far = InverseTarget {
        base_from_flange: Isometry::translation(4.0, 0.0, 0.5),
        near: None,
        home: None,
    };
    let least = finder.all(&far).unwrap_err();
    let mut others = Vec::new();
    for branch in Branch::ALL {
        others.push(finder.matching(&far, branch.into()).unwrap_err());
    }
    assert!(
        others.iter().all(|other| !other.is_nearer_than(&least)),
        "{least} {others:?}"
    );
    assert!(others.contains(&least));
    let searched = other::oblique();
    let miss = Finder::new(&searched).all(&far).unwrap_err();
    assert!(
        matches!(miss, Unreachable::NotFound { by, .. } if by > 1.0),
        "{miss}"
    );
}

#[test]
fn frames_that_miss_their_pose_are_refused() {
    let robot = arms::kr120();
    let q = Stream(46).joints(&robot);
    let frames = crate::robot::forward::forward(&robot, &q);
    let pose = expected(&robot, &q, None).base_from_flange;
    assert_eq!(verify(&frames, &pose), Ok(()));
    for by in [2e-9, 0.1] {
        let moved = Isometry::translation(by, 0.0, 0.0) * pose;
        let miss = verify(&frames, &moved).unwrap_err();
        assert!(
            matches!(miss, Unreachable::Unverified { by: given } if (given - by).abs() < 1e-12),
            "{miss}"
        );
        // Half a turn has sine zero, but is a rotation.
        for angle in [by, PI] {
            let turn = Isometry::rotation(nalgebra::Vector3::x() * angle);
            assert!(verify(&frames, &(pose * turn)).is_err(), "{angle}");
        }
    }
}

#[test]
fn the_properties_of_a_posture_found_are_those_at_its_joint_positions() {
    let mut stream = Stream(47);
    let arms = [
        arms::mh12(),
        arms::hung(),
        other::ur10e(),
        other::on_rail(&arms::r2000ic()),
        other::calibrated(&arms::mh12(), 5e-4),
    ];
    let tool = arms::bent_tool();
    for robot in arms {
        let mut finder = Finder::new(&robot);
        for _ in 0..20 {
            let q = stream.joints(&robot);
            let expected = InverseTarget {
                home: Some(&q),
                ..expected(&robot, &q, Some(&q))
            };
            let tcp = (expected.base_from_flange * tool).translation.vector.into();
            let count = finder.all(&expected).unwrap_or_default().len();
            assert!(count > 0, "{}", robot.name());
            for index in 0..count {
                let posture = finder.take_posture(index, &tcp, &tool);
                let frames = crate::robot::forward::forward(&robot, &posture.joints);
                let own = tool_at(&frames.base_from_flange, &tool).to_homogeneous();
                // Rounding of some ten turns and metres.
                assert!((posture.base_from_tool.to_homogeneous() - own).amax() < 1e-14);
                for (a, b) in screws_at(&robot, &frames, &tcp).iter().zip(&posture.screws) {
                    let apart = (a.to_vector() - b.to_vector()).amax();
                    assert!(apart < 1e-14, "{}: {apart}", robot.name());
                }
            }
        }
    }
}

#[test]
fn eight_at_once_are_the_postures_one_by_one() {
    let mut stream = Stream(48);
    let arms = arms::all().into_iter().chain([
        other::ur10e(),
        other::on_rail(&arms::kr120()),
        other::on_rail(&other::ur10e()),
    ]);
    for robot in arms {
        let mut finder = Finder::new(&robot);
        for round in 0..20 {
            let q = stream.joints(&robot);
            let near = (round % 2 == 1).then(|| stream.joints(&robot));
            let expected = InverseTarget {
                home: Some(&q),
                ..expected(&robot, &q, near.as_deref())
            };
            let all = finder.all(&expected).unwrap_or_default().to_vec();
            let one_by_one = Finder::new(&robot).all_one_by_one(&expected);
            assert_eq!(all.len(), one_by_one.len(), "{}", robot.name());
            for (a, b) in all.iter().zip(&one_by_one) {
                assert_eq!((a.name, a.singularity), (b.name, b.singularity));
                let apart = a.joints.iter().zip(&b.joints).map(|(a, b)| (a - b).abs());
                assert!(apart.fold(0.0, f64::max) < 1e-13, "{}: {a:?} {b:?}", robot.name());
            }
        }
    }
}

#[test]
fn a_search_in_lanes_finds_what_one_descent_after_the_other_finds() {
    let mut stream = Stream(49);
    let arms = [
        other::open_wrist(),
        other::oblique(),
        other::five_joints(),
        other::sliding(),
    ];
    for robot in arms {
        let mut finder = Finder::new(&robot);
        for _ in 0..6 {
            let q = stream.joints(&robot);
            let expected = expected(&robot, &q, None);
            finder.forget();
            let all = finder.all(&expected).unwrap_or_default().to_vec();
            let mut alone = Finder::new(&robot);
            alone.search_one_by_one(&expected);
            assert_eq!(all.len(), alone.found.len(), "{}", robot.name());
            for (a, b) in all.iter().zip(&alone.found) {
                assert_eq!((a.name, a.singularity), (b.name, b.singularity));
                let apart = a.joints.iter().zip(&b.joints).map(|(a, b)| (a - b).abs());
                assert!(apart.fold(0.0, f64::max) < 1e-9, "{}: {a:?} {b:?}", robot.name());
            }
        }
    }
}

impl Finder<'_> {
    /// The search, each descent by itself and to its end.
    fn search_one_by_one(&mut self, expected: &InverseTarget<'_>) {
        self.settle_home(expected);
        let goal = Requested::new(&expected.base_from_flange);
        let starts = Starts::within(&self.ranges());
        let mut theta = self.chain_positions(&self.home);
        let mut idle = 0;
        for start in 1..=400 {
            if idle == THOROUGH {
                break;
            }
            idle += 1;
            starts.point(start, &mut theta);
            let (descent, chain) = self.descent();
            let reached = descent.reach(chain, &goal, &mut theta).is_ok();
            if reached && !self.is_known(&theta, SAME) && self.keep_searched(expected, &theta).is_ok() {
                idle = 0;
            }
        }
        self.order(None, MOST);
    }

    /// The branches of a closed form, each converted to joint positions and verified by itself.
    fn all_one_by_one(&mut self, expected: &InverseTarget<'_>) -> Vec<InverseSolution> {
        self.settle_home(expected);
        let Inverse::Closed(form) = self.arm.inverse else {
            return Vec::new();
        };
        let arm_from_flange = self.base_from_arm().inv_mul(&expected.base_from_flange);
        let near = expected.near.map(|q| self.six_chain_positions(q));
        let branches = form.eight_branches(&arm_from_flange, BranchPattern::default(), near.as_ref());
        for branch in Branch::ALL {
            if let Ok((theta, singularity)) = branches.get(branch) {
                self.keep(expected, &theta, PostureName::Branch(branch), singularity)
                    .unwrap();
            }
        }
        self.found.clone()
    }
}
