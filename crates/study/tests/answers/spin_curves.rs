//! A spin that changes along a path: `spin_curve_mm_deg`.

use std::path::Path;

use armill_core::units::to_deg;
use armill_formats::table::ColumnData;
use armill_study::analysis::AnalysisData;
use armill_study::file::resolve::read;
use armill_study::output::points_table;

use crate::{PLATE, answered, found, plate_with};

/// A circle of 628.3 mm; a tool across the flange, so that a spin moves the wrist.
const CIRCLE: &str = "tool.flange_from_tool_mm_deg = [100, 0, 150, 0, 90, 0]\n[[analysis]]\nkind = \"path\"\nname = \"c\"\nplane = { centre_mm = [850, 0, 300], tilt_deg = 90 }\ncircle.radius_mm = 100\n";

fn circle_with(keys: &str) -> String {
    format!("{CIRCLE}{keys}\n")
}

#[test]
fn a_curve_of_one_spin_is_that_spin() {
    let with = |keys: &str| answered(&plate_with(&circle_with(keys))).paths.remove(0);
    let curve = with("spin_deg = 10\nspin_curve_mm_deg = [[0, 25], [600, 25]]");
    let constant = with("spin_deg = 35");
    let worst = |path: &armill_study::answer::PathAnswer| path.max_in_plane_um.unwrap();
    // A pose reached by one turn or by two: rounding.
    assert!((worst(&curve) / worst(&constant) - 1.0).abs() < 1e-9);
    assert!((worst(&with("")) / worst(&constant) - 1.0).abs() > 1e-3);
}

#[test]
fn the_spin_between_points_is_linear_and_is_in_the_table() {
    let study = plate_with(&circle_with(
        "spin_deg = 10\nspin_curve_mm_deg = [[100, -20], [300, 20]]",
    ));
    let done = found(&study);
    let AnalysisData::Path(analysis, _) = &done[0].found else {
        panic!("a path")
    };
    let table = points_table(&study, &done[0]).unwrap();
    let column = table.columns().iter().find(|column| column.name == "turn_deg");
    let turns: Vec<f64> = match &column.unwrap().data {
        ColumnData::Float(turns) => turns.clone(),
        ColumnData::OptionalFloat(turns) => turns.iter().map(|turn| turn.unwrap()).collect(),
        other => panic!("{other:?}"),
    };
    let nominal = plate_with(&circle_with("spin_deg = 10"));
    let nominal = found(&nominal);
    let AnalysisData::Path(nominal, _) = &nominal[0].found else {
        panic!("a path")
    };
    for (index, point) in analysis.track.path.points.iter().enumerate() {
        let expected = (-20.0 + 0.2 * (point.along * 1e3 - 100.0)).clamp(-20.0, 20.0);
        // The table has six decimals.
        assert!((turns[index] - expected).abs() < 1e-6, "{index}");
        let [own, other] = [&analysis.track, &nominal.track].map(|track| track.stop(index).base_from_tool);
        let turned = to_deg(own.rotation.angle_to(&other.rotation));
        assert!((turned - expected.abs()).abs() < 1e-6, "{index}");
    }
}

#[test]
fn what_is_no_curve_is_reported_at_its_point() {
    for (keys, words, hint) in [
        (
            "spin_curve_mm_deg = [[0, 10]]",
            "`spin_curve_mm_deg` must have at least 2 points (got 1)",
            "spin_deg",
        ),
        (
            "spin_curve_mm_deg = [[0, 10], [50, 20], [50, 30]]",
            "`spin_curve_mm_deg[2]` is at 50 mm: must be greater than 50 mm",
            "order of the path",
        ),
        (
            "spin_curve_mm_deg = [[0, 10], [700, 20]]",
            "`spin_curve_mm_deg[1]` is at 700 mm: the path ranges from 0 to 628.3 mm",
            "from its start",
        ),
        (
            "spin_curve_mm_deg = [[-1, 10], [600, 20]]",
            "`spin_curve_mm_deg[0]` is at -1 mm",
            "from its start",
        ),
        (
            "spin_curve_mm_deg = [[0, 10], [600, 800]]",
            "`spin_curve_mm_deg[1]` has a spin of 800 deg",
            "360 deg",
        ),
        (
            "spin_curve_mm_deg = [[0, 10], [600, 20]]\nposture.search = {}",
            "`spin_curve_mm_deg` and `posture.search` both specify the spin",
            "remove one of them",
        ),
    ] {
        let text = format!("{PLATE}{}", circle_with(keys));
        let error = read("study.toml", Path::new("."), text.as_bytes()).unwrap_err();
        let message = error.to_string();
        assert!(message.contains(words), "{message}");
        assert!(message.contains(hint), "{message}");
    }
    let map = "[[analysis]]\nkind = \"map\"\nspin_curve_mm_deg = [[0, 1], [1, 1]]\n";
    let error = read("study.toml", Path::new("."), format!("{PLATE}{map}").as_bytes()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("`spin_curve_mm_deg` is not valid for a map"),
        "{error}"
    );
}
