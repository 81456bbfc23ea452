use super::*;
use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::UnitQuaternion;
use armill_core::robot::inverse::posture_at;

fn urdf(joints: &str) -> String {
    let links = ["base_link", "a", "b", "tool0", "piston"]
        .map(|name| format!("<link name=\"{name}\"/>"))
        .concat();
    format!("<robot name=\"small\">{links}{joints}</robot>")
}

fn joint(name: &str, kind: &str, parent: &str, child: &str, inner: &str) -> String {
    format!(
        "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>{inner}</joint>\n"
    )
}

fn sound() -> String {
    let limit = "<limit lower=\"-1\" upper=\"2\" effort=\"0\" velocity=\"0\"/>";
    let origin = "<origin xyz=\"0 0 0.4\" rpy=\"0 0 0\"/><axis xyz=\"0 0 -1\"/>";
    [
        joint("j1", "revolute", "base_link", "a", &format!("{origin}{limit}")),
        joint(
            "j2",
            "revolute",
            "a",
            "b",
            &format!("<origin xyz=\"0.3 0 0\" rpy=\"0.1 0.2 0.3\"/><axis xyz=\"0.6 0 0.8\"/>{limit}"),
        ),
        joint(
            "flange",
            "fixed",
            "b",
            "tool0",
            "<origin xyz=\"0.1 0 0\" rpy=\"0 1.57 0\"/>",
        ),
        joint(
            "j2p",
            "revolute",
            "a",
            "piston",
            &format!("<axis xyz=\"0 1 0\"/>{limit}<mimic joint=\"j2\" multiplier=\"-0.25\"/>"),
        ),
    ]
    .concat()
}

#[test]
fn an_oblique_axis_turns_as_specified_in_the_file() {
    let robot = read("s.urdf", "s", &urdf(&sound())).unwrap().robot;
    let q = [0.4, -0.7];
    let reached = posture_at(&robot, &q, &Isometry::identity()).base_from_tool;
    let origin = from_xyz_and_fixed_angles;
    let turn = |axis: Vector3<f64>, angle: f64| {
        Isometry::from_parts(Default::default(), UnitQuaternion::new(axis.normalize() * angle))
    };
    let expected = origin(Vector3::new(0.0, 0.0, 0.4), Vector3::zeros())
        * turn(Vector3::new(0.0, 0.0, -1.0), q[0])
        * origin(Vector3::new(0.3, 0.0, 0.0), Vector3::new(0.1, 0.2, 0.3))
        * turn(Vector3::new(0.6, 0.0, 0.8), q[1])
        * origin(Vector3::new(0.1, 0.0, 0.0), Vector3::new(0.0, 1.57, 0.0));
    assert!((reached.to_homogeneous() - expected.to_homogeneous()).norm() < 1e-14);
}

#[test]
fn an_axis_within_the_digits_of_a_file_is_a_coordinate_axis_and_any_other_keeps_its_tilt() {
    let read = |axis: &str| {
        let text = urdf(&sound()).replace("<axis xyz=\"0 0 -1\"/>", &format!("<axis xyz=\"{axis}\"/>"));
        read("s.urdf", "s", &text).unwrap()
    };
    let given = |found: &RobotDescription| {
        let remark = "axes within 1e-6 of a coordinate axis are taken as that axis: j1";
        found.remarks.iter().any(|given| given == remark)
    };
    let near = read("0.0000005 0 -1");
    assert!(given(&near), "{:?}", near.remarks);
    assert_eq!(near.robot.joints()[0].sign, Sign::Negative);
    let exact = read("0 0 -3");
    assert!(!given(&exact) && exact.robot.chain().motions() == near.robot.chain().motions());
    // 40 um in a metre: no rounding, and kept.
    let tilted = read("0.00004 0 1");
    assert!(!given(&tilted));
    let turned = posture_at(&tilted.robot, &[1.0, 0.0], &Isometry::identity()).base_from_tool;
    let axis = Vector3::new(4e-5, 0.0, 1.0).normalize();
    let start = posture_at(&tilted.robot, &[0.0, 0.0], &Isometry::identity()).base_from_tool;
    let turn = turned.rotation * start.rotation.inverse();
    assert!((turn.scaled_axis() - axis).norm() < 1e-14, "{turn}");
}

#[test]
fn limits_are_read_as_urdf_means_them_and_what_is_no_range_is_reported() {
    let inner = "lower=\"-1\" upper=\"2\"";
    for (to, limits, given) in [
        (inner, Some((-1.0, 2.0)), false),
        ("upper=\"2\"", Some((0.0, 2.0)), false),
        ("lower=\"0\" upper=\"0\"", None, false),
        ("", None, false),
        ("lower=\"-inf\" upper=\"inf\"", None, false),
        ("lower=\"-1e16\" upper=\"1e16\"", None, false),
        ("lower=\"2\" upper=\"-1\"", None, true),
        ("lower=\"-1\" upper=\"inf\"", None, true),
    ] {
        let found = read("s.urdf", "s", &urdf(&sound()).replacen(inner, to, 1)).unwrap();
        let joint = &found.robot.joints()[0];
        assert_eq!(joint.limits.map(|l| (l.lower, l.upper)), limits, "{to}");
        let remark = found
            .remarks
            .contains(&"limits without a valid range are left out: j1".to_owned());
        assert_eq!(remark, given, "{to}: {:?}", found.remarks);
    }
}

#[test]
fn side_branches_that_mimic_are_left_out_and_zero_speed_means_unknown() {
    let robot = read("s.urdf", "s", &urdf(&sound())).unwrap().robot;
    let names: Vec<_> = robot.joints().iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["j1", "j2"]);
    assert_eq!(robot.joints()[0].max_speed, None);
    assert_eq!(robot.joints()[0].sign, Sign::Negative);
}

#[test]
fn an_axis_of_length_zero_is_named_with_its_line() {
    let broken = sound().replace("<axis xyz=\"0.6 0 0.8\"/>", "<axis xyz=\"0 0 0\"/>");
    let text = read("s.urdf", "s", &urdf(&broken)).unwrap_err().to_string();
    assert!(
        text.contains("s.urdf:2:") && text.contains("`j2` has an axis of length zero"),
        "{text}"
    );
}

#[test]
fn a_loop_of_joints_is_refused() {
    let looped = format!("{}{}", sound(), joint("back", "fixed", "tool0", "a", ""));
    let text = read("s.urdf", "s", &urdf(&looped)).unwrap_err().to_string();
    assert!(
        text.contains("s.urdf:5:") && text.contains("link `a` is the child of 2 joints, `j1` and `back`"),
        "{text}"
    );
}

#[test]
fn a_joint_to_a_link_that_is_not_there_is_refused() {
    let broken = sound().replace("<child link=\"b\"/>", "<child link=\"c\"/>");
    let text = read("s.urdf", "s", &urdf(&broken)).unwrap_err().to_string();
    assert!(text.contains("`j2` names link `c`"), "{text}");
}

#[test]
fn a_floating_joint_is_refused() {
    let floating = sound().replacen("revolute", "floating", 1);
    let text = read("s.urdf", "s", &urdf(&floating)).unwrap_err().to_string();
    assert!(text.contains("type `floating`"), "{text}");
}

#[test]
fn refuses_files_that_are_not_urdf_in_one_line() {
    for text in ["", "<robot", "<robot name=\"x\"/>", "{}"] {
        assert!(read("s.urdf", "s", text).is_err(), "`{text}` was read");
    }
}

#[test]
fn joints_in_a_circle_are_named() {
    let circle = format!(
        "{}{}",
        joint("one", "fixed", "piston", "b", ""),
        joint("two", "fixed", "b", "piston", "")
    );
    let text = read(
        "s.urdf",
        "s",
        &urdf(&format!("{}{circle}", joint("j", "fixed", "base_link", "a", ""))),
    )
    .unwrap_err()
    .to_string();
    assert!(
        text.contains("2 links have no parent") && text.contains("base_link, tool0"),
        "{text}"
    );
    let whole = "<robot><link name=\"a\"/><link name=\"b\"/>".to_owned()
        + &joint("one", "fixed", "a", "b", "")
        + &joint("two", "fixed", "b", "a", "")
        + "</robot>";
    let text = read("s.urdf", "s", &whole).unwrap_err().to_string();
    assert!(text.contains("the joints form a loop"), "{text}");
    let two_more = urdf(&sound()).replace("</robot>", "<link name=\"x\"/><link name=\"y\"/>")
        + &joint("one", "fixed", "x", "y", "")
        + &joint("two", "fixed", "y", "x", "")
        + "</robot>";
    let text = read("s.urdf", "s", &two_more).unwrap_err().to_string();
    assert!(text.contains("form a loop: x, y"), "{text}");
}

#[test]
fn the_chain_ends_at_the_tip_that_is_requested() {
    let found = read_to_tip("s.urdf", "s", &urdf(&sound()), Some("a")).unwrap();
    assert_eq!(found.robot.joints().len(), 1);
    assert!(
        found
            .remarks
            .iter()
            .any(|remark| remark.contains("flange link `a`")),
        "{:?}",
        found.remarks
    );
    assert!(
        found.remarks.iter().any(|remark| remark.contains("left out: ")),
        "{:?}",
        found.remarks
    );
    let text = read_to_tip("s.urdf", "s", &urdf(&sound()), Some("tool1"))
        .unwrap_err()
        .to_string();
    assert!(
        text.contains("link `tool1` is not in the file") && text.contains("base_link, a, b, tool0, piston"),
        "{text}"
    );
    let text = read_to_tip("s.urdf", "s", &urdf(&sound()), Some("piston"))
        .unwrap_err()
        .to_string();
    assert!(text.contains("`j2p` on the way to the tip mimics `j2`"), "{text}");
}

#[test]
fn invalid_numbers_are_reported_with_their_place() {
    for (from, to, words) in [
        (
            "xyz=\"0 0 0.4\"",
            "xyz=\"0 0 0,4\"",
            "`0,4` in xyz=\"0 0 0,4\" is not a number",
        ),
        ("xyz=\"0 0 0.4\"", "xyz=\"0 0.4\"", "2 numbers: 3 required"),
        ("xyz=\"0 0 0.4\"", "xyz=\"0 0 nan\"", "`nan` in"),
        (
            "xyz=\"0 0 0.4\"",
            "xyz=\"0 0 4000\"",
            "lengths of a URDF are in m",
        ),
        (
            "xyz=\"0 0 0.4\"",
            "xyz=\"0 0 ${h}\"",
            "save the file with the ending .xacro",
        ),
        (
            "xyz=\"0 0 -1\"",
            "xyz=\"1e200 0 0\"",
            "1e200 in an axis is beyond 1e6",
        ),
        ("lower=\"-1\"", "lower=\"low\"", "`low` in lower"),
        (
            "rpy=\"0 1.57 0\"",
            "rpy=\"0 90 0\"",
            "angles of a URDF are in rad",
        ),
        ("<parent link=\"a\"/>", "", "joint `j2` has no <parent"),
        ("type=\"fixed\"", "", "<joint> has no attribute `type`"),
    ] {
        let text = read("s.urdf", "s", &urdf(&sound().replace(from, to)))
            .unwrap_err()
            .to_string();
        assert!(
            text.contains(words) && text.contains("s.urdf:"),
            "no `{words}` in {text}"
        );
    }
}

#[test]
fn broken_xml_is_reported_where_it_breaks() {
    let text = read("s.urdf", "s", "<robot>\n<link name=\"a\">\n</robot>\n")
        .unwrap_err()
        .to_string();
    assert!(
        text.contains("s.urdf:3:") && text.contains("not XML: expected 'link' tag"),
        "{text}"
    );
}

#[test]
fn the_link_base_is_the_frame_of_the_controller() {
    let with_base = urdf(&sound()).replace("</robot>", "<link name=\"base\"/>")
        + &joint(
            "b",
            "fixed",
            "base_link",
            "base",
            "<origin xyz=\"0 0 0.45\" rpy=\"0 0 0.3\"/>",
        )
        + "</robot>";
    let robot = read("s.urdf", "s", &with_base).unwrap().robot;
    let frame = &robot.frames()[0];
    assert_eq!(frame.name, "controller");
    assert_eq!(frame.base_from_frame.translation.vector.z, 0.45);
    assert!((frame.base_from_frame.rotation.angle() - 0.3).abs() < 1e-15);
}

#[test]
fn more_joints_and_attributes_than_any_arm_has_are_refused() {
    let chain = |count: usize, kind: &str| {
        let joints = (0..count).map(|index| {
            format!(
                "<joint name=\"j{index}\" type=\"{kind}\"><parent link=\"l{index}\"/><child link=\"l{}\"/></joint>",
                index + 1
            )
        });
        let links = (0..=count).map(|index| format!("<link name=\"l{index}\"/>"));
        format!(
            "<robot name=\"r\">{}{}</robot>",
            links.collect::<String>(),
            joints.collect::<String>()
        )
    };
    let refusal = |text: &str| read("r.urdf", "r", text).unwrap_err().to_string();
    assert!(read("r.urdf", "r", &chain(64, "continuous")).is_ok());
    assert!(refusal(&chain(65, "continuous")).contains("more than 64 joints move"));
    assert!(refusal(&chain(257, "fixed")).contains("more than 256 joints, fixed ones included"));
    assert!(refusal(&chain(10_001, "fixed")).contains("more than 10000 joints"));
    let attributes: String = (0..201).map(|index| format!(" a{index}=\"1\"")).collect();
    let text = refusal(&format!("<robot{attributes}/>"));
    assert!(text.contains("more than 200 attributes"), "{text}");
    // Text in a comment is not an attribute.
    let comment = format!("<robot name=\"r\"><!--{}-->", "''".repeat(300));
    assert!(
        read(
            "r.urdf",
            "r",
            &chain(2, "continuous").replace("<robot name=\"r\">", &comment)
        )
        .is_ok()
    );
}
