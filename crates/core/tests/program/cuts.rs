//! Cutting forces: process limits of a program, and the force-deflection equilibrium.

use std::f64::consts::TAU;

use armill_core::kernel::BranchChoice;
use armill_core::load::{
    Cutter, CuttingLaw, Immersion, LoadCases, LoadFrame, Mechanistic, Milling, PathLoad,
};
use armill_core::map::{CutDemand, CutLimits, Permitted, ProgramLimits, program_limits};
use armill_core::nalgebra::{Vector2, Vector3};
use armill_core::path::{Cutting, GreatestForce, Track};
use armill_core::robot::BranchPattern;
use armill_core::source::StiffnessModel;
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;

use crate::{arms, followed, question, track};

/// A flat end mill of 10 mm with two flutes, 1 mm deep and 3 mm wide.
fn cutting() -> Cutting {
    let law = Mechanistic::new(Vector3::new(796e6, 168e6, 222e6), Vector3::new(27e3, 30e3, 5e3)).unwrap();
    Cutting {
        cutter: Cutter::flat(10e-3, 2).unwrap(),
        law: CuttingLaw::Mechanistic(law),
        depth: 1e-3,
        immersion: Immersion::Down(3e-3),
        feed: None,
        spindle: Some(SPINDLE),
        greatest: GreatestForce::SecondCase,
    }
}

/// rad/s
const SPINDLE: f64 = 8000.0 * TAU / 60.0;

/// Its forces along a track, the engagement the same everywhere.
fn cut_along(cutting: &Cutting, track: &Track) -> PathLoad {
    let forces = cutting.along(&track.path, &track.placing, None, Watch::NONE);
    PathLoad::Cuts(forces.unwrap().cuts)
}

/// A cut that permits a value at a point deviates there by just the limit.
fn permits(
    found: &ProgramLimits,
    limit: f64,
    value: impl Fn(&CutLimits) -> Permitted,
    cutting_at: impl Fn(f64) -> Cutting,
) {
    let robot = arms::mh12();
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let mut requested = 0;
    for point in found
        .points
        .iter()
        .filter(|point| point.cut.is_some())
        .step_by(40)
    {
        let Permitted::UpTo(value) = value(&point.cut.unwrap()) else {
            continue;
        };
        // A cut as wide as the tool has no free edge that a deflection could move: the deviation jumps there.
        if value > 0.98 * cutting().cutter.diameter() {
            continue;
        }
        let load = cut_along(&cutting_at(value), &track());
        let there = followed(&robot, StiffnessModel::DRIVES, choice, load);
        let deviation = there.answers.points[point.index].as_ref().unwrap().in_plane;
        assert!((deviation / limit - 1.0).abs() < 2e-3, "{value}: {deviation}");
        requested += 1;
    }
    assert!(requested > 2, "{requested}");
}

#[test]
fn at_the_permitted_depth_width_or_feed_the_tool_deviates_by_the_tolerance() {
    let robot = arms::mh12();
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let mean_alone = Cutting {
        greatest: GreatestForce::LeftOut,
        ..cutting()
    };
    let load = cut_along(&mean_alone, &track());
    let followed = followed(&robot, StiffnessModel::DRIVES, choice, load);
    let limit = 0.7 * followed.answers.worst().unwrap().1.in_plane;
    let tool = arms::bent_tool();
    let question = question(&robot, StiffnessModel::DRIVES, &tool, followed.choice_at(0));
    let found = program_limits(
        &question,
        &track(),
        &followed,
        CutDemand::of_tolerance(limit),
        Watch::NONE,
    );
    let found = found.unwrap().unwrap();
    let feed_speed = 0.02;
    permits(
        &found,
        limit,
        |cut| cut.depth,
        |depth| Cutting { depth, ..mean_alone },
    );
    permits(
        &found,
        limit,
        |cut| cut.width.unwrap(),
        |width| Cutting {
            immersion: Immersion::Down(width),
            ..mean_alone
        },
    );
    permits(
        &found,
        limit,
        |cut| cut.feed_per_tooth,
        |thick| Cutting {
            // The feed is given in the program: the same chip at another spindle speed.
            spindle: Some(feed_speed * TAU / (2.0 * thick)),
            ..mean_alone
        },
    );
    // At the nominal depth and feed the sheet has the largest deviation of the path.
    let sheet = found.depth_by_feed.unwrap();
    let nearest = |all: &[f64], value: f64| {
        let off = |i: &usize| (all[*i] - value).abs();
        (0..all.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap()
    };
    let (row, column) = (
        nearest(&sheet.depths, 1e-3),
        nearest(&sheet.feeds_per_tooth, feed_speed * TAU / (SPINDLE * 2.0)),
    );
    let there = sheet.deviations[row * sheet.feeds_per_tooth.len() + column];
    assert!((there / (limit / 0.7) - 1.0).abs() < 0.15, "{there} {limit}");
    let thinner = sheet.deviations[column];
    assert!(thinner < there && sheet.deviations.iter().all(|deviation| *deviation > 0.0));
}

#[test]
fn at_the_permitted_force_the_tool_deviates_by_the_tolerance() {
    let robot = arms::mh12();
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let unit = |force: Vector3<f64>| {
        PathLoad::Cases(LoadCases {
            frame: LoadFrame::Feed,
            cases: vec![Wrench::from_force(force)],
        })
    };
    let along = |force| followed(&robot, StiffnessModel::DRIVES, choice, unit(force));
    let under_x = along(Vector3::x());
    let tool = arms::bent_tool();
    let question = question(&robot, StiffnessModel::DRIVES, &tool, under_x.choice_at(0));
    let limit = 50e-6;
    let found = program_limits(
        &question,
        &track(),
        &under_x,
        CutDemand::of_tolerance(limit),
        Watch::NONE,
    );
    let found = found.unwrap().unwrap();
    assert!(found.depth_by_feed.is_none() && found.points.len() > 100);
    for (axis, direction) in [Vector3::x(), Vector3::y(), Vector3::z()].into_iter().enumerate() {
        let under = along(direction);
        for point in &found.points {
            let deviation = under.answers.points[point.index].as_ref().unwrap().in_plane;
            let forces = point.forces;
            let permitted = [forces.along, forces.across, forces.normal][axis];
            assert!((permitted * deviation / limit - 1.0).abs() < 1e-9);
            assert!(forces.weakest <= permitted * (1.0 + 1e-12));
            assert_eq!(point.cut, None);
        }
    }
    let soft = StiffnessModel {
        load_dependent: true,
        ..StiffnessModel::DRIVES.clone()
    };
    let question = self::question(&robot, &soft, &tool, under_x.choice_at(0));
    let none = program_limits(
        &question,
        &track(),
        &under_x,
        CutDemand::of_tolerance(limit),
        Watch::NONE,
    );
    assert_eq!(none, Ok(None));
}

#[test]
fn where_a_tool_cuts_the_force_is_that_of_the_deflected_cut() {
    let robot = arms::mh12();
    let cutting = cutting();
    let track = track();
    let load = cut_along(&cutting, &track);
    let PathLoad::Cuts(drawn) = load.clone() else {
        panic!("cuts are cut")
    };
    let choice = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    let found = followed(&robot, StiffnessModel::DRIVES, choice, load);
    let equilibrium = found.equilibrium.unwrap();
    assert_eq!((equilibrium.unsettled, equilibrium.first_unsettled), (0, None));
    let PathLoad::Cuts(at_rest) = &found.load else {
        panic!("cuts stay cuts")
    };
    let mut gave_way = 0.0_f64;
    for (i, _) in found.answers.evaluations() {
        let (here, before) = (&at_rest.points[i], &drawn.points[i]);
        let parts = track.parts(i, &found.answers.deviations_at(i)[0]);
        let deflection = Vector2::new(parts.cross, parts.axial);
        let Some(cut) = before.cut else {
            assert_eq!(here.mean, Vector3::zeros());
            continue;
        };
        let met = cut.deflected(deflection, 5e-3).map(|cut| {
            let milling = Milling::new(cutting.cutter, cutting.law, cut);
            milling.unwrap().mean().force
        });
        let missing = (met.unwrap_or_default() - here.mean).norm();
        assert!(missing < 1e-4 * before.mean.norm(), "{i}: {missing}");
        let share = here.mean.norm() / before.mean.norm();
        assert!((here.greatest - before.greatest * share).norm() < 1e-9 * before.greatest.norm());
        gave_way = gave_way.max((1.0 - share).abs());
    }
    assert!(gave_way > 0.02, "the arm is soft enough to see it: {gave_way}");
    let worst = found.answers.worst().unwrap().1.in_plane;
    assert!(
        (equilibrium.largest_nominal / worst - 1.0).abs() > 5e-3,
        "{equilibrium:?} {worst}"
    );
}
