//! Rapids between cuts: their tool and their axes.

use armill_core::frame::Isometry;
use armill_core::machined::{MachiningPath, PathTool, Stage};
use armill_core::nalgebra::{Unit, Vector3};
use armill_core::path::{Course, Move, Operation, Pace, PathBuilder, Placing, Sampling, Spin, Step, Track};
use armill_core::watch::Watch;

use crate::{MM, at, block, end_mill, everywhere};

/// A move to a place (mm) with a tool tilted by an angle (rad) about y.
fn to(place: [f64; 3], tilt: f64, pace: Pace) -> Step {
    Step::Move(Move {
        end: at(place[0], place[1], place[2]),
        axis: Some(Unit::new_normalize(Vector3::new(tilt.sin(), 0.0, tilt.cos()))),
        spin: None,
        course: Course::Line,
        pace,
        line: 1,
    })
}

fn tool(number: u32) -> Step {
    Step::Operation(Operation {
        tool: Some(number),
        ..Operation::default()
    })
}

fn track(steps: Vec<Step>) -> Track {
    let sampling = Sampling {
        chord_error: 1e-6,
        step: 100.0 * MM,
    };
    let mut builder = PathBuilder::new(sampling, 100);
    steps.into_iter().for_each(|step| builder.take(step));
    Track {
        path: builder.finish().unwrap(),
        placing: Placing {
            base_from_path: Isometry::identity(),
            axis: Vector3::z_axis(),
            keeps_axis: false,
            spin: Spin::Fixed(0.0),
        },
        base_from_part: Isometry::identity(),
        spins: None,
        homes: None,
    }
}

const FEED: Pace = Pace::Feed(0.01);

/// A hole by a tool of 4 mm, then a slot by one of 10 mm; the tool is changed above.
fn hole_and_slot() -> Track {
    track(vec![
        tool(1),
        to([10.0, 10.0, 5.0], 0.0, Pace::Rapid),
        to([10.0, 10.0, -8.0], 0.0, FEED),
        to([10.0, 10.0, 30.0], 0.0, Pace::Rapid),
        tool(2),
        to([30.0, 10.0, 30.0], 0.0, Pace::Rapid),
        to([30.0, 10.0, -2.0], 0.0, FEED),
        to([50.0, 10.0, -2.0], 0.0, FEED),
    ])
}

fn stages(track: &Track, tools: &[PathTool]) -> Vec<Stage> {
    let path = MachiningPath {
        track,
        tools,
        turn_tolerance: 1e-6,
    };
    path.stages(None)
}

#[test]
fn a_tool_leaves_its_hole_before_it_is_changed() {
    let track = hole_and_slot();
    let second = track.path.operations[1].0;
    let tools = [
        end_mill(4.0, 0.0),
        PathTool {
            first: second,
            ..end_mill(10.0, 0.0)
        },
    ];
    let stages = stages(&track, &tools);
    let rapids: Vec<Vec<bool>> = stages
        .iter()
        .map(|stage| stage.moves.iter().map(|of| of.is_rapid).collect())
        .collect();
    assert_eq!(stages.iter().map(|stage| stage.tool).collect::<Vec<_>>(), [0, 1]);
    assert_eq!(rapids, [vec![false, true], vec![true, false, false]]);
    let path = MachiningPath {
        track: &track,
        tools: &tools,
        turn_tolerance: 1e-6,
    };
    let stock = block([0.0, 0.0, -10.0], [60.0, 20.0, 0.0]);
    let (_, removals) = path.cut(stock, &stages, Watch::NONE).unwrap();
    // The hole is cut by its tool alone, and no rapid meets material.
    let all = stages.iter().flat_map(|stage| &stage.moves).zip(&removals);
    assert!(all.clone().all(|(of, removal)| !removal.is_rapid_in_material(of)));
    let hole = removals[0].volume / MM.powi(3);
    let expected = std::f64::consts::PI * 4.0 * 8.0;
    // Cells of 0.5 mm on a wall 12.6 mm around and 8 mm deep.
    assert!((hole - expected).abs() < 0.25 * 12.6 * 8.0, "{hole}");
}

#[test]
fn a_rapid_ends_with_its_own_axis_and_the_last_one_with_that_of_the_next_cut() {
    let track = track(vec![
        to([0.0, 0.0, 0.0], 0.0, Pace::Rapid),
        to([10.0, 0.0, 0.0], 0.0, FEED),
        to([10.0, 0.0, 50.0], 0.0, Pace::Rapid),
        to([40.0, 0.0, 50.0], 0.5, Pace::Rapid),
        to([40.0, 0.0, 0.0], 0.5, Pace::Rapid),
        to([50.0, 0.0, 0.0], 0.5, FEED),
    ]);
    let stages = stages(&track, &[end_mill(4.0, 0.0)]);
    let tilts = stages[0].moves.iter().map(|of| of.axes.map(|axis| axis.x.asin()));
    let expected = [[0.0, 0.0], [0.0, 0.0], [0.0, 0.5], [0.5, 0.5], [0.5, 0.5]];
    for (tilts, expected) in tilts.zip(expected) {
        assert!((tilts[0] - expected[0]).abs() < 1e-12 && (tilts[1] - expected[1]).abs() < 1e-12);
    }
    assert_eq!(stages[0].moves.len(), expected.len());
}

#[test]
fn a_rapid_out_of_a_hole_is_displaced_as_the_hole_and_the_next_one_as_the_next_cut() {
    let track = hole_and_slot();
    let tools = [end_mill(4.0, 0.0)];
    let path = MachiningPath {
        track: &track,
        tools: &tools,
        turn_tolerance: 1e-6,
    };
    // The hole has two points.
    let mut deviations = everywhere(&track, [0.1, 0.2, 0.3], [0.0, 1e-3, 0.0]);
    let hole = everywhere(&track, [-0.2, 0.0, 0.0], [0.0; 3]);
    deviations[..2].copy_from_slice(&hole[..2]);
    let displaced = path.stages(Some(&deviations));
    let by: Vec<Vector3<f64>> = displaced[0]
        .moves
        .iter()
        .zip(&path.stages(None)[0].moves)
        .map(|(of, programmed)| (of.ends[1] - programmed.ends[1]) / MM)
        .collect();
    for (number, by) in by.iter().enumerate() {
        let expected = match number < 2 {
            true => Vector3::new(-0.2, 0.0, 0.0),
            false => Vector3::new(0.1, 0.2, 0.3),
        };
        assert!((by - expected).norm() < 1e-9, "{number}: {by}");
    }
    assert!(displaced[0].moves[1].is_rapid);
    // A rotation about y tilts the axis towards x.
    let tilts: Vec<f64> = displaced[0].moves.iter().map(|of| of.axes[1].x).collect();
    assert!(tilts[1] == 0.0 && tilts[2..].iter().all(|tilt| (tilt - 1e-3).abs() < 1e-8));
}
