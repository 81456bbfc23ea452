//! Scores with a demanded clearance, compared with every point of every branch.

use nalgebra::Point3;

use super::*;
use crate::clearance::{
    self, ArmBody, Bounds, Capsule, CellState, DemandedClearance, FixedBody, PlacedCell, Role, Segment, Shape,
};
use crate::kernel::{Column, ColumnLoad, Columns, PostureStatus};
use crate::optimize::{FreePath, PostureSearch, Steps};
use crate::robot::Attachment;

/// Upper arm, forearm, a spindle and its cutter, a post in front of the arm, and the plate under the path.
fn bodies(robot: &Robot, tool: &Isometry) -> clearance::Cell {
    let capsule = |from: [f64; 3], to: [f64; 3], radius: f64| {
        Shape::Capsule(Capsule {
            axis: Segment {
                from: from.into(),
                to: to.into(),
            },
            radius,
        })
    };
    let body = |name: &str, attachment: Attachment, shape: Shape, role: Role| ArmBody {
        name: name.to_owned(),
        attachment,
        attachment_from_body: Isometry::identity(),
        shape,
        role,
    };
    let block = |name: &str, from: [f64; 3], to: [f64; 3], is_part: bool| FixedBody {
        name: name.to_owned(),
        shape: Shape::Box(Bounds::of([Point3::from(from), Point3::from(to)])),
        frame_from_body: Isometry::identity(),
        is_part,
    };
    let arm = vec![
        body(
            "upper arm",
            Attachment::Joint(1),
            capsule([0.0; 3], [0.0, 0.0, 0.614], 0.08),
            Role::Link,
        ),
        body(
            "forearm",
            Attachment::Joint(3),
            capsule([0.2, 0.0, 0.0], [0.5, 0.0, 0.0], 0.06),
            Role::Link,
        ),
        body(
            "spindle",
            Attachment::Flange,
            capsule([0.0, 0.0, 0.03], [0.02, 0.0, 0.08], 0.03),
            Role::Holder,
        ),
    ];
    let still = [
        block("post", [0.45, 0.1, 0.0], [0.55, 0.3, 1.1], false),
        block("plate", [-0.15, -0.15, -0.1], [0.15, 0.15, -0.005], true),
    ];
    let cell = clearance::Cell::new(robot, tool, arm, &[], &still);
    let cell = cell.for_clearance(robot, tool, LEAST);
    assert!(
        cell.always_near().is_empty(),
        "a pair near by design would hide others"
    );
    cell
}

/// The demanded clearance, m.
const LEAST: f64 = 0.02;
/// Smallest bend of the wrist, rad.
const WRIST: f64 = 0.05;

#[test]
fn scores_with_a_demanded_clearance_are_those_of_every_point_of_every_branch() {
    let cell = Cell::new();
    let bodies = bodies(&cell.robot, &cell.tool);
    let nowhere = Isometry::identity();
    let demanded = DemandedClearance {
        placed: PlacedCell {
            cell: &bodies,
            base_from_part: &nowhere,
        },
        least: LEAST,
    };
    let question = Question {
        clearance: Some(demanded),
        ..cell.question()
    };
    let track = track(nowhere, Spin::Fixed(0.2), 0.1);
    let load = load(LoadFrame::Part);
    let all: Vec<usize> = (0..track.len()).collect();
    let path = on_part(
        LoadedTrack {
            track: &track,
            load: &load,
        },
        Component::InPlane,
        &all,
    );
    let objective = PlacementObjective {
        component: Component::InPlane,
        objective: Objective::Worst,
        branches: BranchPattern::default(),
        margin: 0.0,
        wrist: WRIST,
        rank_by: RankBy::Nominal,
        selection: PostureSelection::ForPath,
    };
    let placeable = |question| Placeable {
        question,
        path: &path,
        objective,
    };
    let at = |x: usize, y: usize, z: usize| PartPlacement {
        base_from_part: Isometry::translation(
            0.6 + 0.15 * x as f64,
            -0.3 + 0.2 * y as f64,
            0.3 + 0.2 * z as f64,
        ),
        spin: 0.3,
        rail: None,
    };
    let places: Vec<PartPlacement> = (0..64).map(|i| at(i % 4, i / 4 % 4, i / 16)).collect();
    let scores = placeable(&question).scores(&places, None, Watch::NONE).unwrap();
    let free = Question {
        clearance: None,
        ..question
    };
    let without = placeable(&free).scores(&places, None, Watch::NONE).unwrap();
    let (mut worse, mut other_branch, mut clear) = (0, 0, 0);
    for ((place, score), without) in places.iter().zip(&scores).zip(&without) {
        let (score, without) = (score.unwrap(), without.unwrap());
        // One branch after the other, one point after the other, all pairs of bodies without a limit.
        let of_branch = |branch: Branch| {
            let alone = PlacementObjective {
                branches: branch.into(),
                ..objective
            };
            let alone = Placeable {
                objective: alone,
                ..placeable(&free)
            };
            let free = alone.scores(&[*place], None, Watch::NONE).unwrap()[0].unwrap();
            let lost = lost_points((&cell, &bodies), &track, place, branch);
            Score {
                unreachable: lost,
                ..free
            }
        };
        let expected = Branch::ALL
            .into_iter()
            .map(of_branch)
            .reduce(|best, other| if other.beats(&best) { other } else { best })
            .unwrap();
        assert_eq!(score.unreachable, expected.unreachable, "{place:?}");
        assert!(
            (score.cost - expected.cost).abs() < 1e-12,
            "{score:?} {expected:?}"
        );
        worse += usize::from(score.unreachable > without.unreachable);
        other_branch += usize::from(score.branch != without.branch);
        clear += usize::from(score.unreachable == 0);
        // With a bar: better ones as without, of others at most that they are no better.
        for bar in [without, expected] {
            let barred = placeable(&question)
                .scores(&[*place], Some(&bar), Watch::NONE)
                .unwrap()[0];
            match score.beats(&bar) {
                true => assert_eq!(barred, Some(score)),
                false => assert!(barred.is_none_or(|barred| !barred.beats(&bar))),
            }
        }
    }
    assert!(
        worse > 5 && other_branch > 0 && clear > 5,
        "{worse} {other_branch} {clear}"
    );
}

/// Points where the branch cannot be used at a placement, or two bodies are nearer than demanded.
fn lost_points(of: (&Cell, &clearance::Cell), track: &Track, place: &PartPlacement, branch: Branch) -> usize {
    let (cell, bodies) = of;
    let placed = PlacedCell {
        cell: bodies,
        base_from_part: &place.base_from_part,
    };
    let mut state = CellState::new(placed, &cell.robot, &cell.tool);
    let slot = Branch::ALL.iter().position(|other| *other == branch).unwrap();
    let mut columns = Columns::new(cell.question().arm, None, WRIST);
    let no_load = ColumnLoad {
        cases: &[Wrench::ZERO],
        along: [Vector3::zeros(); 2],
    };
    let about = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), place.spin);
    let mut column = Column::default();
    let mut is_lost = |index: usize| {
        let part_from_tool = track.base_from_part.inverse() * track.stop(index).base_from_tool;
        columns.fill(
            &[place.base_from_part * part_from_tool * about],
            &no_load,
            &mut column,
        );
        if column.statuses[slot] != PostureStatus::Usable {
            return true;
        }
        state.set_joints(column.joints_of(slot, 6));
        state.clearance(f64::INFINITY).unwrap().nearest.distance < LEAST
    };
    (0..track.len()).filter(|index| is_lost(*index)).count()
}

#[test]
fn the_quick_score_of_spins_is_that_of_the_best_clear_posture_of_each_point() {
    let cell = Cell::new();
    let bodies = bodies(&cell.robot, &cell.tool);
    let nowhere = Isometry::identity();
    let question = Question {
        clearance: Some(DemandedClearance {
            placed: PlacedCell {
                cell: &bodies,
                base_from_part: &nowhere,
            },
            least: LEAST,
        }),
        ..cell.question()
    };
    let (track, load) = (track(nowhere, Spin::Fixed(0.2), 0.1), load(LoadFrame::Part));
    let path = LoadedTrack {
        track: &track,
        load: &load,
    };
    let spins = Steps {
        first: -1.0,
        step: 0.7,
        count: 4,
    };
    let search = PostureSearch {
        spins,
        lean: None,
        axes: Vec::new(),
        component: Component::InPlane,
        objective: Objective::Mean,
        branches: BranchPattern::FRONT_ELBOW_UP,
        turn_rate: 1.0,
        turn_price: 0.0,
        back_price: 0.0,
        wrist: WRIST,
        margin: 0.0,
    };
    let places: Vec<PartPlacement> = (0..16)
        .map(|i| PartPlacement {
            base_from_part: Isometry::translation(
                0.6 + 0.15 * f64::from(i % 4),
                -0.3 + 0.2 * f64::from(i / 4),
                0.5,
            ),
            spin: 0.3,
            rail: None,
        })
        .collect();
    let all: Vec<usize> = (0..track.len()).collect();
    let free = FreePath {
        question: &question,
        path,
        search: &search,
        stock: None,
    };
    let quick = free.quick_scores(&places, &all, Watch::NONE).unwrap();
    let on_part = on_part(path, Component::InPlane, &all);
    let each = Placeable {
        question: &question,
        path: &on_part,
        objective: PlacementObjective {
            component: Component::InPlane,
            objective: Objective::Mean,
            branches: BranchPattern::FRONT_ELBOW_UP,
            margin: 0.0,
            wrist: WRIST,
            rank_by: RankBy::Nominal,
            selection: PostureSelection::PerPoint(spins),
        },
    };
    let each = each.scores(&places, None, Watch::NONE).unwrap();
    let mut lost = 0;
    for (quick, each) in quick.iter().zip(each) {
        let each = each.unwrap();
        assert_eq!(quick.unreachable, each.unreachable);
        assert!((quick.cost - each.cost).abs() < 1e-9 * (each.cost + 1e-4));
        lost += quick.unreachable;
    }
    assert!(lost > 0 && lost < 16 * all.len(), "{lost}");
}
