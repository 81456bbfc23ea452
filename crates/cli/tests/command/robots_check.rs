//! `armill robots check`: a robot file compared with readings of its pendant.

use crate::cell::{Cell, Said};

/// Yaskawa MH12, relative to the frame of the controller, computed by hand-written 4 x 4 products; two decimals as a
/// pendant shows.
const READINGS: [&str; 2] = [
    "10,20,-30,40,50,60 = 991.88,224.90,203.74,96.64,-5.38,129.09",
    "-25,35,-15,-50,35,-70 = 1026.10,-526.96,102.20,-113.47,11.34,-148.39",
];

fn check<'a>(file: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let poses = ["--pose", READINGS[0], "--pose", READINGS[1]];
    [
        &["robots", "check", file, "--convention", "yaskawa"][..],
        &poses,
        more,
    ]
    .concat()
}

/// The MH12 of the library with one thing changed.
fn changed(from: &str, to: &str) -> Cell {
    let cell = Cell::new();
    let text = include_str!("../../../../robots/yaskawa/mh12.toml");
    assert!(text.contains(from), "the robot file has no `{from}`");
    cell.file("arm.toml", text.replacen(from, to, 1));
    cell
}

/// What was said of a file that disagrees: exit code 1.
#[track_caller]
fn disagrees(said: Said) -> Said {
    assert_eq!(said.code, 1, "stdout:\n{}\nstderr:\n{}", said.out, said.err);
    said
}

#[test]
fn the_library_arm_agrees_with_its_pendant() {
    let said = Cell::new()
        .armill(&check("yaskawa/mh12", &["--base", "controller"]))
        .fine();
    assert!(
        said.out
            .contains("The file and the pendant agree within 1 mm and 0.1 deg."),
        "{}",
        said.out
    );
}

#[test]
fn a_wrong_sign_and_the_base_are_named_in_the_words_of_the_file() {
    let cell = changed("name = \"U\"\nsign = -1", "name = \"U\"\nsign = 1");
    let said = disagrees(cell.armill(&check("arm.toml", &[])));
    for words in [
        "joint U has the opposite sign: sign = -1 in place of 1",
        "450.00 mm above base_link, its frame `controller`",
    ] {
        assert!(said.out.contains(words), "no `{words}` in:\n{}", said.out);
    }
    let json = disagrees(cell.armill(&check("arm.toml", &["--json"]))).json();
    assert_eq!(json["verdict"], "explained");
    assert_eq!(json["explanations"][0]["changes"].as_array().unwrap().len(), 2);
    assert!(json["readings"][0]["apart_mm"].as_f64().unwrap() > 100.0);
}

#[test]
fn signs_zeros_the_flange_frame_and_the_base_are_found_together() {
    let text = include_str!("../../../../robots/yaskawa/mh12.toml");
    let mut other = text.to_owned();
    for [from, to] in [
        ["name = \"S\"\nsign = 1", "name = \"S\"\nsign = -1"],
        ["name = \"L\"\nsign = 1", "name = \"L\"\nsign = -1"],
        ["name = \"U\"\nsign = -1", "name = \"U\"\nsign = 1"],
        ["name = \"R\"\nsign = -1", "name = \"R\"\nsign = 1"],
        ["name = \"B\"\nsign = -1", "name = \"B\"\nsign = 1"],
    ] {
        assert!(other.contains(from), "the robot file has no `{from}`");
        other = other.replacen(from, to, 1);
    }
    let cell = Cell::new();
    cell.file("arm.toml", other);
    let json = disagrees(cell.armill(&check("arm.toml", &["--json"]))).json();
    assert_eq!(json["verdict"], "explained", "{json}");
    // Five signs and the height of the base: one more than was searched before.
    let changes = json["explanations"][0]["changes"].as_array().unwrap();
    assert_eq!(changes.len(), 6, "{json}");
}

#[test]
fn a_wrong_length_is_not_explained() {
    let cell = changed("length_mm = 614", "length_mm = 640");
    let said = disagrees(cell.armill(&check("arm.toml", &[])));
    assert!(
        said.out.contains("no combination of signs, zeros, coupling"),
        "{}",
        said.out
    );
}

#[test]
fn one_reading_at_zero_is_reported_as_insufficient() {
    let arguments = [
        "robots",
        "check",
        "yaskawa/mh12",
        "--convention",
        "yaskawa",
        "--pose",
    ];
    // At zero the flange looks forward: tool z along base x.
    let pose = "0,0,0,0,0,0 = 895,0,1264,180,-90,0";
    let said = Cell::new().armill(&[&arguments[..], &[pose]].concat()).fine();
    assert!(
        said.out.contains("These readings do not show whether")
            && said.out.contains("joint L has the opposite sign"),
        "{}",
        said.out
    );
}

#[test]
fn refuses_an_invalid_reading() {
    let cell = Cell::new();
    let said = |convention: &str, pose: &str| {
        cell.armill(&[
            "robots",
            "check",
            "yaskawa/mh12",
            "--convention",
            convention,
            "--pose",
            pose,
        ])
    };
    said("yaskawa", "0,0,0").refused(&["no `=`", "X,Y,Z,Rx,Ry,Rz"]);
    said("abb", "0,0,0,0,0,0 = 1,2,3,4,5,6").refused(&["6 numbers of the pose, where abb has 7"]);
    said("abb", "0,0,0,0,0,0 = 1,2,3,1,1,0,0").refused(&["length 1.4142"]);
    said("kuka", "0,0 = 1,2,3,4,5,6").refused(&["2 joint positions for the 6 joints"]);
    said("comau", "0,0 = 1,2,3,4,5,6").refused(&["`comau`", "kuka, abb, fanuc, yaskawa, staubli, ur"]);
    cell.armill(&check("yaskawa/mh12", &["--within-mm", "0"]))
        .refused(&["--within-mm: 0 is not above 0"]);
    cell.armill(&check("yaskawa/mh12", &["--base", "table"]))
        .refused(&["`table`", "controller"]);
}
