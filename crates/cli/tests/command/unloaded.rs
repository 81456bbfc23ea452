//! Deviations along a path apart from the load: a robot file with backlash, and the calibrated robot.

use crate::cell::{Cell, number, numbers, rows};
use crate::documents::repository;

const CELL: &str = r#"format = 1
robot = "arm.toml"
tolerance_um = 200
plane = { centre_mm = [900, 150, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
tool = { flange_from_tool_mm_deg = [0, 0, 250, 0, 0, 0] }
load = { cases_n = [[3, -5, -5]] }
[[analysis]]
kind = "path"
name = "ring"
circle.radius_mm = 60
step_mm = 2
"#;

fn mh12() -> String {
    std::fs::read_to_string(repository().join("robots/yaskawa/mh12.toml")).unwrap()
}

/// The MH12 with backlash in all joints.
fn with_backlash() -> String {
    let play = "\nbacklash_deg = 0.01\nbacklash_u_deg = 0.001\nbacklash_source = \"paper\"\ncompliance_source = \"paper\"";
    mh12().replace("\ncompliance_source = \"paper\"", play)
}

fn ring(cell: &Cell, out: &str) -> serde_json::Value {
    let said = cell.armill(&["run", "study.toml", "--no-pictures", "--json", "--out", out]);
    said.fine().json()["paths"][0].clone()
}

#[test]
fn backlash_of_the_robot_file_is_part_of_the_deviation_along_a_path() {
    let cell = Cell::with_study(CELL);
    cell.file("arm.toml", mh12());
    let without = ring(&cell, "without");
    assert!(without["unloaded"].is_null());
    cell.file("arm.toml", with_backlash());
    let with = ring(&cell, "with");
    let unloaded = &with["unloaded"];
    let joints = unloaded["joints"].as_array().unwrap();
    assert_eq!(joints.len(), 6);
    assert!((number(&joints[0]["backlash_deg"]) - 0.01).abs() < 1e-12);
    // On a ring every joint of the arm reverses at least once.
    assert!(
        joints[..3].iter().all(|joint| number(&joint["reversals"]) >= 1.0),
        "{unloaded}"
    );
    let most = number(&unloaded["max_in_plane_um"]);
    assert!(
        most > 50.0,
        "0.01 deg at a metre are 170 um a joint, half of it either way: {most}"
    );
    assert!(number(&with["max_in_plane_um"]) > number(&without["max_in_plane_um"]) + 0.2 * most);
    // The worst point, computed alone, is the same, and its contributions add up to it.
    let worst = &with["worst_points"][0]["point"];
    let in_plane = number(&worst["in_plane_um"]);
    assert!((in_plane - number(&with["max_in_plane_um"])).abs() < 1e-3);
    let shares: f64 = worst["joint_share_um"]
        .as_array()
        .unwrap()
        .iter()
        .map(number)
        .sum();
    assert!((shares - in_plane).abs() < 1e-3, "{worst}");
    let table = std::fs::read_to_string(cell.at("with/ring.csv")).unwrap();
    assert!(table.contains("unloaded_cross_um"));
    let model = with["setting"]["model"].to_string();
    assert!(model.contains("backlash of S, L, U, R, B, T"), "{model}");
}

#[test]
fn what_is_known_of_backlash_and_geometry_is_compensated() {
    let cell =
        Cell::with_study(&CELL.replace("arm.toml\"", "yaskawa/mh12\"\ncalibrated_robot = \"arm.toml\""));
    // Longer links, and backlash.
    cell.file(
        "arm.toml",
        mh12()
            .replace("length_mm = 640", "length_mm = 640.4")
            .replace("length_mm = 614", "length_mm = 613.7"),
    );
    let given = cell.armill(&["compensate", "study.toml", "--json"]).fine().json();
    let path = &given["paths"][0];
    let [before, after] = ["before", "after"].map(|when| number(&path[when]["rms_um"]));
    assert!(before > 200.0 && after < 1.0, "{before} {after}");
    cell.file("arm.toml", with_backlash());
    cell.file("study.toml", CELL);
    let given = cell.armill(&["compensate", "study.toml", "--json"]).fine().json();
    let path = &given["paths"][0];
    let [before, after] = ["before", "after"].map(|when| number(&path[when]["rms_um"]));
    assert!(before > 50.0 && after < 0.3 * before, "{before} {after}");
}

#[test]
fn compliances_and_backlash_of_the_calibrated_robot_are_those_of_the_arm() {
    let calibrated = CELL.replace("arm.toml\"", "nominal.toml\"\ncalibrated_robot = \"arm.toml\"");
    let cell = Cell::with_study(&calibrated);
    let without = |text: &str| {
        let lines: Vec<&str> = text
            .lines()
            .filter(|line| !line.starts_with("compliance_"))
            .collect();
        let text = lines.join("\n");
        let of_compliances =
            |block: &&str| block.starts_with("sources.paper]") || block.starts_with("sources.assumed]");
        let blocks: Vec<&str> = text.split("\n[").filter(|block| !of_compliances(block)).collect();
        blocks.join("\n[")
    };
    // A nominal robot without compliances is enough.
    cell.file("nominal.toml", without(&mh12()));
    cell.file("arm.toml", with_backlash());
    let measured = ring(&cell, "measured");
    cell.file("study.toml", CELL);
    let alone = ring(&cell, "alone");
    for key in ["max_in_plane_um", "max_full_um"] {
        let [measured, alone] = [&measured, &alone].map(|path| number(&path[key]));
        assert!(
            (measured - alone).abs() < 1e-6 && alone > 50.0,
            "{key}: {measured} {alone}"
        );
    }
    assert_eq!(measured["unloaded"]["joints"], alone["unloaded"]["joints"]);
    let result = cell.result("measured").to_string();
    assert!(result.contains("actual:paper"), "{result}");
    // A calibrated geometry without compliances leaves those of the nominal robot; its uncertainty is not known, or that of its file.
    cell.file("study.toml", &calibrated);
    cell.file("nominal.toml", with_backlash());
    cell.file("arm.toml", without(&mh12()));
    let nominal = ring(&cell, "nominal");
    let warned = |out: &str| {
        cell.result(out)["warnings"]
            .to_string()
            .contains("the calibrated geometry")
    };
    assert!(warned("nominal"));
    let uncertain = "[geometry_covariance]\nof = [\"S about z\"]\nmatrix_mm_deg = [[1e-4]]\nsource = \"ros-industrial\"\n\n[[frame]]";
    cell.file("arm.toml", without(&mh12()).replacen("[[frame]]", uncertain, 1));
    ring(&cell, "known");
    assert!(!warned("known"));
    assert!((number(&nominal["max_in_plane_um"]) - number(&alone["max_in_plane_um"])).abs() < 1e-6);
    cell.file("nominal.toml", without(&mh12()));
    let said = cell.armill(&["run", "study.toml", "--no-pictures"]);
    said.refused(&["no joint compliance is known"]);
}

#[test]
fn maps_report_the_worst_case_of_backlash() {
    let map = CELL.split_once("[[analysis]]").unwrap().0;
    let cell = Cell::with_study(map);
    let given = |arm: String| {
        cell.file("arm.toml", arm);
        let said = cell.armill(&["run", "study.toml", "--no-pictures", "--json"]);
        said.fine().json()
    };
    let without = given(mh12());
    assert!(!without["warnings"].to_string().contains("gaps"));
    let with = given(with_backlash());
    let farthest = "maps, sections, volumes and holes report the worst case";
    assert!(
        with["warnings"].to_string().contains(farthest),
        "{}",
        with["warnings"]
    );
    let worst = |given: &serde_json::Value| given["maps"][0]["worst"].clone();
    // Half of 0.01 deg at a metre are 87 um a joint.
    assert!(number(&worst(&with)["in_plane_um"]) > number(&worst(&without)["in_plane_um"]) + 100.0);
    let shares = worst(&with)["joint_share_um"]
        .as_array()
        .unwrap()
        .iter()
        .map(number)
        .sum::<f64>();
    assert!((shares - number(&worst(&with)["in_plane_um"])).abs() < 1e-3);
}

#[test]
fn a_single_pose_has_the_deviation_of_the_map_with_backlash_in_it_and_its_shares() {
    let map = CELL.split_once("[[analysis]]").unwrap().0;
    let cell = Cell::with_study(&map.replace("step_mm = 50", "step_mm = 100"));
    cell.file("arm.toml", with_backlash());
    let run = cell
        .armill(&["run", "study.toml", "--no-pictures", "--json"])
        .fine()
        .json();
    let worst = &run["maps"][0]["worst"];
    let joints: Vec<String> = worst["joints_deg"]
        .as_array()
        .unwrap()
        .iter()
        .map(ToString::to_string)
        .collect();
    let pose = |arm: &str| {
        let joints = format!("--joints-deg={}", joints.join(","));
        let said = cell.armill(&[
            "pose",
            arm,
            &joints,
            "--tool-mm",
            "0,0,250",
            "--wrench-n",
            "3,-5,-5",
            "--json",
        ]);
        said.fine().json()["postures"][0].clone()
    };
    let given = pose("arm.toml");
    let deviation = numbers(&given["deviation_um"]);
    // The plane is upright: its normal, and the tool axis, is vertical.
    let axis = 2;
    let in_plane = (0..3)
        .filter(|k| *k != axis)
        .map(|k| deviation[k].powi(2))
        .sum::<f64>()
        .sqrt();
    let of_map = number(&worst["in_plane_um"]);
    assert!((in_plane - of_map).abs() < 1e-6 * of_map, "{in_plane} {of_map}");
    let mut sum = [0.0; 3];
    for share in rows(&given["joint_share_um"]) {
        (0..3).for_each(|k| sum[k] += share[k]);
    }
    assert!(
        (0..3).all(|k| (sum[k] - deviation[k]).abs() < 1e-6 * of_map),
        "{sum:?} {deviation:?}"
    );
    cell.file("stiff.toml", mh12());
    let without = numbers(&pose("stiff.toml")["deviation_um"]);
    let length = |v: &[f64]| v.iter().map(|um| um * um).sum::<f64>().sqrt();
    assert!(
        length(&deviation) > length(&without) + 20.0,
        "{deviation:?} {without:?}"
    );
}

#[test]
fn a_map_of_a_measured_arm_has_its_geometry() {
    let map = CELL.split_once("[[analysis]]").unwrap().0;
    let cell =
        Cell::with_study(&map.replace("arm.toml\"", "yaskawa/mh12\"\ncalibrated_robot = \"arm.toml\""));
    let fraction = |arm: String| {
        cell.file("arm.toml", arm);
        let said = cell
            .armill(&["run", "study.toml", "--no-pictures", "--json"])
            .fine()
            .json();
        let map = said["maps"][0].clone();
        let answer = said["answer"].to_string();
        (
            number(&map["fraction_within"]),
            number(&map["max_in_plane_um"]),
            answer,
        )
    };
    assert_eq!(fraction(mh12()).0, 1.0);
    let longer = mh12().replace("length_mm = 640", "length_mm = 641");
    let (within, most, answer) = fraction(longer);
    assert!(within < 0.5 && most > 500.0, "{within} {most}");
    assert!(
        answer.contains("largest contribution: the geometry ("),
        "{answer}"
    );
}

#[test]
fn an_arm_that_does_not_fit_is_refused_at_its_place() {
    let cell = Cell::with_study(&CELL.replace(
        "arm.toml\"",
        "yaskawa/mh12\"\ncalibrated_robot = \"nowhere.toml\"",
    ));
    cell.armill(&["check", "study.toml"])
        .refused(&["study.toml:3:", "nowhere.toml"]);
    cell.file("lever.toml", LEVER);
    cell.file(
        "study.toml",
        CELL.replace("arm.toml\"", "yaskawa/mh12\"\ncalibrated_robot = \"lever.toml\""),
    );
    cell.armill(&["check", "study.toml"]).refused(&[
        "study.toml:3:",
        "`lever.toml` has another number of joints (1, not 6) than `yaskawa/mh12`",
    ]);
}

#[test]
fn an_arm_whose_zero_is_another_is_no_measured_one() {
    let cell =
        Cell::with_study(&CELL.replace("arm.toml\"", "yaskawa/mh12\"\ncalibrated_robot = \"other.toml\""));
    cell.file("other.toml", mh12().replacen("sign = -1", "sign = 1", 1));
    cell.armill(&["check", "study.toml"]).refused(&[
        "study.toml:3:",
        "mm (allowed: 20 mm) from that of `yaskawa/mh12`",
        "senses, zeros and base frame",
    ]);
}

const LEVER: &str = r#"format = 1
name = "lever"
[chain]
source = "made-up"
motions = [{ about = "z", joint = "A" }, { along = "x", length_mm = 500 }]
[[joint]]
name = "A"
sign = 1
source = "made-up"
[sources.made-up]
what = "made up"
where = "here"
licence = "none"
"#;

/// The largest uncertainty, the scatter of the setting and the parts of the model reported for a map.
fn unsure(cell: &Cell) -> (f64, Option<f64>, String) {
    let given = cell
        .armill(&["run", "study.toml", "--no-pictures", "--json"])
        .fine()
        .json();
    let map = &given["maps"][0];
    (
        number(&map["worst"]["in_plane_u_um"]),
        map["setting"]["scatter_um"].as_f64(),
        map["setting"]["model"].to_string(),
    )
}

#[test]
fn scatter_increases_the_uncertainty_and_the_study_has_precedence() {
    let map = CELL.split_once("[[analysis]]").unwrap().0;
    let cell = Cell::with_study(map);
    cell.file("arm.toml", mh12());
    let (still, none, _) = unsure(&cell);
    assert_eq!(none, None, "not known is null");
    let table = "[repeatability]\npose_mm = 0.08\nsource = \"paper\"\n\n[chain]";
    cell.file("arm.toml", mh12().replacen("[chain]", table, 1));
    let sigma = 80.0 / 3.616_088;
    let (by_file, given, model) = unsure(&cell);
    assert!((given.unwrap() - sigma).abs() < 1e-4, "{given:?}");
    assert!((by_file - still.hypot(sigma)).abs() < 1e-3, "{by_file} {still}");
    assert!(model.contains("repeatability in the uncertainty"), "{model}");
    cell.file(
        "study.toml",
        map.replacen("tolerance_um", "repeatability_mm = 0.04\ntolerance_um", 1),
    );
    let (by_study, _, _) = unsure(&cell);
    assert!(
        (by_study - still.hypot(0.5 * sigma)).abs() < 1e-3,
        "{by_study} {still}"
    );
    cell.file(
        "study.toml",
        map.replacen("tolerance_um", "repeatability_mm = -1\ntolerance_um", 1),
    );
    cell.armill(&["check", "study.toml"])
        .refused(&["study.toml:3:", "repeatability_mm"]);
}

#[test]
fn the_table_has_the_deviation_without_load() {
    let cell = Cell::with_study(&CELL.replace("[[3, -5, -5]]", "[[0, 0, 0]]"));
    cell.file("arm.toml", with_backlash());
    ring(&cell, "out");
    let table = std::fs::read_to_string(cell.at("out/ring.csv")).unwrap();
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let at = |name: &str| names.iter().position(|other| *other == name).unwrap();
    let (all, part) = (at("cross_um"), at("unloaded_cross_um"));
    let mut given = 0;
    for line in lines {
        let cells: Vec<f64> = line
            .split(',')
            .map(|cell| cell.parse().unwrap_or(f64::NAN))
            .collect();
        assert!((cells[all] - cells[part]).abs() < 1e-3, "{line}");
        given += 1;
    }
    assert!(given > 100);
}
