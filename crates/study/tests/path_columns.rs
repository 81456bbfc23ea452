//! The columns of a path are its table and its scene, and a path that is kept answers as one that is evaluated again.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::Path;

use armill_core::watch::Watch;
use armill_study::live::{
    LayerKey, LayerRequest, PathCache, PathInView, PoseTarget, PostureQuestion, StudyText, ViewQuestion,
    postures, scene, table_csv, view,
};
use armill_study::studies::{self, FoundStudy};

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

fn path_of(text: StudyText<'_>, analysis: &str, paths: &PathCache) -> PathInView {
    let question = ViewQuestion {
        analysis: Some(analysis),
        paths: Some(paths),
        ..ViewQuestion::default()
    };
    view(text, &question, Watch::NONE).unwrap().path.unwrap()
}

/// The values of one column.
fn values(text: StudyText<'_>, analysis: &str, paths: &PathCache, key: &str) -> Vec<f32> {
    let bytes = paths.columns(text, (Some(analysis), &[key.to_owned()]), Watch::NONE);
    let bytes = bytes.unwrap();
    bytes
        .chunks_exact(4)
        .map(|four| f32::from_le_bytes(four.try_into().unwrap()))
        .collect()
}

#[test]
fn every_column_is_the_one_of_the_table_or_of_the_scene() {
    for (study, analysis) in [("mh12-ballbar", "groove"), ("r2000ic-pocket", "pocket")] {
        let (found, paths) = (example(study), PathCache::default());
        let path = path_of(text(&found), analysis, &paths);
        let csv = String::from_utf8(table_csv(text(&found), Some(analysis), Watch::NONE).unwrap()).unwrap();
        let rows: Vec<Vec<&str>> = csv
            .lines()
            .filter(|row| !row.starts_with('#'))
            .map(|row| row.split(',').collect())
            .collect();
        let (heads, rows) = rows.split_first().unwrap();
        assert_eq!(rows.len(), path.points);
        let mut compared = 0;
        for column in &path.columns {
            let given = values(text(&found), analysis, &paths, &column.key);
            assert_eq!(given.len(), path.points * column.components, "{}", column.key);
            let Some(at) = heads
                .iter()
                .position(|head| head.split(' ').next() == Some(&column.key))
            else {
                continue;
            };
            compared += 1;
            for (value, row) in given.iter().zip(rows) {
                match row[at].parse::<f64>() {
                    // 24 bits, and the decimals of the table.
                    Ok(expected) => {
                        let apart = (f64::from(*value) - expected).abs();
                        assert!(
                            apart <= 1e-7 * expected.abs() + 6e-4,
                            "{} {value} {expected}",
                            column.key
                        );
                    }
                    Err(_) => assert!(value.is_nan(), "{} {value}", column.key),
                }
            }
        }
        assert!(compared > 12, "{compared}");
        let joints = path.columns.iter().filter(|column| column.joint.is_some());
        assert!(joints.clone().count() == 6 && joints.clone().all(|joint| joint.lower < joint.upper));
        let points = scene(text(&found), Some(analysis), Watch::NONE)
            .unwrap()
            .points
            .unwrap();
        let near = |a: f32, b: f64| (f64::from(a) - b).abs() <= 1e-7 * b.abs() + 6e-4;
        let xyz = values(text(&found), analysis, &paths, "xyz_mm");
        let expected = points.xyz_mm.as_flattened();
        assert!(xyz.iter().zip(expected).all(|(a, b)| near(*a, *b)));
        let deviation = values(text(&found), analysis, &paths, "deviation_um");
        let expected: Vec<f64> = points.deviation_um.iter().flat_map(|d| d.unwrap()).collect();
        assert!(deviation.iter().zip(&expected).all(|(a, b)| near(*a, *b)));
        let outside = values(text(&found), analysis, &paths, "outside_joint_limits");
        let expected = |i: usize| f32::from(u8::from(points.outside_joint_limits.contains(&i)));
        assert!(outside.iter().enumerate().all(|(i, value)| *value == expected(i)));
    }
}

#[test]
fn the_force_of_a_path_is_that_of_its_worst_case_and_its_time_that_of_its_feeds() {
    let (found, paths) = (example("r2000ic-pocket"), PathCache::default());
    let path = path_of(text(&found), "pocket", &paths);
    let force = values(text(&found), "pocket", &paths, "force_n");
    // A plunge has no known force.
    let known: Vec<usize> = (0..path.points).filter(|index| !force[*index].is_nan()).collect();
    for index in [
        known[0],
        known[500],
        known[known.len() / 2],
        known[known.len() - 1],
    ] {
        let question = PostureQuestion {
            analysis: Some("pocket"),
            at: PoseTarget {
                point: Some(index),
                ..PoseTarget::default()
            },
            case: 1,
        };
        let pose = paths.postures(text(&found), &question, Watch::NONE).unwrap();
        let case = pose.in_plane[pose.answered.unwrap()][0].as_ref().unwrap();
        let expected = case.force_n.iter().map(|n| n * n).sum::<f64>().sqrt();
        assert!(
            (f64::from(force[index]) - expected).abs() < 1e-4 * expected + 1e-3,
            "{index}"
        );
    }
    let time = values(text(&found), "pocket", &paths, "time_s");
    let feed = values(text(&found), "pocket", &paths, "feed_mm_per_s");
    let distance = values(text(&found), "pocket", &paths, "distance_mm");
    for i in 1..path.points {
        let expected = (distance[i] - distance[i - 1]) / feed[i];
        // Sums of 4 bytes of some 1000 s.
        assert!((time[i] - time[i - 1] - expected).abs() < 1e-3, "{i}");
    }
    // A shape has no feed.
    let shape = path_of(text(&example("mh12-ballbar")), "groove", &paths);
    assert!(shape.columns.iter().all(|column| column.key != "time_s"));
    assert!(shape.operations.is_empty());
}

#[test]
fn points_are_not_in_the_view_if_they_are_requested_as_columns() {
    let (found, paths) = (example("r2000ic-pocket"), PathCache::default());
    let layer = LayerRequest {
        key: LayerKey::LimitMarginDeg,
        levels: None,
    };
    let question = ViewQuestion {
        analysis: Some("pocket"),
        layer: Some(&layer),
        paths: Some(&paths),
        ..ViewQuestion::default()
    };
    let given = view(text(&found), &question, Watch::NONE).unwrap();
    let path = given.path.as_ref().unwrap();
    assert!(given.scene.points.is_none());
    let of_layer = given.layer.as_ref().unwrap();
    assert!(of_layer.values.is_empty() && of_layer.levels.is_some());
    assert_eq!(
        path.worst.first().copied(),
        given.extremes[0].worst.as_ref().unwrap().point
    );
    assert_eq!(path.worst.len(), given.answer.paths[0].worst_points.len());
    // The same is in a second view, of the path that is kept, and without columns the points are there.
    let again = view(text(&found), &question, Watch::NONE).unwrap();
    assert_eq!(
        serde_json::to_string(&again).unwrap(),
        serde_json::to_string(&given).unwrap()
    );
    let usual = ViewQuestion {
        paths: None,
        ..question
    };
    let usual = view(text(&found), &usual, Watch::NONE).unwrap();
    assert!(usual.path.is_none());
    assert_eq!(usual.scene.points.unwrap().xyz_mm.len(), path.points);
    assert_eq!(usual.layer.unwrap().values[0].len(), path.points);
    assert_eq!(
        serde_json::to_string(&usual.answer).unwrap(),
        serde_json::to_string(&given.answer).unwrap()
    );
}

#[test]
fn a_kept_path_has_the_postures_of_one_that_is_evaluated_again() {
    for (study, analysis) in [("mh12-ballbar", "groove"), ("r2000ic-pocket", "pocket")] {
        let (found, paths) = (example(study), PathCache::default());
        path_of(text(&found), analysis, &paths);
        let question = PostureQuestion {
            analysis: Some(analysis),
            at: PoseTarget {
                point: Some(11),
                ..PoseTarget::default()
            },
            case: 1,
        };
        let kept = paths.postures(text(&found), &question, Watch::NONE).unwrap();
        let again = postures(text(&found), &question, Watch::NONE).unwrap();
        assert_eq!(
            serde_json::to_string(&kept).unwrap(),
            serde_json::to_string(&again).unwrap()
        );
    }
}

#[test]
fn a_path_is_evaluated_again_if_its_text_or_its_file_has_changed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("path.csv");
    let study = |tolerance: u32| {
        format!(
            "format = 1\nrobot = \"yaskawa/mh12\"\ntolerance_um = {tolerance}\nload = {{ cases_n = [[3, 5, 5]] }}\n\
             plane = {{ centre_mm = [1000, 50, 800], half_size_mm = 100, step_mm = 20 }}\n[[analysis]]\nkind = \"path\"\n\
             name = \"line\"\nprogram = {{ file = \"path.csv\" }}\n"
        )
    };
    let paths = PathCache::default();
    let points = |study: &str| {
        let text = StudyText {
            shown: "study.toml",
            folder: folder.path(),
            bytes: study.as_bytes(),
        };
        let state = values(text, "line", &paths, "in_plane_um");
        (state.len(), path_of(text, "line", &paths).points)
    };
    std::fs::write(&file, "x_mm,y_mm,z_mm\n0,0,0\n10,0,0\n").unwrap();
    let first = points(&study(50));
    assert!(first.0 == first.1 && first.0 > 1, "{first:?}");
    std::fs::write(&file, "x_mm,y_mm,z_mm\n0,0,0\n20,0,0\n").unwrap();
    let longer = points(&study(50));
    assert!(longer.0 == longer.1 && longer.0 > first.0, "{longer:?}");
    assert_eq!(points(&study(60)), longer);
}

#[test]
fn a_column_that_a_path_does_not_have_is_refused_with_those_that_it_has() {
    let (found, paths) = (example("mh12-ballbar"), PathCache::default());
    let refused = |analysis: &str, key: &str| {
        let keys = [key.to_owned()];
        let bytes = paths.columns(text(&found), (Some(analysis), &keys), Watch::NONE);
        bytes.unwrap_err().to_string()
    };
    assert!(refused("groove", "weight_kg").contains("the path has no column `weight_kg`"));
    let found = example("mh12-groove");
    let bytes = paths.columns(text(&found), (None, &["xyz_mm".to_owned()]), Watch::NONE);
    assert!(bytes.unwrap_err().to_string().contains("is not a path"));
}
