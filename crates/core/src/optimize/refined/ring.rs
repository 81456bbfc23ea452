//! A ring on a turntable.

use std::f64::consts::{PI, TAU};

use nalgebra::{Point2, Point3};

use super::tests::{load, question, tool};
use super::*;
use crate::arms;
use crate::frame::Isometry;
use crate::kernel::{BranchChoice, Evaluation};
use crate::map::{along_postures, obstacles};
use crate::optimize::posture::tests::{FEED, search, track};
use crate::optimize::{MovingAxis, Steps, postures_along};
use crate::path::Shape;
use crate::robot::positioner::Positioner;
use crate::robot::{Amount, Axis, Joint, JointCompliance, Motion, Robot};

/// The arm in front of a turntable with its axis at this x (m), and with this speed limit (rad/s).
fn with_table(x: f64, most: Option<f64>) -> Robot {
    let motions = vec![Motion::About(Axis::Z, Amount::Joint(0))];
    let turn = Joint {
        max_speed: most,
        ..Joint::plain("turn")
    };
    let soft = JointCompliance {
        value: 2e-7,
        standard_uncertainty: 0.0,
    };
    let table = Robot::new("table", motions, vec![turn]).unwrap();
    let table = table.with_compliance(vec![soft]).unwrap();
    let standing = Positioner {
        robot: &table,
        base_from_root: &Isometry::translation(x, 0.0, 0.3),
        home: &[0.0],
    };
    arms::mh12().on_positioner(&standing, "base_link").unwrap()
}

/// A ring about the axis of the table; in base, which is the table.
fn ring(radius: f64, step: f64) -> Track {
    let circle = Shape::Circle {
        centre: Point2::origin(),
        radius,
    };
    track(circle.sampled(step), Point3::new(0.0, 0.0, 0.1))
}

/// A table that turns by this step, rad, once around in either direction.
fn table(step: f64, rate: f64) -> MovingAxis {
    let half = (TAU / step).round() as usize;
    MovingAxis {
        joint: 0,
        positions: Steps {
            first: -step * half as f64,
            step,
            count: 2 * half + 1,
        },
        rate,
        still: false,
    }
}

#[test]
fn a_ring_beyond_the_reach_of_the_arm_is_milled_on_the_turning_table() {
    let most = 0.5;
    let (robot, tool) = (with_table(1.3, Some(most)), tool());
    let question = question(&robot, &tool);
    let track = ring(0.55, 0.01);
    let loaded = LoadedTrack {
        track: &track,
        load: &load(),
    };
    let alone = postures_along(&question, loaded, &search(Objective::Worst), Watch::NONE).unwrap();
    assert!(alone.unreachable.len() > 50, "{}", alone.unreachable.len());
    let turning = PostureSearch {
        axes: vec![table(PI / 36.0, 4.0)],
        ..search(Objective::Worst)
    };
    let found = postures_along(&question, loaded, &turning, Watch::NONE).unwrap();
    assert_eq!((&found.unreachable[..], &found.breaks[..]), (&[][..], &[][..]));
    let turned = found.turned(&track);
    let along = along_postures(&question, &turned, load(), found.choices(), Watch::NONE).unwrap();
    assert_eq!(obstacles(&robot, &track.path, &along.answers, 0.0).count(), 0);
    let at = |index: usize| along.answers.joints_at(index)[0];
    let all = 0..track.len();
    let range = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], index| {
        [least.min(at(index)), most.max(at(index))]
    });
    assert!(range[1] - range[0] > PI / 2.0, "the table turns: {range:?}");
    for index in 1..track.len() {
        let time = (track.path.points[index].along - track.path.points[index - 1].along) / FEED;
        assert!((at(index) - at(index - 1)).abs() <= most * time * (1.0 + 1e-9));
    }
}

/// Points, and settings of spin and table.
const COUNT: usize = 24;
/// Least and greatest index of the table.
const TABLE: usize = 2 * COUNT + 1;

/// Deviation (m) and joint positions of the arm at every point in one constant setting; none where it cannot be used.
fn constant(
    question: &Question<'_>,
    track: &Track,
    search: &PostureSearch,
    [spin, table]: [f64; 2],
) -> Vec<Option<(f64, Vec<f64>)>> {
    let mut home = question.arm.robot.home(None);
    home[0] = table;
    let turned = Track {
        homes: Some(home.repeat(track.len())),
        // The tool points down: turned with the part below it, it keeps its orientation in the ground.
        ..track.spun(spin + table)
    };
    let choices = vec![(0, BranchChoice::Of(search.branches))];
    let along = along_postures(question, &turned, load(), choices, Watch::NONE).unwrap();
    let usable = |of: &Evaluation| of.within_limits() && of.singularity.is_none();
    (0..track.len())
        .map(|index| {
            let evaluation = along.answers.points[index]
                .as_ref()
                .ok()
                .filter(|of| usable(of))?;
            let joints = along.answers.joints_at(index)[1..].to_vec();
            (joints[4].sin().abs() > search.wrist.sin()).then_some((evaluation.in_plane, joints))
        })
        .collect()
}

/// Whether the joints of the arm go from one posture to the other without a jump.
fn goes(from: &[f64], to: &[f64]) -> bool {
    let by = from.iter().zip(to).enumerate().map(|(joint, (from, to))| {
        let by = to - from;
        // The last joint has two turns.
        if joint == 5 {
            by - TAU * (by / TAU).round()
        } else {
            by
        }
    });
    by.into_iter().all(|by| by.abs() < 0.5)
}

#[test]
fn the_largest_deviation_on_a_ring_is_that_of_all_sequences_on_a_small_lattice() {
    let (robot, tool) = (with_table(1.0, None), tool());
    let question = question(&robot, &tool);
    let radius = 0.3;
    let track = ring(radius, TAU * radius / COUNT as f64);
    let step = TAU / COUNT as f64;
    // One step of each from one point to the next.
    let rate = step / (track.path.points[1].along - track.path.points[0].along) * (1.0 + 1e-9);
    let few = PostureSearch {
        spins: Steps {
            first: -PI,
            step,
            count: COUNT,
        },
        axes: vec![table(step, rate)],
        branches: "front elbow-up no-flip".parse().unwrap(),
        turn_rate: rate,
        turn_price: 0.0,
        ..search(Objective::Worst)
    };
    let loaded = LoadedTrack {
        track: &track,
        load: &load(),
    };
    let found = postures_along(&question, loaded, &few, Watch::NONE).unwrap();
    assert_eq!((&found.unreachable[..], &found.breaks[..]), (&[][..], &[][..]));

    let settings = |spin: usize, table: usize| [few.spins.at(spin), few.axes[0].positions.at(table)];
    let all: Vec<Vec<_>> = (0..COUNT * TABLE)
        .map(|state| constant(&question, &track, &few, settings(state % COUNT, state / COUNT)))
        .collect();
    let joints = |state: usize, point: usize| all[state][point].as_ref().map(|(_, joints)| joints);
    let linked = |from: (usize, usize), to: (usize, usize)| {
        let both = joints(from.0, from.1).zip(joints(to.0, to.1));
        both.is_some_and(|(from, to)| goes(from, to))
    };
    // Least of the largest deviation of every sequence that ends in a state; first the point, then a step of the spin,
    // then one of the table.
    let deviation = |state: usize, point: usize| all[state][point].as_ref().map_or(f64::INFINITY, |of| of.0);
    let mut least: Vec<f64> = (0..all.len()).map(|state| deviation(state, 0)).collect();
    for point in 1..track.len() {
        let stay = |state: usize| linked((state, point - 1), (state, point));
        let stayed: Vec<f64> = (0..all.len())
            .map(|state| if stay(state) { least[state] } else { f64::INFINITY })
            .collect();
        let step = |from: usize, to: usize, cost: &[f64]| match linked((from, point), (to, point)) {
            true => cost[from],
            false => f64::INFINITY,
        };
        let spun: Vec<f64> = (0..all.len())
            .map(|state| {
                let (spin, row) = (state % COUNT, state - state % COUNT);
                let others = [(spin + 1) % COUNT, (spin + COUNT - 1) % COUNT].map(|spin| row + spin);
                let others = others.map(|from| step(from, state, &stayed));
                stayed[state].min(others[0]).min(others[1])
            })
            .collect();
        least = (0..all.len())
            .map(|state| {
                let below = state.checked_sub(COUNT);
                let above = Some(state + COUNT).filter(|above| *above < all.len());
                let others = below
                    .into_iter()
                    .chain(above)
                    .map(|from| step(from, state, &spun));
                others.fold(spun[state], f64::min).max(deviation(state, point))
            })
            .collect();
    }
    let least = least.into_iter().fold(f64::INFINITY, f64::min);
    assert!(least.is_finite());
    assert!(
        (found.reached - least).abs() < 1e-9 * least,
        "{} {least}",
        found.reached
    );
}
