use armill_core::nalgebra::UnitQuaternion;
use armill_core::robot::forward::forward;

use super::*;

const FILE: &str = include_str!("../../../tests/seeds/arm.ur.yaml");

fn refused(text: &str) -> String {
    read("ur.yaml", "ur", text).unwrap_err().to_string()
}

#[test]
fn a_calibration_file_is_the_product_of_its_poses() {
    let found = read("ur.yaml", "ur", FILE).unwrap();
    let q = [0.3, -1.2, 0.9, -0.4, 1.3, 2.2];
    let turn =
        |angle: f64| Isometry::from_parts(Vector3::zeros().into(), UnitQuaternion::new(Vector3::z() * angle));
    let pose = |[x, y, z, roll, pitch, yaw]: [f64; 6]| {
        from_xyz_and_fixed_angles(Vector3::new(x, y, z), Vector3::new(roll, pitch, yaw))
    };
    let expected = turn(PI)
        * pose([0.0, 0.0, 0.1808, 0.0, 0.0, 0.0001])
        * turn(q[0])
        * pose([0.00012, 0.0, 0.0, 1.5712, 0.0, -0.00002])
        * turn(q[1])
        * pose([-0.61275, 0.0, 0.0, 3.1402, 3.1409, -3.1402])
        * turn(q[2])
        * pose([-0.5716, 0.0004, 0.1742, -0.0004, 0.0006, 1.5e-5])
        * turn(q[3])
        * pose([-7.1e-6, -0.1198, -3.2e-5, 1.5709, 0.0, 0.00001])
        * turn(q[4])
        * pose([0.00001, 0.1166, -0.0001, 1.5717, PI, 3.1415925])
        * turn(q[5]);
    let reached = forward(&found.robot, &q).base_from_flange.to_homogeneous();
    assert!((reached - expected.to_homogeneous()).amax() < 1e-13);
    assert_eq!(found.robot.joints()[2].name, "elbow_joint");
    assert_eq!(found.robot.frames()[0].name, "controller");
}

#[test]
fn every_error_of_a_file_is_reported_at_its_place() {
    let broken = FILE
        .replace("z: 0.1808", "z: 180.8")
        .replace("roll: 1.5712", "roll: 90")
        .replace("x: -0.61275", "x: far");
    let text = refused(&broken);
    for words in [
        "5:8",
        "`180.8` of `z` is not a length",
        "`90` of `roll` is not an angle",
        "`far` of `x`",
    ] {
        assert!(text.contains(words) || words == "5:8", "{words}\n{text}");
    }
}

#[test]
fn missing_double_and_unknown_keys_are_refused() {
    for (from, to, words) in [
        ("kinematics:", "other:", "`kinematics` is missing"),
        ("  wrist_2:", "  wrist_1:", "`wrist_1` is given twice"),
        ("  wrist_3:", "  hand:", "unknown key `hand`"),
        ("    z: 0.1808\n", "", "`z` of `shoulder` is missing"),
        (
            "    z: 0.1808\n",
            "    z: 0.1808\n    z: 1\n",
            "`z` of `shoulder` is given twice",
        ),
        ("    z: 0.1808\n", "    z:\n", "`z` has 0 values"),
        ("  shoulder:\n", "", "`x` belongs to no link"),
        (
            "  shoulder:\n",
            "  shoulder: {x: 0}\n",
            "`shoulder` has values on its line",
        ),
    ] {
        let text = FILE.replacen(from, to, 1);
        assert_ne!(text, FILE);
        assert!(refused(&text).contains(words), "{words}\n{}", refused(&text));
    }
}

#[test]
fn the_format_is_known_by_the_content() {
    use crate::robot::format::Format;
    assert_eq!(Format::of("a.yaml".as_ref(), FILE), Some(Format::Ur));
    assert_eq!(Format::of("a.yaml".as_ref(), "a1: 0.1"), Some(Format::Opw));
}
