use std::fs;

use armill_core::nalgebra::Vector3;

use super::*;
use crate::robot::format::{self, RobotReadOptions};

const ARM: &str = "format = 1\nname = \"arm\"\n[chain]\nsource = \"own\"\nmotions = [\n  { along = \"x\", joint = \"rail\" },\n  { about = \"z\", joint = \"A1\" },\n  \
    { along = \"x\", length_mm = 500 },\n]\n[[joint]]\nname = \"rail\"\nsign = 1\nsource = \"own\"\n[[joint]]\nname = \"A1\"\nsign = 1\nsource = \"own\"\n\
    [sources.own]\nwhat = \"a\"\nwhere = \"b\"\nlicence = \"c\"\n";

fn robot() -> Robot {
    super::super::read("arm.toml", "arm", ARM).unwrap().robot
}

fn residuals() -> Vec<ResidualAt> {
    (0..10)
        .map(|k| {
            let k = f64::from(k);
            ResidualAt {
                joints: vec![0.1 * k, (1.3 * k).sin()],
                residual: Vector3::new((1.3 * k).sin(), k.cos(), 0.2) * 1e-4,
            }
        })
        .collect()
}

fn settings() -> LearntSettings {
    LearntSettings {
        lengths: vec![0.8, 1.5],
        noise: 0.3,
        axes: LearntAxes::FirstJoint,
    }
}

/// A folder with the robot file and its residuals.
fn folder() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let robot = robot();
    let residuals = residuals_file(&robot, &residuals());
    let table = LearntTable::of(&robot, &settings(), "arm-residuals.csv", &residuals);
    let text = with_residual("arm.toml", ARM, &table, ["10 poses", "poses.csv"]).unwrap();
    fs::write(folder.path().join("arm-residuals.csv"), &residuals).unwrap();
    fs::write(folder.path().join("arm.toml"), &text).unwrap();
    (folder, text)
}

fn read(folder: &tempfile::TempDir) -> Result<RobotDescription, Problems> {
    let path = folder.path().join("arm.toml");
    let bytes = fs::read(&path).unwrap();
    format::read(&path, "arm", &bytes, &RobotReadOptions::default())
}

#[test]
fn what_was_learnt_is_read_back() {
    let (folder, _) = folder();
    let found = read(&folder).unwrap();
    let learnt = found.robot.structure().learnt.clone().unwrap();
    let expected = Learnt::new(&robot(), &residuals(), settings()).unwrap();
    let q = [0.33, 0.4];
    // Residuals are written to the nanometre, length scales to six digits.
    assert!((learnt.mean(&q) - expected.mean(&q)).norm() < 2e-9);
    let u = |learnt: &Learnt| learnt.at(&q).uncertainty[1].norm();
    assert!((u(&learnt) / u(&expected) - 1.0).abs() < 1e-4);
    assert!(
        found
            .sources
            .iter()
            .any(|source| source.key == "learnt" && source.what == "10 poses")
    );
}

#[test]
fn a_file_that_is_missing_changed_or_elsewhere_is_refused() {
    let (folder, text) = folder();
    let file = folder.path().join("arm-residuals.csv");
    let residuals = fs::read_to_string(&file).unwrap();
    fs::write(&file, residuals.replace("0.020000", "0.030000") + "\n").unwrap();
    let refused = read(&folder).unwrap_err().to_string();
    assert!(
        refused.contains("checksum") && refused.contains("arm.toml"),
        "{refused}"
    );
    fs::remove_file(&file).unwrap();
    let refused = read(&folder).unwrap_err().to_string();
    assert!(
        refused.contains("cannot read") && refused.contains("arm-residuals.csv"),
        "{refused}"
    );
    let above = text.replace("\"arm-residuals.csv\"", "\"../arm-residuals.csv\"");
    let short = above.replace("length_scales_deg = [", "length_scales_deg = [1.0, ");
    let refused = super::super::read("arm.toml", "arm", &short)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("3 length scales for 2 joints"), "{refused}");
    assert!(
        refused.contains("not the name of a file in the folder"),
        "{refused}"
    );
}

#[test]
fn residuals_of_another_robot_or_without_content_are_refused() {
    let (folder, text) = folder();
    let with = |residuals: &str| {
        let path = folder.path().join("arm-residuals.csv");
        fs::write(&path, residuals).unwrap();
        let sum = sum_of(residuals.as_bytes());
        let was = text
            .split("sha256 = \"")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap();
        fs::write(folder.path().join("arm.toml"), text.replace(was, &sum)).unwrap();
        read(&folder).unwrap_err().to_string()
    };
    let few = "q1_mm,q2_deg,residual_x_mm,residual_y_mm,residual_z_mm\n0,1,0.1,0.2,0.3\n";
    assert!(with(few).contains("1 poses"), "{}", with(few));
    let column = "q1_mm,residual_x_mm,residual_y_mm,residual_z_mm\n0,0.1,0.2,0.3\n";
    assert!(with(column).contains("A1"), "{}", with(column));
}

#[test]
fn a_second_residual_replaces_the_first() {
    let (_folder, text) = folder();
    let mut table = LearntTable::of(&robot(), &settings(), "other.csv", "");
    table.scatter = 0.7;
    let again = with_residual("arm.toml", &text, &table, ["12 poses", "b.csv"]).unwrap();
    assert_eq!(again.matches("[learnt]").count(), 1, "{again}");
    assert!(
        again.contains("scatter = 0.7") && !again.contains("10 poses"),
        "{again}"
    );
}
