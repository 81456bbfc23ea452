//! What a page shows of an answer agrees with the answer: postures, other quantities, reachable placements, headlines.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::Path;

use armill_core::watch::Watch;
use armill_study::live::{
    ChangedValue, LayerKey, LayerRequest, PoseTarget, PostureQuestion, StudyText, ViewQuestion, changed,
    postures, reachable, table_csv, view,
};
use armill_study::studies::{self, FoundStudy};
use serde_json::json;

/// The example study, as a folder with its files.
fn example(name: &str) -> FoundStudy {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    studies::find(&folder.join(name)).unwrap()
}

fn text(found: &FoundStudy) -> StudyText<'_> {
    StudyText {
        shown: &found.shown,
        folder: &found.folder,
        bytes: &found.bytes,
    }
}

/// A column of the table of an analysis.
fn column(text: StudyText<'_>, analysis: &str, name: &str) -> Vec<String> {
    let table = String::from_utf8(table_csv(text, Some(analysis), Watch::NONE).unwrap()).unwrap();
    let mut rows = table.lines().filter(|row| !row.starts_with('#'));
    let heads: Vec<&str> = rows.next().unwrap().split(',').collect();
    let at = heads.iter().position(|head| head.split(' ').next() == Some(name));
    let at = at.unwrap_or_else(|| panic!("{name} in {heads:?}"));
    rows.map(|row| row.split(',').nth(at).unwrap().to_owned())
        .collect()
}

#[test]
fn the_posture_shown_at_holes_and_along_paths_is_that_of_the_table() {
    for (study, analysis, every) in [
        ("kr210-rivets", "rivets", 1),
        ("mh12-ballbar", "groove", 9),
        ("mh12-ballbar", "side", 9),
    ] {
        let found = example(study);
        let branches = column(text(&found), analysis, "branch");
        for (index, branch) in branches.iter().enumerate().step_by(every) {
            let at = PoseTarget {
                point: Some(index),
                ..PoseTarget::default()
            };
            let question = PostureQuestion {
                analysis: Some(analysis),
                at,
                case: 1,
            };
            let pose = postures(text(&found), &question, Watch::NONE).unwrap();
            let shown = pose
                .answered
                .unwrap_or_else(|| panic!("{study} {analysis} {index}"));
            let shown = &pose.answer.postures[shown].branch;
            assert_eq!(shown, branch, "{study} {analysis} {index}");
        }
    }
}

#[test]
fn the_posture_shown_on_a_plate_is_that_of_the_map() {
    let found = example("mh12-groove");
    for analysis in ["Fig. 6", "Fig. 6, elbow down"] {
        let branches = column(text(&found), analysis, "branch");
        let question = ViewQuestion {
            analysis: Some(analysis),
            ..ViewQuestion::default()
        };
        let shown = view(text(&found), &question, Watch::NONE).unwrap();
        let grid = &shown.answer.maps[0].grid;
        for index in [0, grid.points / 3, grid.points - 1] {
            let columns = grid.y_mm.len();
            let at = PoseTarget {
                y_mm: Some(grid.y_mm[index % columns]),
                z_mm: Some(grid.z_mm[index / columns]),
                ..PoseTarget::default()
            };
            let question = PostureQuestion {
                analysis: Some(analysis),
                at,
                case: 1,
            };
            let pose = postures(text(&found), &question, Watch::NONE).unwrap();
            let branch = pose.answer.postures[pose.answered.unwrap()].branch.clone();
            assert_eq!(branch, branches[index], "{analysis} {index}");
        }
    }
}

#[test]
fn a_layer_has_the_values_of_its_column() {
    for (study, analysis) in [
        ("mh12-groove", "Fig. 6, elbow down"),
        ("kr210-rivets", "rivets"),
        ("kr120-groove", "groove"),
    ] {
        let found = example(study);
        for key in [
            LayerKey::InPlaneUm,
            LayerKey::NormalUm,
            LayerKey::FullUm,
            LayerKey::InPlaneUUm,
            LayerKey::ProbabilityWithin,
            LayerKey::LimitMarginDeg,
        ] {
            let request = LayerRequest { key, levels: None };
            let question = ViewQuestion {
                analysis: Some(analysis),
                layer: Some(&request),
                lines: true,
                ..ViewQuestion::default()
            };
            let layer = view(text(&found), &question, Watch::NONE).unwrap().layer.unwrap();
            let expected = column(text(&found), analysis, key.quantity().key);
            let values = &layer.values[0];
            assert_eq!(values.len(), expected.len());
            for (value, expected) in values.iter().zip(&expected) {
                let expected: Option<f64> = expected.parse().ok();
                assert_eq!(value.is_some(), expected.is_some(), "{study} {key:?}");
                if let (Some(value), Some(expected)) = (value, expected) {
                    assert!(
                        (value - expected).abs() < 1e-9 + 1e-3 * expected.abs().min(1.0),
                        "{study} {key:?}"
                    );
                }
            }
            let levels = layer.levels.unwrap();
            let known = || values.iter().flatten().copied();
            assert!(
                known().all(|v| levels[0] <= v && v <= levels[levels.len() - 1]),
                "{study} {key:?}"
            );
        }
        let request = LayerRequest {
            key: LayerKey::LargestShare,
            levels: None,
        };
        let question = ViewQuestion {
            analysis: Some(analysis),
            layer: Some(&request),
            ..ViewQuestion::default()
        };
        let layer = view(text(&found), &question, Watch::NONE).unwrap().layer.unwrap();
        assert!(layer.levels.is_none() && layer.names.len() >= 6);
        assert!(
            layer.values[0]
                .iter()
                .flatten()
                .all(|v| *v < layer.names.len() as f64)
        );
    }
}

#[test]
fn a_part_out_of_reach_has_a_nearest_place_that_is_reached() {
    let whole = |study: &str, analysis: &str, centre: [f64; 3]| {
        let found = example(study);
        let change = |text: StudyText<'_>, centre: [f64; 3]| {
            let change = ChangedValue {
                key: "plane.centre_mm".to_owned(),
                value: json!(centre),
                whole: false,
            };
            changed(text, Some(analysis), &[change]).unwrap().text
        };
        let far = change(text(&found), centre);
        let of = |bytes: &'static str| StudyText {
            bytes: bytes.as_bytes(),
            ..text(&found)
        };
        let far = of(String::leak(far));
        let answer = reachable(far, Some(analysis), Watch::NONE).unwrap();
        assert_eq!(answer.key, "plane.centre_mm");
        let near = answer.centre_mm.unwrap_or_else(|| panic!("{study}"));
        let apart = (0..3).map(|i| (near[i] - centre[i]).powi(2)).sum::<f64>().sqrt();
        assert!((apart - answer.distance_mm.unwrap()).abs() <= 1.0);
        let near = of(String::leak(change(far, near)));
        let question = ViewQuestion {
            analysis: Some(analysis),
            ..ViewQuestion::default()
        };
        (view(near, &question, Watch::NONE).unwrap().answer, apart)
    };
    let (answer, apart) = whole("mh12-groove", "Fig. 6", [3500.0, 200.0, 900.0]);
    assert_eq!(answer.maps[0].counts.unreached(), 0);
    assert!(answer.maps[0].outside_joint_limits < answer.maps[0].grid.points / 10);
    assert!((1800.0..2900.0).contains(&apart), "{apart}");
    let (answer, _) = whole("kr120-groove", "groove", [4000.0, 0.0, 1000.0]);
    assert_eq!(answer.paths[0].unreachable, 0);
}

#[test]
fn the_nearest_place_keeps_clear_of_the_cell() {
    let plain = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 500
plane = { centre_mm = [1000, 0, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
load = { cases_n = [[3, 5, 5]] }
tool.flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]
"#;
    let cell = r#"least_clearance_mm = 20
[part]
box_mm = { from = [-100, -100, -50], to = [100, 100, 0] }
[[obstacle]]
name = "wall"
box_mm = { from = [600, -150, 0], to = [900, 150, 700] }
"#;
    let path = "[[analysis]]\nkind = \"path\"\nname = \"ring\"\ncircle.radius_mm = 60\nstep_mm = 50\nposture.branch = \"best\"\n";
    let nearest = |cell: &str, centre: [f64; 3]| {
        let study = format!("{plain}{cell}{path}").replace("[1000, 0, 500]", &format!("{centre:?}"));
        let text = StudyText {
            shown: "study.toml",
            folder: Path::new("."),
            bytes: study.as_bytes(),
        };
        let seen = view(text, &ViewQuestion::default(), Watch::NONE).unwrap().answer;
        let answer = reachable(text, Some("ring"), Watch::NONE).unwrap();
        (seen.paths[0].in_collision, answer.centre_mm.unwrap())
    };
    let here = [1000.0, 0.0, 500.0];
    // Without the wall the ring is reached where it is.
    assert_eq!(nearest("", here), (0, here));
    let (in_collision, near) = nearest(cell, here);
    assert!(in_collision > 0 && near != here, "{near:?}");
    assert_eq!(nearest(cell, near).0, 0, "{near:?}");
}

#[test]
fn what_is_outside_joint_limits_is_not_reported_as_within() {
    let found = example("mh12-groove");
    let change = ChangedValue {
        key: "tolerance_um".to_owned(),
        value: json!(110),
        whole: false,
    };
    let analysis = "Fig. 6, elbow down";
    let wide = changed(text(&found), Some(analysis), &[change]).unwrap().text;
    let wide = StudyText {
        bytes: wide.as_bytes(),
        ..text(&found)
    };
    let question = ViewQuestion {
        analysis: Some(analysis),
        ..ViewQuestion::default()
    };
    let answer = view(wide, &question, Watch::NONE).unwrap().answer;
    let map = &answer.maps[0];
    assert_eq!(map.fraction_within, 1.0);
    assert!(map.outside_joint_limits > 5000 && map.fraction_within_and_inside_joint_limits < 0.2);
    assert!(
        answer
            .answer
            .contains("17.1 % of the plane is within 110 µm and inside joint limits (100.0 %"),
        "{}",
        answer.answer
    );
}
