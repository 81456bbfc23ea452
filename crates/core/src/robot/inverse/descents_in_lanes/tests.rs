//! Descents in lanes against descents by themselves, from the same starts.

use std::f64::consts::{PI, TAU};

use super::super::descent::Descent;
use super::super::starts::Starts;
use super::*;
use crate::arms::{Stream, other};
use crate::robot::Robot;

/// Starts of a pose: more than lanes, so that these are refilled.
const STARTS: usize = 64;

fn arms() -> [Robot; 5] {
    [
        other::open_wrist(),
        other::oblique(),
        other::free("skewed", &other::SKEWED),
        other::five_joints(),
        other::sliding(),
    ]
}

fn chain_positions(robot: &Robot, q: &[f64]) -> Vec<f64> {
    (0..q.len()).map(|i| robot.theta(i, q)).collect()
}

fn goal(robot: &Robot, theta: &[f64]) -> Requested {
    Requested::new(&robot.chain().base_from_flange(theta))
}

/// The descents from these starts, after these postures are known.
fn descended(chain: &Chain, goal: &Requested, starts: &[Vec<f64>], known: &[Vec<f64>]) -> Vec<Descended> {
    let mut lanes = DescentsInLanes::new(chain);
    lanes.aim_at(chain, goal);
    for theta in known {
        lanes.know(theta);
    }
    let mut all = vec![None; starts.len()];
    let mut begun = 0;
    while all.iter().any(Option::is_none) {
        while begun < starts.len()
            && let Some(lane) = lanes.free_lane()
        {
            lanes.begin(lane, begun, &starts[begun]);
            begun += 1;
        }
        lanes.step(chain, |start, descended| all[start] = Some(descended));
    }
    all.into_iter().flatten().collect()
}

/// Descents from one start after the other.
fn one_by_one(
    chain: &Chain,
    goal: &Requested,
    starts: &[Vec<f64>],
) -> Vec<(Vec<f64>, Result<(), Unreachable>)> {
    let mut descent = Descent::new(chain);
    let reach = |start: &Vec<f64>| {
        let mut theta = start.clone();
        let reached = descent.reach(chain, goal, &mut theta);
        (theta, reached)
    };
    starts.iter().map(reach).collect()
}

fn spread(joints: usize) -> Vec<Vec<f64>> {
    let starts = Starts::within(&vec![[-PI, PI]; joints]);
    let start = |k| {
        let mut theta = vec![0.0; joints];
        starts.point(k, &mut theta);
        theta
    };
    (1..=STARTS).map(start).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn each_lane_ends_where_the_descent_by_itself_does() {
    let mut stream = Stream(51);
    for robot in arms() {
        let chain = robot.chain();
        let (mut reached, mut others) = (0, 0);
        for _ in 0..6 {
            let goal = goal(&robot, &chain_positions(&robot, &stream.joints(&robot)));
            let starts = spread(chain.links().len());
            let alone = one_by_one(chain, &goal, &starts);
            for (lane, (theta, alone)) in descended(chain, &goal, &starts, &[]).iter().zip(&alone) {
                // Rounding grows on the way, most where it is long; at the end it is a posture, or none.
                assert_eq!(lane.reached.is_ok(), alone.is_ok(), "{}", robot.name());
                let is_same = apart(&lane.theta[..theta.len()], theta) < 1e-9;
                if alone.is_ok() {
                    assert!(is_same, "{}: {lane:?} {theta:?}", robot.name());
                    reached += 1;
                } else {
                    others += 1;
                }
            }
        }
        assert!(
            reached > 60 && others > 10,
            "{}: {reached} {others}",
            robot.name()
        );
    }
}

#[test]
fn half_a_turn_away_goes_the_way_of_the_descent_by_itself() {
    for robot in [other::oblique(), other::open_wrist()] {
        let chain = robot.chain();
        let there = [0.3, -0.4, 0.5, -0.6, 0.7, -0.8];
        // The flange is where it should be, turned by half a turn about axis 6 up to rounding.
        let mut start = there.to_vec();
        start[5] += PI;
        let goal = goal(&robot, &there);
        let starts = vec![start; 3];
        let alone = one_by_one(chain, &goal, &starts);
        for (lane, (theta, reached)) in descended(chain, &goal, &starts, &[]).iter().zip(&alone) {
            assert_eq!(lane.reached.is_ok(), reached.is_ok());
            assert!(
                reached.is_err() || apart(&lane.theta, theta) < 1e-9,
                "{lane:?} {theta:?}"
            );
        }
    }
}

#[test]
fn a_start_at_the_pose_changes_no_bit() {
    for robot in arms() {
        let theta = chain_positions(&robot, &Stream(52).joints(&robot));
        let goal = goal(&robot, &theta);
        let found = descended(robot.chain(), &goal, std::slice::from_ref(&theta), &[]);
        assert_eq!(found[0].reached, Ok(Reached::Pose));
        assert_eq!(found[0].theta[..theta.len()], theta);
    }
}

#[test]
fn descents_to_known_postures_end_early_and_no_others() {
    let mut stream = Stream(53);
    let mut early = 0;
    for robot in arms() {
        let chain = robot.chain();
        for _ in 0..4 {
            let goal = goal(&robot, &chain_positions(&robot, &stream.joints(&robot)));
            let starts = spread(chain.links().len());
            let alone = one_by_one(chain, &goal, &starts);
            let Some((known, _)) = alone.iter().find(|(_, reached)| reached.is_ok()) else {
                continue;
            };
            let is_known = |theta: &[f64]| {
                let away = theta.iter().zip(known).enumerate().map(|(joint, (a, b))| {
                    let away = a - b;
                    let turns = if chain.slides(joint) {
                        0.0
                    } else {
                        (away / TAU).round()
                    };
                    (away - turns * TAU).abs()
                });
                away.fold(0.0, f64::max) < 1e-6
            };
            let all = descended(chain, &goal, &starts, std::slice::from_ref(known));
            for (lane, (theta, reached)) in all.iter().zip(&alone) {
                assert_eq!(lane.reached.is_ok(), reached.is_ok());
                if lane.reached == Ok(Reached::Known) {
                    assert!(is_known(theta), "{}: {theta:?} {known:?}", robot.name());
                    early += 1;
                } else if reached.is_ok() {
                    assert!(apart(&lane.theta[..theta.len()], theta) < 1e-9);
                }
            }
        }
    }
    assert!(early > 100, "{early}");
}
