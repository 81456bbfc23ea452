use std::f64::consts::FRAC_PI_2;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Quaternion, Translation3, UnitQuaternion, Vector3};
use armill_core::robot::inverse::posture_at;

use super::*;

/// Yaskawa MH12, lengths of ros-industrial/motoman (Apache-2.0), typed.
const MH12: &str = "\
# a comment
opw_kinematics_geometric_parameters:
  a1: 0.155
  a2: -0.200
  b: 0.000
  c1: 0.450   # floor to axis 2
  c2: 0.614
  c3: 0.640
  c4: 0.100
opw_kinematics_joint_offsets: [0.0, 0.0, deg(-90.0), 0.0, 0.0, deg(180.0)]
opw_kinematics_joint_sign_corrections: [1, 1, -1, -1, -1, -1]
";

fn refusal(text: &str) -> String {
    read("a.yaml", "a", text).unwrap_err().to_string()
}

#[test]
fn the_flange_at_zero_matches_the_pose_of_the_manufacturer() {
    let robot = read("a.yaml", "a", MH12).unwrap().robot;
    let flange = posture_at(&robot, &[0.0; 6], &Isometry::identity()).base_from_tool;
    let expected = Vector3::new(0.895, 0.0, 1.264);
    assert!((flange.translation.vector - expected).norm() < 1e-15, "{flange}");
    assert!(robot.ortho_parallel().is_some());
}

#[test]
fn forward_kinematics_is_that_of_another_opw_solver() {
    use rs_opw_kinematics::kinematic_traits::Kinematics;
    use rs_opw_kinematics::kinematics_impl::OPWKinematics;
    use rs_opw_kinematics::parameters::opw_kinematics::Parameters;
    let text = MH12.replace("b: 0.000", "b: 0.05");
    let robot = read("a.yaml", "a", &text).unwrap().robot;
    let other = OPWKinematics::new(Parameters {
        a1: 0.155,
        a2: -0.200,
        b: 0.05,
        c1: 0.450,
        c2: 0.614,
        c3: 0.640,
        c4: 0.100,
        offsets: [0.0, 0.0, -FRAC_PI_2, 0.0, 0.0, 2.0 * FRAC_PI_2],
        sign_corrections: [1, 1, -1, -1, -1, -1],
        dof: 6,
    });
    // A walk over the joints with steps that never meet: no seed needed.
    for step in 0..200 {
        let q: [f64; 6] = std::array::from_fn(|i| (f64::from(step) * (0.37 + 0.11 * i as f64)).sin() * 3.0);
        let ours = posture_at(&robot, &q, &Isometry::identity())
            .base_from_tool
            .to_homogeneous();
        let theirs = other.forward(&q);
        let [i, j, k, w] = theirs.rotation.to_array();
        let turn = UnitQuaternion::new_normalize(Quaternion::new(w, i, j, k));
        let expected = Isometry::from_parts(Translation3::from(theirs.translation.to_array()), turn);
        let worst = (ours - expected.to_homogeneous()).norm();
        assert!(worst < 1e-13, "{worst} at {q:?}");
    }
}

#[test]
fn lists_may_be_on_separate_lines_and_under_other_keys() {
    let nested = MH12
        .replace(
            "[1, 1, -1, -1, -1, -1]",
            "\n  - 1\n  - 1\n  - -1\n  - -1\n  - -1\n  - -1",
        )
        .replace("[0.0, 0.0, deg(-90.0),", "[0.0, 0.0,\n    deg( -90.0 ),");
    let nested = format!("robot:\n  solver: opw\n{}", nested.replace('\n', "\r\n"));
    let (a, b) = (
        read("a", "a", MH12).unwrap().robot,
        read("a", "a", &nested).unwrap().robot,
    );
    assert_eq!(a.chain().motions(), b.chain().motions());
    assert_eq!(a.joints(), b.joints());
}

#[test]
fn every_problem_is_reported_at_its_place() {
    let broken = MH12
        .replace("a1: 0.155", "a1: 155.0")
        .replace("c2: 0.614", "c2: 0,614")
        .replace("c4: 0.100", "c4: far")
        .replace("deg(-90.0)", "-90")
        .replace("[1, 1, -1,", "[1, 2, -1,")
        .replace("deg(180.0)", "deg(half)");
    let text = refusal(&broken);
    for words in [
        "a.yaml:3:7: `155.0` of `a1` is not a length within 100 m",
        "a.yaml:7:3: `c2` has 2 values: 1 required",
        "a.yaml:9:7: `far` of `c4`",
        "a.yaml:10:42: `-90`",
        "is not 1 or -1",
        "`deg(half)`",
    ] {
        assert!(text.contains(words), "no `{words}` in\n{text}");
    }
}

#[test]
fn missing_and_double_keys_are_reported() {
    assert!(refusal(&MH12.replace("  b: 0.000\n", "")).contains("`b` is missing"));
    assert!(refusal(&format!("{MH12}a1: 0.2\n")).contains("a.yaml:12:1: `a1` is given twice"));
    assert!(refusal(&MH12.replace(", deg(180.0)]", "]")).contains("has 5 values: 6 required"));
}

#[test]
fn a_list_of_joint_names_is_no_arm() {
    let text = refusal("controller_joint_names: ['joint_1', 'joint_2']\n");
    assert!(
        text.contains("no OPW parameters") && text.contains("joint names"),
        "{text}"
    );
}
