use std::f64::consts::PI;

use nalgebra::{Point2, Point3, Vector3};

use super::*;
use crate::arms;
use crate::kernel::BranchChoice;
use crate::load::{LoadCases, LoadFrame, PathLoad};
use crate::map::{along_path, obstacles};
use crate::optimize::posture::tests::{FEED, search, track};
use crate::optimize::{MovingAxis, Steps, postures_along};
use crate::path::{RoundedEnd, Shape};
use crate::robot::Robot;
use crate::source::{Arm, StiffnessModel};
use crate::spatial::Wrench;

/// An arm on a rail of 6 m along base y, all joints with a speed limit.
fn on_rail() -> Robot {
    let railed = arms::other::on_rail(&arms::mh12());
    let mut joints = railed.joints().to_vec();
    for (joint, most) in joints.iter_mut().zip([1.0, 3.8, 3.5, 3.8, 7.9, 7.9, 10.5]) {
        joint.max_speed = Some(most);
    }
    let compliance = railed.compliance().unwrap().to_vec();
    let moved = Robot::new("railed", railed.chain().motions().to_vec(), joints).unwrap();
    moved.with_compliance(compliance).unwrap()
}

pub(super) fn load() -> PathLoad {
    PathLoad::Cases(LoadCases {
        frame: LoadFrame::Feed,
        cases: vec![Wrench::from_force(Vector3::new(-80.0, 30.0, 10.0))],
    })
}

/// A line along base y on a horizontal plate, of this length (m): x of the part is there y of base.
fn line(centre: Point3<f64>, length: f64, step: f64) -> Track {
    let half = Point2::new(0.5 * length, 0.0);
    track(Shape::Polyline(vec![-half, half]).sampled(step), centre)
}

fn rail(step: f64) -> MovingAxis {
    MovingAxis {
        joint: 0,
        positions: Steps {
            first: -1.0,
            step,
            count: (6.0 / step).round() as usize + 1,
        },
        rate: 2.0,
        still: false,
    }
}

fn lean(step: f64, count: usize) -> LeanRange {
    let steps = Steps {
        first: -step * (count - 1) as f64 / 2.0,
        step,
        count,
    };
    LeanRange {
        leads: steps,
        tilts: steps,
        rate: 10.0,
        end: RoundedEnd {
            radius: 0.006,
            corner: 0.006,
        },
        stepover: None,
    }
}

pub(super) fn question<'a>(robot: &'a Robot, tool: &'a crate::frame::Isometry) -> Question<'a> {
    let arm = Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        flange_from_tool: tool,
        model: StiffnessModel::DRIVES,
    };
    Question::unloaded(arm, None)
}

pub(super) fn tool() -> crate::frame::Isometry {
    crate::frame::from_xyz_and_fixed_angles(Vector3::new(0.1, 0.0, 0.15), Vector3::new(0.0, PI / 2.0, 0.0))
}

#[test]
fn a_plate_too_long_for_the_arm_is_followed_on_the_rail_within_its_speed() {
    let (robot, tool) = (on_rail(), tool());
    let question = question(&robot, &tool);
    let track = line(Point3::new(0.8, 2.0, 0.5), 4.4, 0.02);
    let still = along_path(&question, &track, load(), Watch::NONE).unwrap();
    assert!(still.answers.points.iter().any(Result::is_err));
    let search = PostureSearch {
        axes: vec![rail(0.1)],
        ..search(Objective::Worst)
    };
    let loaded = LoadedTrack {
        track: &track,
        load: &load(),
    };
    let found = postures_along(&question, loaded, &search, Watch::NONE).unwrap();
    assert_eq!((&found.unreachable[..], &found.breaks[..]), (&[][..], &[][..]));
    let turned = found.turned(&track);
    let along = along_postures(&question, &turned, load(), found.choices(), Watch::NONE).unwrap();
    let (robot, path) = (&robot, &track.path);
    assert_eq!(obstacles(robot, path, &along.answers, 0.0).count(), 0);
    let at = |index: usize| along.answers.joints_at(index)[0];
    let width = robot.joints().len();
    for index in 0..track.len() {
        assert_eq!(at(index), found.homes.as_ref().unwrap()[index * width]);
    }
    let farthest = (1..track.len()).map(|index| (at(index) - at(index - 1)).abs());
    let seconds = 0.02 / FEED;
    assert!(farthest.fold(0.0, f64::max) <= seconds + 1e-9);
    assert!((at(track.len() - 1) - at(0)).abs() > 1.0, "it moves along");
}

#[test]
fn a_rail_that_stands_still_within_cuts_moves_between_them_alone() {
    let (robot, tool) = (on_rail(), tool());
    let question = question(&robot, &tool);
    let mut track = line(Point3::new(0.8, 2.0, 0.5), 0.6, 0.02);
    let length = track.path.length();
    let cut = track.path.points.clone();
    track
        .path
        .points
        .extend(cut.iter().map(|point| crate::path::PathPoint {
            at: point.at + Vector3::new(2.0, 0.0, 0.0),
            along: point.along + length,
            ..*point
        }));
    let search = PostureSearch {
        axes: vec![MovingAxis {
            still: true,
            ..rail(0.25)
        }],
        ..search(Objective::Worst)
    };
    let loaded = LoadedTrack {
        track: &track,
        load: &load(),
    };
    let found = postures_along(&question, loaded, &search, Watch::NONE).unwrap();
    assert_eq!((&found.unreachable[..], &found.breaks[..]), (&[][..], &[][..]));
    let width = robot.joints().len();
    let homes = found.homes.unwrap();
    let rail = |index: usize| homes[index * width];
    let half = cut.len();
    assert!((0..half).all(|index| rail(index) == rail(0)));
    assert!((half..2 * half).all(|index| rail(index) == rail(half)));
    assert!((rail(half) - rail(0)).abs() > 1.0);
}

#[test]
fn lean_and_rail_are_never_worse_than_without_and_agree_with_each_setting_alone() {
    let (robot, tool) = (on_rail(), tool());
    let question = question(&robot, &tool);
    let track = line(Point3::new(0.8, 0.5, 0.4), 0.3, 0.05);
    let loaded = LoadedTrack {
        track: &track,
        load: &load(),
    };
    let spins = Steps {
        first: -0.6,
        step: 0.3,
        count: 5,
    };
    let few = PostureSearch {
        spins,
        lean: Some(lean(0.2, 3)),
        axes: vec![MovingAxis {
            positions: Steps {
                first: 0.0,
                step: 0.5,
                count: 3,
            },
            rate: 0.0,
            ..rail(0.5)
        }],
        turn_rate: 1e-9,
        ..search(Objective::Worst)
    };
    let few = PostureSearch {
        lean: few.lean.map(|lean| LeanRange { rate: 1e-9, ..lean }),
        ..few
    };
    let found = postures_along(&question, loaded, &few, Watch::NONE).unwrap();
    assert_eq!((&found.unreachable[..], &found.breaks[..]), (&[][..], &[][..]));
    // Nothing may change on the way: every constant setting, in every branch.
    let mut least = f64::INFINITY;
    for setting in 0..5 * 3 * 3 * 3 {
        let digit = |of: usize, count: usize| setting / of % count;
        let spin = spins.at(digit(1, 5));
        let [lead, tilt] = [digit(5, 3), digit(15, 3)].map(|index| lean(0.2, 3).leads.at(index));
        let home = 0.5 * digit(45, 3) as f64;
        let leans = vec![Lean { lead, tilt }; track.len()];
        let mut homes = robot.home(None);
        homes[0] = home;
        let leaning = Track {
            homes: Some(homes.repeat(track.len())),
            ..track.leaning(&leans, lean(0.2, 3).end).spun(spin)
        };
        for branch in Branch::ALL {
            let choices = vec![(0, BranchChoice::Of(branch.into()))];
            let along = along_postures(&question, &leaning, load(), choices, Watch::NONE).unwrap();
            let usable = |point: &Result<crate::kernel::Evaluation, _>| {
                point
                    .as_ref()
                    .is_ok_and(|of| of.within_limits() && of.singularity.is_none())
            };
            let wrist = |index: usize| along.answers.joints_at(index)[5].sin().abs() > few.wrist.sin();
            let fine = along.answers.points.iter().all(usable) && (0..track.len()).all(wrist);
            if fine && obstacles(&robot, &track.path, &along.answers, 0.0).count() == 0 {
                let worst = Objective::Worst.along(few.component, &leaning, &along.answers);
                least = least.min(worst);
            }
        }
    }
    assert!(
        (found.reached - least).abs() < 1e-9 * least,
        "{} {least}",
        found.reached
    );
}

#[test]
fn refinement_comes_near_the_whole_lattice() {
    let (robot, tool) = (on_rail(), tool());
    let question = question(&robot, &tool);
    let track = line(Point3::new(0.8, 0.5, 0.4), 0.8, 0.01);
    let loaded = LoadedTrack {
        track: &track,
        load: &load(),
    };
    let wide = PostureSearch {
        lean: Some(LeanRange {
            tilts: Steps::one(0.0),
            ..lean(0.05, 9)
        }),
        axes: vec![MovingAxis {
            positions: Steps {
                first: -0.5,
                step: 0.25,
                count: 9,
            },
            ..rail(0.25)
        }],
        spins: Steps {
            first: -1.0,
            step: 0.25,
            count: 9,
        },
        ..search(Objective::Worst)
    };
    let whole = Window::all(&wide);
    let all: Vec<usize> = (0..track.len()).collect();
    let best = |window: &Window| {
        let forces = LeaningForces::of(loaded.load);
        let walk = Walk::new(
            &question,
            (SearchedPath::new(loaded, None), &forces),
            &wide,
            (window, &all),
        );
        let (chain, _, cost) = best_chain(&walk, &wide, Watch::NONE).unwrap();
        let Cost::Within(worst) = cost else { unreachable!() };
        (worst, walk.settings(&chain))
    };
    let (least, _) = best(&whole);
    let coarse = Window::coarse(&wide, [3, 3, 3, 3, 1, 1]);
    let (first, settings) = best(&coarse);
    let halved = coarse.halved(&at_every_point(&track, &all, &settings));
    let (second, settings) = best(&halved);
    let finest = halved.halved(&at_every_point(&track, &all, &settings));
    assert!(finest.is_finest());
    let (third, _) = best(&finest);
    assert!(least <= third * (1.0 + 1e-12), "{least} {third} {second} {first}");
    // Steps along the path come at other points with other steps: the passes are not monotonic.
    assert!(
        third < first && third < 1.1 * least,
        "{least} {third} {second} {first}"
    );
}
