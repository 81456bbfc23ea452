use std::f64::consts::{PI, TAU};
use std::sync::atomic::AtomicBool;

use nalgebra::{Point2, Point3, UnitQuaternion, Vector3};

use super::*;
use crate::arms;
use crate::frame::Isometry;
use crate::kernel::{BranchChoice, PostureStatus};
use crate::load::{LoadCases, LoadFrame, PathLoad};
use crate::map::{AlongPath, along_postures, obstacles};
use crate::optimize::walk::WITHIN;
use crate::optimize::{Component, Objective, Steps, reversals};
use crate::path::{LoadedTrack, Pace, Placing, SampledPath, Shape, Spin, Track};
use crate::robot::{Branch, BranchPattern, Limits, Robot};
use crate::source::{Arm, StiffnessModel};
use crate::spatial::Wrench;
use crate::workpiece::Plane;

/// Feed of the paths, m/s.
pub(in crate::optimize) const FEED: f64 = 0.04;

/// An arm with speed limits that machines a plate in front of it.
struct Cell {
    robot: Robot,
    tool: Isometry,
}

impl Cell {
    fn new() -> Cell {
        let mut joints = arms::mh12().joints().to_vec();
        for (joint, most) in joints.iter_mut().zip([3.8, 3.5, 3.8, 7.9, 7.9, 10.5]) {
            joint.max_speed = Some(most);
        }
        Cell::with(joints)
    }

    fn with(joints: Vec<crate::robot::Joint>) -> Cell {
        let arm = arms::mh12();
        let robot = Robot::new("mh12", arm.chain().motions().to_vec(), joints).unwrap();
        Cell {
            robot: robot.with_compliance(arm.compliance().unwrap().to_vec()).unwrap(),
            // A spindle across the flange: turning the tool moves the wrist.
            tool: crate::frame::from_xyz_and_fixed_angles(
                Vector3::new(0.1, 0.0, 0.15),
                Vector3::new(0.0, PI / 2.0, 0.0),
            ),
        }
    }

    fn question(&self) -> Question<'_> {
        let arm = Arm {
            robot: &self.robot,
            compliance: self.robot.compliance().unwrap(),
            flange_from_tool: &self.tool,
            model: StiffnessModel::DRIVES,
        };
        Question::unloaded(arm, None)
    }

    fn found(&self, track: &Track, search: &PostureSearch) -> PostureFound {
        postures_along(
            &self.question(),
            LoadedTrack { track, load: &load() },
            search,
            Watch::NONE,
        )
        .unwrap()
    }

    /// The answers along the path with these spins, in these branches.
    fn answered(&self, track: &Track, spins: Vec<f64>, choices: Vec<(usize, BranchChoice)>) -> AlongPath {
        let track = Track {
            spins: Some(spins),
            ..track.clone()
        };
        along_postures(&self.question(), &track, load(), choices, Watch::NONE).unwrap()
    }
}

fn load() -> PathLoad {
    PathLoad::Cases(LoadCases {
        frame: LoadFrame::Feed,
        cases: [[-80.0, 30.0, 10.0], [20.0, 60.0, -25.0]]
            .map(|force| Wrench::from_force(force.into()))
            .to_vec(),
    })
}

/// A square of 0.3 m on a horizontal plate, cut at 40 mm/s.
fn square() -> Track {
    let shape = Shape::rectangle(Point2::origin(), nalgebra::Vector2::new(0.3, 0.3));
    track(shape.sampled(0.01), Point3::new(0.85, 0.0, 0.3))
}

/// A path on a horizontal plate, cut at [`FEED`].
pub(in crate::optimize) fn track(mut path: SampledPath, centre: Point3<f64>) -> Track {
    for point in &mut path.points {
        point.pace = Pace::Feed(FEED);
    }
    let plane = Plane::tilted(centre, PI / 2.0);
    Track {
        path,
        placing: Placing {
            spin: Spin::Fixed(0.4),
            ..Placing::on_plane(&plane)
        },
        base_from_part: plane.base_from_part,
        spins: None,
        homes: None,
    }
}

/// A search over all spins in steps of 10 deg.
pub(in crate::optimize) fn search(objective: Objective) -> PostureSearch {
    PostureSearch {
        spins: Steps {
            first: -PI,
            step: PI / 18.0,
            count: 36,
        },
        lean: None,
        axes: Vec::new(),
        component: Component::InPlane,
        objective,
        branches: BranchPattern::default(),
        turn_rate: 20.0,
        turn_price: 1e-9,
        back_price: 0.0,
        wrist: 0.05,
        margin: 0.0,
    }
}

/// In-plane deviations at the reachable points.
fn in_plane(along: &AlongPath) -> Vec<f64> {
    along
        .answers
        .evaluations()
        .map(|(_, evaluation)| evaluation.in_plane)
        .collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn no_constant_turn_and_branch_is_better_than_the_chain() {
    let (cell, track) = (Cell::new(), square());
    let found = cell.found(&track, &search(Objective::Worst));
    assert!(
        found.unreachable.is_empty() && found.breaks.is_empty(),
        "{:?} {:?}",
        found.unreachable,
        found.breaks
    );
    let mut usable = 0;
    for turn in 0..36 {
        let spin = search(Objective::Worst).spins.at(turn);
        for branch in Branch::ALL {
            let along = cell.answered(
                &track,
                vec![spin; track.len()],
                vec![(0, BranchChoice::Of(branch.into()))],
            );
            let fine = |evaluation: &crate::kernel::Evaluation| {
                evaluation.within_limits() && evaluation.singularity.is_none()
            };
            if along
                .answers
                .evaluations()
                .filter(|(_, evaluation)| fine(evaluation))
                .count()
                < track.len()
            {
                continue;
            }
            usable += 1;
            let worst = largest(&in_plane(&along));
            assert!(
                found.reached <= worst * (1.0 + 1e-9),
                "{turn} {branch}: {} {worst}",
                found.reached
            );
        }
    }
    assert!(usable > 10, "{usable} turns and branches reach the whole path");
}

#[test]
fn the_path_answered_with_the_result_deviates_as_reported_and_keeps_the_limits() {
    let (cell, track) = (Cell::new(), square());
    for objective in [Objective::Worst, Objective::Mean] {
        let search = search(objective);
        let found = cell.found(&track, &search);
        let along = cell.answered(&track, found.spins.clone(), found.choices());
        let deviations = in_plane(&along);
        assert_eq!(deviations.len(), track.len());
        let reached = if objective == Objective::Worst {
            largest(&deviations)
        } else {
            mean(&deviations)
        };
        // Spins are smoothed between the steps of the lattice, 10 deg apart: that changes a deviation by a few percent.
        assert!(
            (reached / found.reached - 1.0).abs() < 0.05,
            "{objective:?}: {reached} {}",
            found.reached
        );
        let rate = |i: usize| {
            let by = (found.spins[i] - found.spins[i - 1]).abs();
            by / (track.path.points[i].along - track.path.points[i - 1].along)
        };
        let fastest = (1..track.len()).map(rate).fold(0.0, f64::max);
        // Steps allowed by the rate are a point earlier or later than its length: 10 mm of some 9.
        assert!(fastest < search.turn_rate * 2.0, "{fastest} rad/m");
        for i in 1..track.len() {
            let joints = along
                .answers
                .joints_at(i)
                .iter()
                .zip(along.answers.joints_at(i - 1));
            for (joint, (to, from)) in cell.robot.joints().iter().zip(joints) {
                let time = 0.01 / 0.04;
                assert!(
                    (to - from).abs() <= joint.max_speed.unwrap() * time,
                    "{} at {i}",
                    joint.name
                );
            }
        }
        assert!(
            along
                .answers
                .evaluations()
                .all(|(_, evaluation)| evaluation.within_limits())
        );
    }
}

#[test]
fn each_objective_gives_the_best_result_for_itself() {
    let (cell, track) = (Cell::new(), square());
    let limit = 60e-6;
    let goals = [Objective::Worst, Objective::Mean, Objective::Above(limit)];
    let given: Vec<Vec<f64>> = goals
        .iter()
        .map(|objective| {
            // No smoothing: the lattice alone is compared.
            let search = PostureSearch {
                turn_price: 0.0,
                ..search(*objective)
            };
            let found = cell.found(&track, &search);
            let turns = found.lattice.spins.len();
            assert_eq!(found.lattice.points.len(), track.len());
            let of = |(i, turn): (usize, &Option<usize>)| found.lattice.deviations[i * turns + turn.unwrap()];
            found.lattice.chain.iter().enumerate().map(of).collect()
        })
        .collect();
    let above = |values: &[f64]| values.iter().map(|value| (value - limit).max(0.0)).sum::<f64>();
    let rounding = 1.0 + 1e-9;
    for other in &given {
        assert!(largest(&given[0]) <= largest(other) * rounding);
        assert!(mean(&given[1]) <= mean(other) * rounding);
        // Deviations within the tolerance have a weight of a thousandth.
        let within = WITHIN * given[2].iter().sum::<f64>();
        assert!(above(&given[2]) <= above(other) + within);
    }
}

#[test]
fn a_price_reduces_reversals_without_a_worse_worst_point() {
    let (cell, track) = (Cell::new(), square());
    for objective in [Objective::Worst, Objective::Mean] {
        let with = |back_price: f64| {
            let search = PostureSearch {
                back_price,
                ..search(objective)
            };
            let found = cell.found(&track, &search);
            let along = cell.answered(&track, found.turned(&track).spins.unwrap(), found.choices());
            let backs: usize = reversals(&track.path, &along.answers).iter().sum();
            (found.reached, mean(&in_plane(&along)), backs)
        };
        let (reached, before, backs) = with(0.0);
        // A micrometre over a tenth of the path, and a price so high that nothing else matters.
        for price in [1e-6 * 0.12, 1e-3] {
            let (dear, after, fewer) = with(price);
            assert!(fewer <= backs, "{objective:?}: {fewer} {backs}");
            let total = |mean: f64, backs: usize| mean + price / track.path.length() * backs as f64;
            // The lattice is compared with its steps, the path here without them: within the price of a turn or two.
            assert!(
                total(after, fewer) <= total(before, backs) * 1.02,
                "{objective:?} {price}"
            );
            if objective == Objective::Worst {
                assert!((dear - reached).abs() < 1e-15, "{dear} {reached}");
            }
        }
        let most = with(1e-3).2;
        assert!(most < backs, "{objective:?}: {most} of {backs}");
    }
}

#[test]
fn points_without_posture_are_reported_with_the_reason() {
    let cell = Cell::new();
    let far = Shape::Polyline(vec![Point2::new(0.0, -0.3), Point2::new(0.0, 0.9)]).sampled(0.05);
    let found = cell.found(&track(far, Point3::new(0.9, 0.0, 0.3)), &search(Objective::Mean));
    let (index, status) = found.unreachable[0];
    assert!(
        index > 3 && status == PostureStatus::OutOfReach,
        "{:?}",
        found.unreachable
    );
    let last = found.branches.len();
    assert_eq!(
        found.unreachable.iter().map(|(i, _)| *i).collect::<Vec<_>>(),
        (index..last).collect::<Vec<_>>()
    );
    assert!(
        found.branches[..index].iter().all(Option::is_some)
            && found.branches[index..].iter().all(Option::is_none)
    );
    // A joint that must not move has no posture.
    let mut joints = cell.robot.joints().to_vec();
    joints[1].limits = Some(Limits {
        lower: 2.6,
        upper: 2.61,
    });
    let found = Cell::with(joints).found(&square(), &search(Objective::Mean));
    assert_eq!(found.unreachable.len(), square().len());
    assert!(
        found
            .unreachable
            .iter()
            .all(|(_, status)| *status == PostureStatus::OutsideLimits)
    );
    assert!(found.reached == 0.0 && found.breaks.is_empty());
}

#[test]
fn an_arm_too_slow_for_the_feed_has_breaks() {
    let mut joints = arms::mh12().joints().to_vec();
    for joint in &mut joints {
        joint.max_speed = Some(1e-3);
    }
    let track = square();
    let found = Cell::with(joints).found(&track, &search(Objective::Mean));
    assert_eq!(found.breaks, (1..track.len()).collect::<Vec<_>>());
    assert!(found.unreachable.is_empty());
}

#[test]
fn a_rapid_may_change_turn_and_branch() {
    let cell = Cell::new();
    let mut path = square().path;
    // The same square again after a rapid, far to the side.
    let second: Vec<_> = path
        .points
        .iter()
        .map(|point| crate::path::PathPoint {
            at: point.at + Vector3::new(0.55, 0.0, 0.25),
            along: point.along + path.length(),
            ..*point
        })
        .collect();
    path.points.extend(second);
    let track = track(path, Point3::new(0.7, 0.0, 0.3));
    let slow = PostureSearch {
        turn_rate: 1e-3,
        ..search(Objective::Worst)
    };
    let found = cell.found(&track, &slow);
    assert!(found.unreachable.is_empty() && found.breaks.is_empty());
    let half = track.len() / 2;
    let turned = |range: std::ops::Range<usize>| {
        let spins = &found.spins[range];
        spins.iter().all(|spin| (spin - spins[0]).abs() < 1e-12)
    };
    assert!(turned(0..half) && turned(half..track.len()));
    let change =
        (found.spins[half] - found.spins[half - 1]).abs() > 0.1 || found.branches[half] != found.branches[0];
    assert!(change, "each square has the turn that suits it");
}

#[test]
fn any_number_of_threads_finds_the_same_and_it_stops_when_cancelled() {
    let (cell, track) = (Cell::new(), square());
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| cell.found(&track, &search(Objective::Worst)))
    };
    let (one, two) = (with(1), with(2));
    assert_eq!(one.spins, two.spins);
    assert_eq!(one.branches, two.branches);
    assert_eq!(one.lattice.deviations, two.lattice.deviations);
    let cancel = AtomicBool::new(true);
    let watch = Watch {
        finished: &|_| (),
        cancel: &cancel,
    };
    let stopped = postures_along(
        &cell.question(),
        LoadedTrack {
            track: &track,
            load: &load(),
        },
        &search(Objective::Mean),
        watch,
    );
    assert_eq!(stopped.unwrap_err(), Cancelled);
}

/// Four rounds of a circle, the tool turning with the feed.
fn rounds() -> Track {
    let rounds = (0..=240).map(|i| {
        let angle = f64::from(i) * TAU / 60.0;
        Point2::new(0.06 * angle.cos(), 0.06 * angle.sin())
    });
    let shape = Shape::Polyline(rounds.collect());
    let mut track = track(shape.sampled(0.004), Point3::new(0.85, 0.0, 0.3));
    track.placing.spin = Spin::AlongFeed(0.0);
    track
}

#[test]
fn a_joint_that_would_turn_with_the_feed_round_after_round_stays_within_its_limits() {
    let track = rounds();
    let requested = PostureSearch {
        turn_rate: 40.0,
        turn_price: 1e-5,
        ..search(Objective::Mean)
    };
    let of = |half: f64| {
        let mut joints = Cell::new().robot.joints().to_vec();
        joints[5].limits = Some(Limits {
            lower: -half,
            upper: half,
        });
        let mut cell = Cell::with(joints);
        // A spindle along the flange: only the last joint turns the tool.
        cell.tool = Isometry::from_parts(Vector3::new(0.0, 0.0, 0.15).into(), UnitQuaternion::identity());
        let found = cell.found(&track, &requested);
        let along = cell.answered(&track, found.spins.clone(), found.choices());
        let obstacles = obstacles(&cell.robot, &track.path, &along.answers, 0.0).count();
        let last = |index: usize| along.answers.joints_at(index)[5];
        let turned = (last(track.len() - 1) - last(0)).abs();
        (found, obstacles, turned)
    };
    let (free, obstacles, turned) = of(10.0 * TAU);
    assert!(obstacles == 0 && turned > 3.0 * TAU, "{obstacles} {turned}");
    let (limited, obstacles, turned) = of(TAU);
    assert!(obstacles == 0 && turned <= 2.0 * TAU, "{obstacles} {turned}");
    assert!(limited.breaks.is_empty() && free.breaks.is_empty());
}

#[test]
fn smoothed_spins_stay_within_the_joint_limits_and_their_margin() {
    let track = square();
    let cell = Cell::new();
    for margin in [0.0, 0.1] {
        let requested = PostureSearch {
            margin,
            spins: Steps {
                step: PI / 9.0,
                count: 18,
                first: -PI,
            },
            ..search(Objective::Mean)
        };
        let found = cell.found(&track, &requested);
        let along = cell.answered(&track, found.spins.clone(), found.choices());
        let room = along
            .answers
            .evaluations()
            .map(|(_, evaluation)| evaluation.limit_margin);
        let least = room.fold(f64::INFINITY, f64::min);
        assert!(
            found.unreachable.is_empty() && least >= margin - 1e-9,
            "{margin} {least}"
        );
    }
}
