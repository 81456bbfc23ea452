//! `armill robots import`, and files of other formats wherever a robot is named.

use crate::cell::{Cell, MH12_URDF, numbers};

const CHAIN: &str =
    "Tz(450) Rz(S) Tx(155) Ry(L) Tz(614) Ry(-U) Tz(200) Rx(-R) Tx(640) Ry(-B) Rx(-T) Tx(100) Ry(-90) Rx(180)";

#[test]
fn an_imported_urdf_poses_as_the_urdf_does() {
    let cell = Cell::new();
    cell.file("arm.urdf", MH12_URDF);
    let said = cell
        .armill(&["robots", "import", "arm.urdf", "--out", "arm.toml"])
        .fine();
    assert!(
        said.err.contains("created arm.toml") && said.err.contains("6 joints; inverse: closed form"),
        "{}",
        said.err
    );
    let tcp = |file: &str| {
        let flags = ["--joints-deg", "10,20,-30,40,50,60", "--json"];
        let said = cell.armill(&[&["pose", file], &flags[..]].concat()).fine().json();
        numbers(&said["postures"][0]["tool"]["xyz_mm"])
    };
    // 1e-12 m is promised.
    for (theirs, ours) in tcp("arm.urdf").into_iter().zip(tcp("arm.toml")) {
        assert!((theirs - ours).abs() < 1e-9, "{theirs} mm and {ours} mm");
    }
}

#[test]
fn a_robot_of_the_library_is_copied_with_its_comments_and_compliances() {
    let cell = Cell::new();
    let said = cell
        .armill(&["robots", "import", "yaskawa/mh12", "--out", "mine.toml"])
        .fine();
    assert!(
        said.err.contains("created mine.toml") && !said.err.contains("missing"),
        "{}",
        said.err
    );
    let copy = std::fs::read(cell.at("mine.toml")).unwrap();
    assert!(copy == include_bytes!("../../../../robots/yaskawa/mh12.toml"));
    let answer = |robot: &str| {
        let flags = [
            "--joints-deg",
            "10,20,-30,40,50,60",
            "--wrench-n",
            "3,5,5",
            "--json",
        ];
        let mut answer = cell
            .armill(&[&["pose", robot], &flags[..]].concat())
            .fine()
            .json();
        answer["postures"].take()
    };
    assert_eq!(answer("mine.toml"), answer("yaskawa/mh12"));
    // A file of that name is what is meant, where there is one.
    cell.file("yaskawa/mh12", "no robot");
    cell.armill(&["robots", "import", "yaskawa/mh12"])
        .refused(&["yaskawa/mh12"]);
}

#[test]
fn a_file_that_is_there_is_overwritten_by_force_only() {
    let cell = Cell::new();
    cell.file("arm.chain", CHAIN);
    cell.file("arm.toml", "mine");
    let import = ["robots", "import", "arm.chain", "--out", "arm.toml"];
    cell.armill(&import).refused(&["arm.toml", "--force"]);
    assert_eq!(std::fs::read(cell.at("arm.toml")).unwrap(), b"mine");
    cell.armill(&[&import[..], &["--force"]].concat()).fine();
    cell.armill(&["robots", "arm.toml"]).fine();
}

#[test]
fn without_out_the_file_is_printed() {
    let cell = Cell::new();
    cell.file("arm.chain", CHAIN);
    let said = cell.armill(&["robots", "import", "arm.chain"]).fine();
    assert!(
        said.out.contains("[chain]") && said.out.contains("# - the joints' compliances"),
        "{}",
        said.out
    );
    let said = cell
        .armill(&["robots", "import", "arm.chain", "--json"])
        .fine()
        .json();
    assert!(said["text"].as_str().unwrap().contains("format = 1"));
    assert_eq!(said["joints"][0], "S");
    assert_eq!(said["inverse"], "closed_form");
}

#[test]
fn refuses_what_cannot_be_imported_and_writes_nothing() {
    let cell = Cell::new();
    cell.file("arm.urdf", MH12_URDF);
    cell.file("arm.step", "ISO-10303-21;");
    cell.file("table.csv", "a_mm, alpha_deg, d_mm, theta_deg\n1, 2, 3, 4\n");
    for (arguments, words) in [
        (["arm.urdf", "--tip", "gripper"], "`gripper`"),
        (["arm.urdf", "--format", "chain"], "defines nothing"),
        (["arm.step", "--tip", "x"], "is not an ending of robot files"),
        (["table.csv", "--format", "dh"], "convention = standard"),
        (["gone.urdf", "--tip", "x"], "cannot read robot file gone.urdf"),
        (["arm.toml", "--format", "armill"], "already"),
    ] {
        cell.armill(&[&["robots", "import", "--out", "made.toml"], &arguments[..]].concat())
            .refused(&[words]);
        assert!(!cell.at("made.toml").exists());
    }
    cell.armill(&["robots", "import", "arm.urdf", "--format", "step"])
        .refused(&["urdf, xacro, opw, ur, dh, chain"]);
}

#[test]
fn every_format_is_a_robot_wherever_one_is_named() {
    let cell = Cell::new();
    cell.file("arm.fsf", CHAIN);
    cell.armill(&["new", "cell", "--robot", "arm.fsf"]).fine();
    cell.armill(&["check", "cell"]).fine();
    let said = cell.armill(&["robots", "arm.fsf"]).fine();
    assert!(
        said.out.contains("Assumed: lengths are taken as mm"),
        "{}",
        said.out
    );
}
