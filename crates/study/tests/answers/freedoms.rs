//! Lean of the tool and external axes in a search along a path: what it chooses, and problems of its keys.

use super::*;
use std::fmt::Write;

use armill_core::load::{Advance, Engagement, Lean, Milling, Process};
use armill_study::analysis::AnalysisData;

/// An MH12 on a rail along y, described by the Denavit-Hartenberg file of the library with a joint in front.
pub(super) fn on_rail() -> tempfile::TempDir {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let library = std::fs::read_to_string(repository.join("robots/yaskawa/mh12.toml")).unwrap();
    let rail = "name = \"rail\"\nsign = 1\nlimits_mm = [-500, 3000]\nmax_speed_mm_per_s = 1000\nsource = \"made up\"\n\
                compliance_um_per_n = 0.001\ncompliance_source = \"made up\"\n\n[[joint]]";
    let text = library
        .replacen(
            "motions = [",
            "motions = [\n    { along = \"y\", joint = \"rail\" },",
            1,
        )
        .replacen("[[joint]]", &format!("[[joint]]\n{rail}"), 1)
        + "\n[sources.\"made up\"]\nwhat = \"A rail for tests\"\nwhere = \"none\"\nlicence = \"none\"\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.toml"), text).unwrap();
    folder
}

/// A line of 3 m along y, longer than the arm reaches.
fn long_line(search: &str) -> String {
    let mut text = String::from(
        "format = 1\nrobot = \"arm.toml\"\ntolerance_um = 500\n\
         tool = { flange_from_tool_mm_deg = [0, 0, 200, 0, 0, 0] }\n\
         plane = { centre_mm = [800, 1250, 300], tilt_deg = 90, half_size_mm = 100, step_mm = 25 }\n\
         load = { frame = \"feed\", cases_n = [[-40, 20, 10]] }\n",
    );
    let _ = write!(
        text,
        "[posture]\nsearch = {{ step_deg = 30{search} }}\n\
         [[analysis]]\nkind = \"path\"\nname = \"edge\"\npolyline_mm = [[-1500, 0], [1500, 0]]\n"
    );
    text
}

#[test]
fn a_line_longer_than_the_reach_is_followed_along_the_rail_and_says_how_far() {
    let folder = on_rail();
    let of = |search: &str| {
        let text = long_line(search);
        let study = read("study.toml", folder.path(), text.as_bytes()).unwrap();
        answered(&study).paths.remove(0)
    };
    let still = of("");
    assert!(still.unreachable > 0);
    let moving = of(", axes = [{ joint = \"rail\", step_mm = 100 }]");
    assert_eq!(moving.unreachable, 0, "{:?}", moving.obstacles);
    assert!(moving.obstacles.is_empty(), "{:?}", moving.obstacles);
    let search = moving.search.unwrap();
    assert!(search.applied);
    let [from, to] = search.axes[0].range;
    assert!(from >= -500.0 && to <= 3000.0 && to - from > 500.0, "{from} {to}");
    assert!(search.sentence().contains(", rail at "), "{}", search.sentence());
    // The joint table has the rail where the search put it.
    assert!((moving.joint_range_deg[0][1] - to).abs() < 1e-6);
}

/// A circle with a ball nose, in front of an MH12.
fn circle(lean: &str) -> String {
    format!(
        "{PLATE}posture = {{ branch = \"best\", search = {{ turns_deg = [0, 0]{lean} }} }}\n\
         [[analysis]]\nkind = \"path\"\nname = \"ring\"\ncircle = {{ radius_mm = 60 }}\n"
    )
}

#[test]
fn lean_within_its_range_is_chosen_where_it_is_a_gain() {
    let lean = ", lean = { lead_deg = [-15, 15], tilt_deg = [-15, 15], step_deg = 5, stepover_mm = 0.8, cutter = { diameter_mm = 12, corner_radius_mm = 6 } }";
    let path = answered(&study(&circle(lean))).paths.remove(0);
    let search = path.search.unwrap();
    let [leads, tilts] = [search.lead_range_deg.unwrap(), search.tilt_range_deg.unwrap()];
    for [from, to] in [leads, tilts] {
        assert!(from >= -15.0 - 1e-9 && to <= 15.0 + 1e-9 && from <= to);
    }
    // A ball nose leaves the same scallop in every lean: 6 mm - sqrt(36 mm^2 - 0.16 mm^2).
    let by_hand_um = (6.0 - (36.0_f64 - 0.16).sqrt()) * 1e3;
    assert!((search.scallop_um.unwrap() - by_hand_um).abs() < 1e-6);
    assert!(search.with.max_in_plane_um.unwrap() < search.without.max_in_plane_um.unwrap());
    let upright = answered(&study(&circle(""))).paths.remove(0).search.unwrap();
    assert_eq!((upright.lead_range_deg, upright.tilt_range_deg), (None, None));
}

#[test]
fn a_cut_with_lean_has_the_forces_of_the_leaning_tool() {
    let plate = PLATE.lines().filter(|line| !line.starts_with("load"));
    let text = plate.collect::<Vec<_>>().join("\n")
        + r#"
posture = { branch = "best", search = { step_deg = 30, lean = { lead_deg = [15, 15] } } }
[cut]
material = "aluminium-6082-t6"
cutter = { diameter_mm = 12, corner_radius_mm = 6, flutes = 2 }
axial_depth_mm = 1
side = "slot"
feed_mm_per_min = 1200
spindle_rpm = 6000
[[analysis]]
kind = "path"
name = "ring"
circle = { radius_mm = 60 }
"#;
    let study = study(&text);
    let results = found(&study);
    let AnalysisData::Path(analysis, path) = &results[0].found else {
        panic!("no path")
    };
    assert!(path.searched.as_ref().unwrap().applied);
    let cutting = &analysis.cut.as_ref().unwrap().cutting;
    let upright = Process {
        cutter: cutting.cutter,
        law: cutting.law,
        depth: cutting.depth,
        engagement: Engagement::at_depth(cutting.immersion, &cutting.cutter, cutting.depth).unwrap(),
        feed: cutting.feed.unwrap(),
        spindle: cutting.spindle.unwrap(),
    };
    let upright = upright.milling(Advance::Level).unwrap();
    let lean = Lean {
        lead: 15_f64.to_radians(),
        tilt: 0.0,
    };
    let leaning = upright.cut().leaning(lean, cutting.cutter.body());
    let leaning = Milling::new(cutting.cutter, cutting.law, leaning).unwrap();
    let [upright, expected] = [upright, leaning].map(|of| of.mean_force().norm());
    let largest = path.forces.as_ref().unwrap().largest_mean;
    // Leads of a chain are smoothed: roundings of 15 deg.
    assert!((largest / expected - 1.0).abs() < 1e-9, "{largest} {expected}");
    assert!((expected / upright - 1.0).abs() > 0.05, "{expected} {upright}");
}

/// The problems of a study in this folder.
fn problems(folder: &Path, text: &str) -> String {
    match read("study.toml", folder, text.as_bytes()) {
        Ok(_) => panic!("no problem in {text}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn what_cannot_lean_or_move_is_refused_with_its_key() {
    let here = Path::new(".");
    let ball = "cutter = { diameter_mm = 12, corner_radius_mm = 6 }";
    let cases = [
        (", lean = {}".to_owned(), "neither `lead_deg` nor `tilt_deg`"),
        (
            ", lean = { lead_deg = [0, 20] }".to_owned(),
            "the end of the tool is not known",
        ),
        (
            format!(", lean = {{ lead_deg = [20, 0], {ball} }}"),
            "from 20 to 0",
        ),
        (
            ", lean = { tilt_deg = [0, 20], cutter = { diameter_mm = 12, corner_radius_mm = 0 } }".to_owned(),
            "only a rounded corner",
        ),
        (
            ", lean = { tilt_deg = [0, 20], cutter = { diameter_mm = 12, corner_radius_mm = 7 } }".to_owned(),
            "only a rounded corner",
        ),
        (", axes = [{ joint = \"E9\" }]".to_owned(), "has no joint `E9`"),
        (
            ", axes = [{ joint = \"S\" }]".to_owned(),
            "is not an external axis",
        ),
    ];
    for (keys, expected) in cases {
        let said = problems(here, &circle(&keys));
        assert!(
            said.contains(expected) && said.contains("study.toml:7:"),
            "{keys}: {said}"
        );
    }
    let folder = on_rail();
    for (keys, expected) in [
        (
            "joint = \"rail\", range_mm = [0, 4000]",
            "not inside the limits of joint `rail`, -500 to 3000 mm",
        ),
        ("joint = \"rail\", range_mm = [2000, 1000]", "from 2000 to 1000"),
        ("joint = \"rail\" }, { joint = \"rail\"", "given twice"),
        ("joint = \"S\"", "its external axes: rail"),
    ] {
        let said = problems(folder.path(), &long_line(&format!(", axes = [{{ {keys} }}]")));
        assert!(said.contains(expected), "{keys}: {said}");
    }
}

#[test]
fn problems_of_lean_and_axes_are_reported_together() {
    let keys = ", lean = {}, axes = [{ joint = \"E8\" }, { joint = \"E9\" }]";
    let said = problems(Path::new("."), &circle(keys));
    for expected in ["neither `lead_deg`", "no joint `E8`", "no joint `E9`"] {
        assert!(said.contains(expected), "{said}");
    }
}

#[test]
fn holes_neither_lean_nor_move_axes() {
    let text = format!(
        "{PLATE}[[analysis]]\nkind = \"holes\"\nname = \"row\"\nload = {{ frame = \"feed\", cases_n = [[0, 0, 100]] }}\n\
         holes = {{ at_mm = [[0, 0, 0]], normals = [[0, 0, 1]] }}\nposture = {{ search = {{ lean = {{ lead_deg = [0, 5] }} }} }}\n"
    );
    let said = problems(Path::new("."), &text);
    assert!(said.contains("`lean` is not valid for holes"), "{said}");
}
