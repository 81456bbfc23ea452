//! Placement in a cell: the placement found keeps the demanded clearance at every point, and no placement of a lattice that keeps it is better.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use armill_core::clearance::CellState;
use armill_core::watch::Watch;
use armill_plan::place::{Journal, PlacementAnswer, PlacementParameters, PlacementSearch};
use armill_study::analysis::AnalysisData;
use armill_study::error::StudyError;
use armill_study::file::placement::PlaceTable;
use armill_study::file::resolve::{Study, read};
use armill_study::run::run;

/// The demanded clearance, mm.
const LEAST_MM: f64 = 20.0;
/// The branch of a search.
const BRANCH: &str = "posture = { branch = \"front elbow-up no-flip\" }";
/// Permitted ranges of x, y and z, mm.
const RANGES_MM: [[f64; 2]; 3] = [[700.0, 1100.0], [-300.0, 300.0], [400.0, 1000.0]];

/// A ring on a vertical plate, a spindle, and a wall in front of the robot as high as this, mm.
fn study(wall_mm: f64, centre_mm: [f64; 3], more: &str) -> Study {
    let text = format!(
        r#"
format = 1
robot = "yaskawa/mh12"
tolerance_um = 500
least_clearance_mm = {LEAST_MM}
plane = {{ centre_mm = {centre_mm:?}, tilt_deg = 90, half_size_mm = 100, step_mm = 50 }}
load = {{ cases_n = [[3, 5, 5]] }}
{more}
[tool]
flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]
[[tool.body]]
name = "spindle"
cylinder_mm = {{ from = [0, 0, 0], to = [0, 0, 120], diameter = 60 }}
[part]
box_mm = {{ from = [-100, -100, -50], to = [100, 100, 0] }}
[[obstacle]]
name = "wall"
box_mm = {{ from = [600, -150, 0], to = [900, 150, {wall_mm}] }}
[[analysis]]
kind = "path"
name = "ring"
circle.radius_mm = 60
step_mm = 100
"#
    );
    read("study.toml", Path::new("."), text.as_bytes()).unwrap()
}

fn ranges() -> PlaceTable {
    let [x, y, z] = RANGES_MM.map(Some);
    PlaceTable {
        x_mm: x,
        y_mm: y,
        z_mm: z,
        ..PlaceTable::default()
    }
}

fn placed(study: &Study, watch: Watch<'_>) -> Result<PlacementAnswer, StudyError> {
    let search = PlacementSearch::new(study, ranges(), 0)?.brief();
    Ok(search.search(&mut Journal::none(), watch, &|_| ())?.answer)
}

/// Clearance at each point of the path, mm, of all pairs without bounds or limits; none where there is no posture.
fn clearances_mm(study: &Study) -> Vec<Option<f64>> {
    let done = run(study, Watch::NONE).unwrap();
    let AnalysisData::Path(path, result) = &done[0].found else {
        panic!("a path");
    };
    let cell = path.setting.cell.as_ref().unwrap();
    let mut state = CellState::new(cell.placed(), &study.robot.robot, &path.setting.flange_from_tool);
    let answers = &result.along.answers;
    let mut clearance = |index: usize| {
        answers.points[index].as_ref().ok()?;
        state.set_joints(answers.joints_at(index));
        let found = state.clearance(f64::INFINITY).unwrap();
        assert!(!cell.cell.always_near().contains(&found.bodies), "near by design");
        Some(found.nearest.distance * 1e3)
    };
    (0..answers.points.len()).map(&mut clearance).collect()
}

#[test]
fn the_placement_keeps_the_clearance_at_every_point_and_none_of_a_lattice_is_better() {
    let study_there = study(800.0, [1000.0, 0.0, 500.0], BRANCH);
    let found = placed(&study_there, Watch::NONE).unwrap();
    assert_eq!(found.recommended.unreachable_points, 0, "{:?}", found.recommended);
    assert_eq!(
        (found.recommended.in_collision, found.recommended.nearest),
        (0, None)
    );
    assert_eq!(found.demanded_clearance_mm, Some(LEAST_MM));
    let branch = found.recommended.branch.unwrap();
    let posture = format!("posture = {{ branch = \"{branch}\" }}");
    let clearances = clearances_mm(&study(800.0, found.place.centre_mm, &posture));
    assert!(!clearances.is_empty());
    for clearance in clearances {
        assert!(clearance.unwrap() >= LEAST_MM, "{clearance:?}");
    }
    let search = PlacementSearch::new(&study_there, ranges(), 0).unwrap();
    let nominal = search.nominal_parameters();
    let at = |index: usize| {
        let part = |axis: usize, step: usize| {
            let [least, greatest] = RANGES_MM[axis];
            (least + (greatest - least) * step as f64 / 5.0) / 1e3
        };
        let [.., heading, tilt, roll] = nominal.part;
        PlacementParameters {
            part: [
                part(0, index % 6),
                part(1, index / 6 % 6),
                part(2, index / 36),
                heading,
                tilt,
                roll,
            ],
            ..nominal
        }
    };
    let lattice: Vec<PlacementParameters> = (0..216).map(at).collect();
    let scores = search.evaluate(&lattice, Watch::NONE).unwrap().scores;
    let clear: Vec<usize> = (0..216).filter(|index| scores[*index].unreachable == 0).collect();
    assert!(clear.len() > 10 && clear.len() < 150, "{}", clear.len());
    for index in &clear {
        assert!(
            scores[*index].cost * 1e6 > found.recommended.cost_um - 1e-3,
            "{:?} {:?}",
            lattice[*index],
            scores[*index]
        );
    }
    // Scores of the lattice against the analysis of the study with its part there.
    for index in (0..216).step_by(31).chain(clear.iter().copied().step_by(11)) {
        let [x, y, z, ..] = lattice[index].part.map(|metres| metres * 1e3);
        let branch = scores[index].branch.unwrap();
        let posture = format!("posture = {{ branch = \"{branch}\" }}");
        let there = clearances_mm(&study(800.0, [x, y, z], &posture));
        let lost = there.iter().filter(|clearance| clearance.is_none()).count();
        assert_eq!(lost, scores[index].unreachable, "{:?}", lattice[index]);
        assert!(there.iter().flatten().all(|clearance| *clearance >= LEAST_MM));
    }
}

#[test]
fn where_no_placement_keeps_the_clearance_the_bodies_and_their_distance_are_reported() {
    let study = study(2500.0, [1000.0, 0.0, 500.0], BRANCH);
    let found = placed(&study, Watch::NONE).unwrap();
    let best = &found.recommended;
    assert!(
        best.in_collision > 0 && best.unreachable_points >= best.in_collision,
        "{best:?}"
    );
    assert!(best.least_clearance_mm.unwrap() < LEAST_MM);
    let [first, second] = best.nearest.as_ref().unwrap();
    let said = &found.sentences()[0];
    for words in [
        "no placement was found at which all points can be reached with the demanded clearance",
        &format!("at the worst {first} and {second} "),
    ] {
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn a_search_in_a_cell_reports_progress_and_can_be_cancelled() {
    let study = study(800.0, [1000.0, 0.0, 500.0], BRANCH);
    let (count, cancel) = (AtomicUsize::new(0), AtomicBool::new(false));
    let finished = |places: usize| {
        if count.fetch_add(places, Ordering::Relaxed) > 500 {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let watch = Watch {
        finished: &finished,
        cancel: &cancel,
    };
    assert!(matches!(placed(&study, watch), Err(StudyError::Cancelled(_))));
    assert!(count.load(Ordering::Relaxed) > 500);
}
