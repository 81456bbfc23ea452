//! `armill export`: files for other programs, read again, and what is refused.

use crate::cell::{Cell, LEVER, numbers};

/// Flange in mm of a robot in a posture.
fn flange(cell: &Cell, robot: &str, joints: &str) -> Vec<f64> {
    let answer = cell
        .armill(&["pose", robot, "--joints-deg", joints, "--json"])
        .fine()
        .json();
    numbers(&answer["postures"][0]["tool"]["xyz_mm"])
}

#[test]
fn a_robot_is_the_same_in_every_format_that_armill_reads() {
    let cell = Cell::new();
    let joints = "10,20,-30,40,50,60";
    for (robot, formats) in [
        ("yaskawa/mh12", &["arm.urdf", "arm.xacro", "arm.csv"][..]),
        ("universal-robots/ur10e", &["ur.urdf", "ur.dh"]),
    ] {
        let expected = flange(&cell, robot, joints);
        for file in formats {
            cell.armill(&["export", robot, "--out", file]).fine();
            for (own, read) in expected.iter().zip(flange(&cell, file, joints)) {
                assert!((own - read).abs() < 1e-9, "{file}: {own} mm and {read} mm");
            }
        }
    }
    // The base of a calibration file is turned by 180 deg.
    cell.armill(&["export", "universal-robots/ur10e", "--out", "ur.yaml"])
        .fine();
    let [expected, read] = ["universal-robots/ur10e", "ur.yaml"].map(|robot| flange(&cell, robot, joints));
    for (own, read) in expected.iter().zip([-read[0], -read[1], read[2]]) {
        assert!((own - read).abs() < 1e-9, "{own} mm and {read} mm");
    }
}

#[test]
fn a_prismatic_joint_is_written_in_every_format_that_has_one() {
    let cell = Cell::new();
    cell.file("lever.toml", LEVER);
    for file in ["lever.urdf", "lever.sdf", "lever.xml", "lever.csv"] {
        cell.armill(&["export", "lever.toml", "--out", file]).fine();
    }
    for file in ["lever.urdf", "lever.csv"] {
        for (own, read) in flange(&cell, "lever.toml", "30,120")
            .iter()
            .zip(flange(&cell, file, "30,120"))
        {
            assert!((own - read).abs() < 1e-9, "{file}: {own} mm and {read} mm");
        }
    }
    // 1 / 0.02 um/N, and 0.12 m.
    let springs = ["--stiffness", "joints", "--joints-deg", "30,120"];
    let said = cell
        .armill(&[&["export", "lever.toml", "--format", "mjcf"], &springs[..]].concat())
        .fine();
    assert!(
        said.out.contains("type=\"slide\"") && said.out.contains("stiffness=\"50000000\" springref=\"0.12\""),
        "{}",
        said.out
    );
}

#[test]
fn what_is_not_expressed_is_a_warning_and_in_the_file() {
    let cell = Cell::new();
    let said = cell
        .armill(&["export", "yaskawa/mh12", "--format", "urdf"])
        .fine();
    assert!(said.err.contains("warning: predictions of armill") && said.err.contains("joint compliances"));
    assert!(said.out.contains("Note: predictions of armill"), "{}", said.out);
    let assumed = ["--stiffness", "passive", "--compliance-class", "heavy"];
    let said = cell
        .armill(&[&["export", "kuka/kr120r2500pro", "--format", "sdf"], &assumed[..]].concat())
        .fine();
    assert!(said.err.contains("assumed, not measured") && said.out.contains("assumed, not measured"));
}

#[test]
fn refuses_what_cannot_be_written_and_writes_nothing() {
    let cell = Cell::new();
    cell.file("rail.chain", "Ty(q1) Tz(400) Rz(A)");
    for (arguments, words) in [
        (
            &["yaskawa/mh12", "--out", "made.step"][..],
            "is not one of a robot format",
        ),
        (
            &["yaskawa/mh12", "--out", "made.ur.yaml"],
            "cannot describe this robot: axes 2 and 3 turn in opposite directions",
        ),
        (&["fanuc/r2000ic", "--out", "made.urdf"], "--coupling own"),
        (
            &["fanuc/r2000ic", "--out", "made.xml", "--coupling", "mimic"],
            "MJCF has no joint that follows",
        ),
        (
            &["yaskawa/mh12", "--out", "made.urdf", "--stiffness", "passive"],
            "URDF cannot express stiffness",
        ),
        (
            &["yaskawa/mh12", "--out", "made.sdf", "--stiffness", "joints"],
            "--joints-deg",
        ),
        (
            &[
                "kuka/kr120r2500pro",
                "--out",
                "made.sdf",
                "--stiffness",
                "passive",
            ],
            "--compliance-class",
        ),
        (
            &["rail.chain", "--out", "made.urdf"],
            "prismatic joint q1 has no limits",
        ),
        (&["yaskawa/mh21", "--out", "made.urdf"], "`yaskawa/mh12`"),
    ] {
        cell.armill(&[&["export"], arguments].concat()).refused(&[words]);
        let made = std::fs::read_dir(cell.at(".")).unwrap();
        assert_eq!(made.count(), 1, "{arguments:?}");
    }
    cell.armill(&["export", "yaskawa/mh12", "--format", "xacro"])
        .refused(&["two files", "--out"]);
    cell.armill(&["export", "yaskawa/mh12"])
        .refused(&["format", "urdf, xacro, ur, dh, sdf, mjcf"]);
    let limits = ["--stiffness", "joints", "--joints-deg", "1,2", "--format", "sdf"];
    cell.armill(&[&["export", "yaskawa/mh12"], &limits[..]].concat())
        .refused(&["2 joint positions for 6 joints"]);
}

#[test]
fn both_files_of_a_xacro_are_written_or_none() {
    let cell = Cell::new();
    cell.file("arm_geometry.yaml", "mine");
    let export = ["export", "yaskawa/mh12", "--out", "arm.xacro"];
    cell.armill(&export).refused(&["arm_geometry.yaml", "--force"]);
    assert!(!cell.at("arm.xacro").exists());
    assert_eq!(std::fs::read(cell.at("arm_geometry.yaml")).unwrap(), b"mine");
    let answer = cell
        .armill(&[&export[..], &["--force", "--json"]].concat())
        .fine()
        .json();
    assert_eq!(
        answer["files"],
        serde_json::json!(["arm.xacro", "arm_geometry.yaml"])
    );
    assert!(answer["text"].is_null());
    let answer = cell
        .armill(&["export", "yaskawa/mh12", "--format", "xacro", "--json"])
        .fine()
        .json();
    assert!(answer["arguments"].as_str().unwrap().contains("joints:"));
    assert_eq!(answer["joints"][0], "S");
}

#[test]
fn an_exported_file_is_not_its_own_source() {
    let cell = Cell::new();
    cell.armill(&["export", "yaskawa/mh12", "--out", "arm.urdf"])
        .fine();
    cell.armill(&["export", "arm.urdf", "--out", "arm.urdf", "--force"])
        .refused(&["arm.urdf"]);
    cell.armill(&["export", "arm.urdf", "--out", "again.urdf"]).fine();
}
