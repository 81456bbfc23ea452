//! Postures in lanes are those found one by one; the posture of a fixed joint away from home; reused memory.

use super::super::super::super::forward::forward;
use super::super::super::super::jacobian::screws_at;
use super::super::super::super::model::Robot;
use super::super::super::kind::Inverse;
use super::super::super::verify::verify;
use super::super::{MOST, name, tool_at};
use super::*;
use crate::arms::{self, Stream, other};

/// An arm like an iiwa whose elbow is 80 mm beside upper arm and forearm.
fn with_bent_elbow() -> Robot {
    let mut rows = other::IIWA14;
    (rows[2][1], rows[3][1]) = (0.08, -0.08);
    other::of_rows("bent", &rows, &[170.0; 7])
}

fn expected<'a>(robot: &Robot, q: &[f64], near: Option<&'a [f64]>, home: &'a [f64]) -> InverseTarget<'a> {
    let flange = forward(robot, q).base_from_flange;
    InverseTarget {
        base_from_flange: Isometry::from_parts(flange.translation, flange.rotation.into()),
        near,
        home: Some(home),
    }
}

impl Finder<'_> {
    /// The postures of a closed form with its fixed joint at home, refined, converted and verified one by one.
    fn one_by_one(&mut self, requested: &InverseTarget<'_>) -> Vec<InverseSolution> {
        self.settle_home(requested);
        let arm_from_flange = self.base_from_arm().inv_mul(&requested.base_from_flange);
        let near = requested.near.map(|q| self.chain_positions(q));
        let (still, all): (Option<usize>, Vec<Vec<f64>>) = match self.arm.inverse {
            Inverse::OneFixed(fixed) => {
                let index = self.arm.first + fixed.joint;
                let angle = self.robot.theta(index, &self.home);
                self.fixed = Some((index, self.home[index]));
                let kept = near.and_then(|near| fixed.without(&near));
                let six = fixed.at(angle).unwrap();
                let six = six.chain_positions(&arm_from_flange, kept.as_ref());
                let all = six.iter().map(|six| fixed.with(angle, six).to_vec());
                (Some(fixed.joint), all.collect())
            }
            Inverse::SphericalWrist(form) => {
                let kept = near.map(|near| near.try_into().unwrap());
                let all = form.chain_positions(&arm_from_flange, kept.as_ref());
                (None, all.iter().map(|theta| theta.to_vec()).collect())
            }
            _ => (None, Vec::new()),
        };
        for mut theta in all {
            if self.is_refined(&arm_from_flange, still, &mut theta) && !self.is_known(&theta, SAME) {
                self.keep_searched(requested, &theta).ok();
            }
        }
        self.fixed = None;
        self.order(requested.near, MOST);
        self.found.clone()
    }
}

fn is_inside(robot: &Robot, found: &InverseSolution) -> bool {
    robot
        .limit_margin(&found.joints)
        .is_none_or(|(_, margin)| margin >= 0.0)
}

/// A pose of `robot` with its previous positions and home; every third is near a singularity of its wrist or elbow.
fn pose(robot: &Robot, stream: &mut Stream, round: usize) -> [Vec<f64>; 3] {
    let mut q = stream.joints(robot);
    let last = q.len() - 1;
    if round.is_multiple_of(3) {
        let bent = [0.0, 1e-10, 1e-6, 3e-4, 2e-3, 6e-3, 0.03][round % 7];
        q[last - if round.is_multiple_of(2) { 1 } else { 3 }] = bent;
    }
    let near = q.iter().map(|q| q + stream.between(-0.2, 0.2)).collect();
    let mut home: Vec<f64> = q.iter().map(|_| 0.0).collect();
    // The fixed joint where it made the pose, at its zero, or anywhere; a rail where it is.
    let fixed = last - 4;
    home[fixed] = [q[fixed], 0.0, stream.between(-1.0, 1.0)][round / 3 % 3];
    let rail = q.len().saturating_sub(7);
    home[..rail].copy_from_slice(&q[..rail]);
    [q, near, home]
}

#[test]
fn postures_in_lanes_are_those_found_one_by_one() {
    let mut stream = Stream(61);
    let arms = [
        other::iiwa14(),
        with_bent_elbow(),
        other::on_rail(&other::iiwa14()),
        other::calibrated(&other::iiwa14(), 5e-4),
        other::free("skewed", &other::SKEWED),
        other::free("shoulder", &other::SPHERICAL_SHOULDER),
    ];
    for robot in arms {
        let mut finder = Finder::new(&robot);
        let (mut same, mut away) = (0, 0);
        for round in 0..2000 {
            let [q, near, home] = pose(&robot, &mut stream, round);
            let near = (round % 2 == 1).then_some(&near[..]);
            let requested = expected(&robot, &q, near, &home);
            finder.forget();
            let all = finder.all(&requested).map(<[_]>::to_vec);
            let one_by_one = Finder::new(&robot).one_by_one(&requested);
            let searched = one_by_one.is_empty();
            let left_home = matches!(finder.arm.inverse, Inverse::OneFixed(_))
                && !one_by_one.iter().any(|found| is_inside(&robot, found))
                && all
                    .as_ref()
                    .is_ok_and(|all| all.iter().any(|found| is_inside(&robot, found)));
            for found in all.as_deref().unwrap_or_default() {
                let frames = forward(&robot, &found.joints);
                assert_eq!(verify(&frames, &requested.base_from_flange), Ok(()));
                assert_eq!(name(&robot, &found.joints), (found.name, found.singularity));
            }
            if searched || left_home {
                away += 1;
                continue;
            }
            let all = all.unwrap();
            assert_eq!(all.len(), one_by_one.len(), "{}: {round} {q:?}", robot.name());
            for a in &all {
                // Near the end of a branch joints are accurate to the root of rounding; axes in line leave two free.
                let within = if round.is_multiple_of(3) { SAME } else { 1e-6 };
                let is_same = |b: &&InverseSolution| {
                    let apart = a.joints.iter().zip(&b.joints).map(|(a, b)| (a - b).abs());
                    apart.fold(0.0, f64::max) < within
                };
                let b = one_by_one.iter().find(is_same);
                assert!(b.is_some(), "{}: {round} {a:?} {one_by_one:?}", robot.name());
                let b = b.unwrap();
                assert_eq!(a.singularity, b.singularity, "{}: {round}", robot.name());
                let middles = robot.middles();
                if a.joints
                    .iter()
                    .zip(&middles)
                    .all(|(a, middle)| (a - middle).abs() > within)
                {
                    assert_eq!(a.name, b.name, "{}: {round}", robot.name());
                }
            }
            // In the same order, but for those equally far.
            let from = near.unwrap_or(&home);
            let away_from = |found: &InverseSolution| -> f64 {
                found.joints.iter().zip(from).map(|(a, b)| (a - b).powi(2)).sum()
            };
            assert!(
                all.windows(2)
                    .all(|pair| away_from(&pair[0]) <= away_from(&pair[1]))
            );
            same += 1;
        }
        println!("{}: {same} the same, {away} elsewhere", robot.name());
        assert!(same > 1000, "{}: {same}", robot.name());
    }
}

#[test]
fn a_joint_that_leaves_home_stops_at_the_postures_found_one_by_one_there() {
    let robot = other::iiwa14();
    let mut stream = Stream(62);
    let mut finder = Finder::new(&robot);
    let mut left = 0;
    for _ in 0..400 {
        let q = stream.joints(&robot);
        let home = [0.0; 7];
        let found = finder
            .all(&expected(&robot, &q, Some(&home), &home))
            .unwrap()
            .to_vec();
        if found[0].joints[2] == 0.0 {
            continue;
        }
        left += 1;
        let mut there = home;
        there[2] = found[0].joints[2];
        let requested = expected(&robot, &q, Some(&home), &there);
        let one_by_one = Finder::new(&robot).one_by_one(&requested);
        assert!(one_by_one.iter().any(|found| is_inside(&robot, found)));
        assert_eq!(found.len(), one_by_one.len());
        for (a, b) in found.iter().zip(&one_by_one) {
            let apart = a.joints.iter().zip(&b.joints).map(|(a, b)| (a - b).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-6, "{a:?} {b:?}");
        }
    }
    assert!(left > 5, "{left}");
}

#[test]
fn the_properties_of_a_posture_without_name_are_those_at_its_joint_positions() {
    let mut stream = Stream(63);
    let tool = arms::bent_tool();
    let arms = [
        other::iiwa14(),
        other::on_rail(&other::iiwa14()),
        other::calibrated(&other::iiwa14(), 5e-4),
        other::free("tilted", &other::TILTED_WRIST),
        other::oblique(),
    ];
    for robot in arms {
        let mut finder = Finder::new(&robot);
        let poses = if matches!(finder.arm.inverse, Inverse::Searched) {
            3
        } else {
            200
        };
        for round in 0..poses {
            let [q, near, home] = pose(&robot, &mut stream, round);
            let requested = expected(&robot, &q, Some(&near), &home);
            let tcp = (requested.base_from_flange * tool).translation.vector.into();
            let found = finder.all(&requested).unwrap_or_default().to_vec();
            for (index, found) in found.iter().enumerate() {
                let posture = finder.take_posture(index, &tcp, &tool);
                assert_eq!((posture.name, &posture.joints), (found.name, &found.joints));
                let frames = forward(&robot, &posture.joints);
                let own = tool_at(&frames.base_from_flange, &tool).to_homogeneous();
                assert!((posture.base_from_tool.to_homogeneous() - own).amax() < 1e-14);
                for (a, b) in screws_at(&robot, &frames, &tcp).iter().zip(&posture.screws) {
                    assert!((a.to_vector() - b.to_vector()).amax() < 1e-14, "{}", robot.name());
                }
            }
        }
    }
}

#[test]
fn memory_of_a_finder_does_not_grow_with_the_poses() {
    for robot in [
        other::iiwa14(),
        other::free("skewed", &other::SKEWED),
        arms::mh12(),
    ] {
        let mut stream = Stream(64);
        let mut finder = Finder::new(&robot);
        let mut most = 0;
        for round in 0..400 {
            let q = stream.joints(&robot);
            finder.all(&expected(&robot, &q, None, &q)).unwrap();
            finder.forget();
            let held = finder.spare.len() + finder.found.len();
            if round < 100 {
                most = most.max(held);
            }
            assert!(held <= most.max(16), "{}: {held} after {round}", robot.name());
        }
    }
}
