//! A robot without measured joint compliances: messages, and marking of assumed values.

use crate::cell::{Cell, number, numbers};

const CLASS: &str = r#"
format = 1
robot = "kuka/kr120r2500pro"
tolerance_um = 100
[compliance]
class = "heavy"
[plane]
centre_mm = [1750, 0, 1200]
tilt_deg = 90
half_size_mm = 100
step_mm = 50
[load]
cases_n = [[100, 0, 0]]
"#;

fn refused(from: &str, to: &str, words: &[&str]) {
    assert!(CLASS.contains(from), "the study has no `{from}`");
    Cell::with_study(&CLASS.replace(from, to))
        .armill(&["check", "study.toml"])
        .refused(words);
}

#[test]
fn a_robot_without_compliance_is_refused_with_two_alternatives() {
    refused(
        "[compliance]\nclass = \"heavy\"\n",
        "",
        &[
            "no joint compliance is known for robot `kuka/kr120r2500pro`",
            "armill identify",
            "class = ",
            "\"heavy\" (100 to 300 kg)",
        ],
    );
    let said = Cell::new()
        .armill(&["pose", "kuka/kr120r2500pro", "--joints-deg", "0,-90,90,0,0,0"])
        .fine();
    assert!(
        said.out.contains("armill identify") && said.out.contains("--compliance-class"),
        "{}",
        said.out
    );
}

#[test]
fn values_of_a_class_are_marked_in_answer_warnings_and_report() {
    let cell = Cell::with_study(CLASS);
    cell.armill(&["run", "."]).fine();
    let result = cell.result("out");
    assert_eq!(result["robot"]["compliance_assumed"], true);
    let joints = result["robot"]["joints"].as_array().unwrap();
    for joint in joints {
        let (c, u) = (
            &joint["compliance_rad_per_n_m"],
            &joint["compliance_u_rad_per_n_m"],
        );
        assert!(number(u) >= number(c), "{joint}");
    }
    for place in [&result["answer"], &result["warnings"]] {
        assert!(place.to_string().contains("assumed, not measured"), "{place}");
    }
    assert!(result["warnings"].to_string().contains("class heavy"));
    let report = std::fs::read_to_string(cell.at("out").join("report.html")).unwrap();
    for words in ["compliance of joint A1, assumed", "assumed, not measured"] {
        assert!(report.contains(words), "no `{words}` in the report");
    }
}

#[test]
fn a_class_together_with_given_values_is_refused() {
    refused(
        "class = \"heavy\"",
        "class = \"heavy\"\nrad_per_n_m = [1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6]\nsource = \"mine\"",
        &["both `rad_per_n_m` and `class` are given"],
    );
    refused(
        "class = \"heavy\"",
        "class = \"heavy\"\nu_rad_per_n_m = [1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6]\nassumed = false",
        &["a class has its own uncertainty", "values of a class are assumed"],
    );
}

#[test]
fn an_unknown_class_and_an_empty_table_are_refused() {
    refused("\"heavy\"", "\"huge\"", &["huge", "heavy"]);
    refused(
        "class = \"heavy\"",
        "source = \"mine\"",
        &["neither `rad_per_n_m` nor `class`"],
    );
    refused(
        "class = \"heavy\"",
        "rad_per_n_m = [1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6]",
        &["compliances without `source`"],
    );
}

#[test]
fn a_pose_with_a_class_reports_the_assumption() {
    let cell = Cell::new();
    let arguments = [
        "pose",
        "kuka/kr16-2",
        "--joints-deg",
        "0,-60,90,0,30,0",
        "--wrench-n",
        "0,0,-50",
    ];
    let with_class = |class: &'static str| [&arguments[..], &["--compliance-class", class]].concat();
    let said = cell.armill(&with_class("light")).fine();
    assert!(
        said.out
            .contains("assumed, not measured: values of the class light"),
        "{}",
        said.out
    );
    let json = cell
        .armill(&[&with_class("heavy")[..], &["--json"]].concat())
        .fine()
        .json();
    assert_eq!(json["compliance_assumed"], true);
    let posture = &json["postures"][0];
    let length = |key: &str| numbers(&posture[key]).iter().map(|v| v * v).sum::<f64>().sqrt();
    assert!(length("deviation_um") > 0.0);
    cell.armill(&with_class("huge")).refused(&["`huge`", "\"light\""]);
    cell.armill(&[
        "pose",
        "kuka/lbr-iiwa-14-r820",
        "--joints-deg",
        "0,1,2,3,4,5,6",
        "--compliance-class",
        "light",
    ])
    .refused(&["7 joints"]);
}

#[test]
fn a_class_removes_the_covariance_of_other_compliances() {
    let cell = Cell::new();
    let library = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/yaskawa/mh12.toml");
    let plain = std::fs::read_to_string(library).unwrap();
    // 50 % of the compliance of joint L, where the file has 20 %.
    let covariance = "[covariance]\nof = [\"S\", \"L\"]\nmatrix_rad2_per_n2_m2 = [[1.8e-13, 0], [0, 1.6e-12]]\nsource = \"paper\"\n";
    cell.file("plain.toml", &plain);
    cell.file("known.toml", format!("{plain}\n{covariance}"));
    let uncertainty = |file: &str, class: &[&str]| {
        let pose = [
            "pose",
            file,
            "--at-mm",
            "1000,0,800",
            "--wrench-n",
            "0,0,-50",
            "--json",
        ];
        let said = cell.armill(&[&pose[..], class].concat()).fine().json();
        numbers(&said["postures"][0]["deviation_u_um"])
    };
    assert_ne!(uncertainty("known.toml", &[]), uncertainty("plain.toml", &[]));
    let class = ["--compliance-class", "heavy"];
    assert_eq!(
        uncertainty("known.toml", &class),
        uncertainty("plain.toml", &class)
    );
}

#[test]
fn an_arm_on_a_rail_has_the_class_values_of_the_arm_and_a_rigid_rail() {
    let arm = include_str!("../../../../robots/kuka/kr120r2500pro.toml");
    let with_rail = arm
        .replacen("motions = [", "motions = [\n  { along = \"y\", joint = \"E1\" },", 1)
        .replacen(
            "[[joint]]",
            "[[joint]]\nname = \"E1\"\nsign = 1\nlimits_mm = [-3000, 3000]\nsource = \"ros-industrial\"\n\n[[joint]]",
            1,
        );
    let cell = Cell::with_study(CLASS);
    cell.file("railed.toml", with_rail);
    cell.file("rail.toml", CLASS.replace("kuka/kr120r2500pro", "railed.toml"));
    cell.armill(&["run", "study.toml", "--out", "without", "--no-pictures"])
        .fine();
    let said = cell
        .armill(&["run", "rail.toml", "--out", "with", "--no-pictures"])
        .fine();
    assert!(
        said.err
            .contains("No class has prismatic joints: E1 is taken as rigid."),
        "{}",
        said.err
    );
    let (without, with) = (cell.result("without"), cell.result("with"));
    let rail = &with["robot"]["joints"][0];
    assert_eq!(
        (&rail["name"], &rail["compliance_um_per_n"]),
        (&"E1".into(), &0.0.into())
    );
    let of_joint = |result: &serde_json::Value, index: usize| {
        number(&result["robot"]["joints"][index]["compliance_rad_per_n_m"])
    };
    for joint in 0..6 {
        assert_eq!(of_joint(&with, joint + 1), of_joint(&without, joint));
    }
    let largest = |result: &serde_json::Value| number(&result["maps"][0]["max_in_plane_um"]);
    assert!((largest(&with) - largest(&without)).abs() < 1e-6);
    let pose = [
        "pose",
        "railed.toml",
        "--compliance-class",
        "heavy",
        "--joints-deg",
        "0,0,-90,90,0,0,0",
    ];
    cell.armill(&pose).fine();
}
