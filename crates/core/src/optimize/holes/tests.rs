use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::{Point3, Unit, Vector3};

use super::*;
use crate::arms;
use crate::frame::{Isometry, from_xyz_and_fixed_angles};
use crate::load::{LoadCases, LoadFrame, PathLoad};
use crate::optimize::{Component, Objective, Steps};
use crate::path::{Hole, LoadedTrack, Placing, Track, path_of_holes};
use crate::robot::{Amount, Backlash, BacklashSide, Motion};
use crate::source::{Arm, StiffnessModel};
use crate::spatial::Wrench;
use crate::workpiece::Plane;

/// A spindle across the flange, so that turning the tool moves the wrist.
fn tool() -> Isometry {
    from_xyz_and_fixed_angles(Vector3::new(0.1, 0.0, 0.15), Vector3::new(0.0, PI / 2.0, 0.0))
}

/// Holes over a horizontal plate, some of them tilted, the last far out of reach.
fn holes() -> Vec<Hole> {
    let at = |x: f64, y: f64, lean: f64| Hole {
        at: Point3::new(x, y, 0.0),
        axis: Unit::new_normalize(Vector3::new(lean, 0.0, 1.0)),
        line: 1,
    };
    vec![
        at(0.0, 0.0, 0.0),
        at(0.15, -0.1, 0.0),
        at(-0.1, 0.2, 0.3),
        at(0.1, 0.1, -0.2),
        at(2.0, 0.0, 0.0),
    ]
}

fn track(holes: &[Hole]) -> Track {
    let plane = Plane::tilted(Point3::new(0.85, 0.0, 0.3), PI / 2.0);
    Track {
        path: path_of_holes(holes),
        placing: Placing {
            keeps_axis: false,
            ..Placing::on_plane(&plane)
        },
        base_from_part: plane.base_from_part,
        spins: None,
        homes: None,
    }
}

/// Thrust with a small lateral part, in the axes of the hole.
fn load() -> PathLoad {
    PathLoad::Cases(LoadCases {
        frame: LoadFrame::Feed,
        cases: [[10.0, 0.0, 120.0], [0.0, 15.0, 80.0]]
            .map(|force| Wrench::from_force(force.into()))
            .to_vec(),
    })
}

const SEARCH: PostureSearch = PostureSearch {
    spins: Steps {
        first: -PI,
        step: PI / 12.0,
        count: 24,
    },
    lean: None,
    axes: Vec::new(),
    component: Component::InPlane,
    objective: Objective::Worst,
    branches: BranchPattern {
        shoulder: None,
        elbow: None,
        wrist: None,
    },
    turn_rate: 1.0,
    turn_price: 0.0,
    back_price: 0.0,
    wrist: 0.05,
    margin: 0.0,
};

fn found(holes: &[Hole], search: &PostureSearch) -> HolesFound {
    found_by(StiffnessModel::DRIVES, holes, search)
}

fn found_by(model: &StiffnessModel, holes: &[Hole], search: &PostureSearch) -> HolesFound {
    found_beyond(&LeastGain::ANY, model, &track(holes), search)
}

fn found_beyond(
    least: &LeastGain,
    model: &StiffnessModel,
    track: &Track,
    search: &PostureSearch,
) -> HolesFound {
    let (robot, tool) = (arms::mh12(), tool());
    let question = question(&robot, &tool, model);
    let load = load();
    hole_postures(
        &question,
        LoadedTrack { track, load: &load },
        search,
        least,
        Watch::NONE,
    )
    .unwrap()
}

fn question<'a>(robot: &'a Robot, tool: &'a Isometry, model: &'a StiffnessModel) -> Question<'a> {
    let arm = Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        flange_from_tool: tool,
        model,
    };
    Question::unloaded(arm, None)
}

/// Backlash of some joints, links longer than in the controller: each moves the tool more than the thrust does.
fn worn() -> StiffnessModel {
    let mut model = StiffnessModel::DRIVES.clone();
    let gap = |side| {
        Some(Backlash {
            gap: 4e-4,
            standard_uncertainty: 0.0,
            side,
        })
    };
    model.structure.backlash = vec![
        gap(BacklashSide::Motion),
        gap(BacklashSide::Torque),
        None,
        gap(BacklashSide::Motion),
    ];
    let robot = arms::mh12();
    let mut motions = robot.chain().motions().to_vec();
    for motion in &mut motions {
        if let Motion::Along(_, Amount::Constant(length)) = motion {
            *length *= 1.0005;
        }
    }
    model.actual = Some(Arc::new(
        Robot::new("actual", motions, robot.joints().to_vec()).unwrap(),
    ));
    model
}

#[test]
fn no_turn_and_branch_is_better() {
    by_every_turn_and_branch(StiffnessModel::DRIVES);
}

#[test]
fn no_turn_and_branch_of_a_worn_arm_is_better() {
    by_every_turn_and_branch(&worn());
    let in_plane = |found: HolesFound| found.answers.points[0].as_ref().unwrap().in_plane;
    let least = in_plane(found(&holes(), &SEARCH));
    assert!(in_plane(found_by(&worn(), &holes(), &SEARCH)) > 2.0 * least);
}

/// Reference: every turn in every branch, each evaluated separately.
fn by_every_turn_and_branch(model: &StiffnessModel) {
    let (robot, tool) = (arms::mh12(), tool());
    let (holes, track) = (holes(), track(&holes()));
    let found = found_by(model, &holes, &SEARCH);
    for index in 0..4 {
        let here = track.loaded_stop(index, &load());
        let mut least = f64::INFINITY;
        for turn in 0..SEARCH.spins.count {
            let pose = here.stop.base_from_tool * about_z(SEARCH.spins.at(turn));
            for branch in Branch::ALL {
                let requested = Question {
                    cases: &here.cases,
                    normal: here.stop.normal,
                    choice: BranchChoice::Of(branch.into()),
                    ..question(&robot, &tool, model)
                };
                let answers = evaluate(&requested, 1, |_| pose, Watch::NONE).unwrap();
                if let Ok(evaluation) = &answers.points[0]
                    && evaluation.within_limits()
                {
                    least = least.min(evaluation.in_plane);
                }
            }
        }
        let evaluation = found.answers.points[index].as_ref().unwrap();
        assert!(found.statuses[index] == PostureStatus::Usable && evaluation.within_limits());
        // Postures near a singularity are not used by the search; lanes and the general computation differ by rounding.
        assert!(
            evaluation.in_plane >= least * (1.0 - 1e-9) && evaluation.in_plane <= least * 1.02,
            "{index}: {} m where {least} m is",
            evaluation.in_plane
        );
    }
}

#[test]
fn the_nominal_posture_is_kept_where_the_gain_is_not_significant() {
    // Turned out of the plane of the arm, where axes 4 and 6 are aligned.
    let track = Track {
        spins: Some(vec![1.0; 4]),
        ..track(&holes()[..4])
    };
    let in_plane = |found: &HolesFound, i: usize| found.answers.points[i].as_ref().unwrap().in_plane;
    let beyond = |amount: f64| {
        let least = LeastGain {
            amount,
            ..LeastGain::ANY
        };
        found_beyond(&least, StiffnessModel::DRIVES, &track, &SEARCH)
    };
    let (best, nominal) = (beyond(0.0), beyond(1.0));
    // At the other holes the nominal posture is not usable.
    let kept: Vec<usize> = (0..4).filter(|i| nominal.spins[*i] == 0.0).collect();
    let name = |i: usize| nominal.answers.points[i].as_ref().unwrap().name;
    assert!(
        kept.len() > 1 && kept.iter().all(|i| name(*i) == name(kept[0])),
        "{kept:?}"
    );
    for i in (0..4).filter(|i| !kept.contains(i)) {
        assert_eq!(in_plane(&nominal, i), in_plane(&best, i));
    }
    // Between the smallest and the largest gain some change and some do not.
    let gains: Vec<f64> = (0..4)
        .map(|i| in_plane(&nominal, i) - in_plane(&best, i))
        .collect();
    let (least, most) = (
        gains.iter().copied().fold(f64::INFINITY, f64::min),
        gains.iter().copied().fold(0.0, f64::max),
    );
    assert!(least < most, "{gains:?}");
    let amount = 0.5 * (least + most);
    let some = beyond(amount);
    for (i, gain) in kept.iter().zip(&gains) {
        let expected = if *gain > amount { &best } else { &nominal };
        assert_eq!(in_plane(&some, *i), in_plane(expected, *i), "{i}: {gain}");
    }
}

#[test]
fn the_order_of_the_holes_changes_nothing() {
    let forwards = holes();
    let backwards: Vec<Hole> = forwards.iter().rev().copied().collect();
    let (a, b) = (found(&forwards, &SEARCH), found(&backwards, &SEARCH));
    for (i, j) in (0..5).zip((0..5).rev()) {
        assert_eq!((a.spins[i], a.statuses[i]), (b.spins[j], b.statuses[j]));
        assert_eq!(a.answers.joints_at(i), b.answers.joints_at(j));
        assert_eq!(a.answers.deviations_at(i), b.answers.deviations_at(j));
        assert_eq!(
            format!("{:?}", a.answers.points[i]),
            format!("{:?}", b.answers.points[j])
        );
    }
}

#[test]
fn a_hole_out_of_reach_is_reported_and_does_not_affect_the_others() {
    let found_all = found(&holes(), &SEARCH);
    assert_eq!(found_all.statuses[4], PostureStatus::OutOfReach);
    assert!(found_all.answers.points[4].is_err());
    let some = found(&holes()[..4], &SEARCH);
    assert_eq!(some.spins, found_all.spins[..4]);
}

#[test]
fn turning_improves_and_a_restricted_search_keeps_its_branch() {
    let still = PostureSearch {
        spins: Steps {
            first: 0.0,
            step: 0.1,
            count: 1,
        },
        branches: BranchPattern::FRONT_ELBOW_UP,
        ..SEARCH
    };
    let (free, fixed) = (found(&holes()[..4], &SEARCH), found(&holes()[..4], &still));
    let in_plane = |found: &HolesFound, i: usize| found.answers.points[i].as_ref().unwrap().in_plane;
    assert!((0..4).all(|i| in_plane(&free, i) <= in_plane(&fixed, i) * (1.0 + 1e-9)));
    assert!((0..4).any(|i| in_plane(&free, i) < 0.9 * in_plane(&fixed, i)));
    for point in fixed.answers.points.iter().flatten() {
        let crate::robot::PostureName::Branch(branch) = point.name else {
            panic!("a named branch");
        };
        assert!(BranchPattern::FRONT_ELBOW_UP.matches(branch));
    }
}

#[test]
fn the_tool_points_into_each_hole_and_its_thrust_out_of_it() {
    let holes = holes();
    let (track, load) = (track(&holes), load());
    assert_eq!(track.len(), holes.len());
    for (index, hole) in holes.iter().enumerate() {
        let stop = track.loaded_stop(index, &load);
        let out = track.placing.base_from_path.rotation * hole.axis;
        assert!((stop.stop.normal.into_inner() - out.into_inner()).norm() < 1e-12);
        let looks = stop.stop.base_from_tool * Vector3::z();
        assert!((looks + out.into_inner()).norm() < 1e-12);
        assert!((stop.cases[0].force.dot(&out) - 120.0).abs() < 1e-9);
    }
}

#[test]
fn a_cancelled_search_stops() {
    let (robot, tool) = (arms::mh12(), tool());
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let watch = Watch {
        finished: &|_| (),
        cancel: &cancel,
    };
    let question = question(&robot, &tool, StiffnessModel::DRIVES);
    let gave = hole_postures(
        &question,
        LoadedTrack {
            track: &track(&holes()),
            load: &load(),
        },
        &SEARCH,
        &LeastGain::ANY,
        watch,
    );
    assert!(gave.is_err());
}
