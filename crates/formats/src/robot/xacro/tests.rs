use std::fs;

use super::*;

/// A robot macro with what xacro files of ROS-Industrial use: properties, expressions, colours, meshes.
const MACRO: &str = r#"<?xml version="1.0"?>
<robot xmlns:xacro="http://wiki.ros.org/xacro">
  <xacro:include filename="$(find maker_resources)/urdf/common_materials.xacro"/>
  <xacro:property name="h" value="0.45"/>
  <xacro:macro name="maker_arm" params="prefix">
    <link name="${prefix}base_link">
      <visual><geometry><mesh filename="package://maker/meshes/base.stl"/></geometry>
        <xacro:material_maker_orange/></visual>
      <inertial><mass value="${unknown_mass}"/></inertial>
    </link>
    <link name="${prefix}link_1"/>
    <link name="${prefix}tool0"/>
    <joint name="${prefix}joint_1" type="revolute">
      <origin xyz="0 0 ${h + 0.1 * cos(radians(60))}" rpy="0 ${-pi/2.0} 0"/>
      <parent link="${prefix}base_link"/>
      <child link="${prefix}link_1"/>
      <axis xyz="0 0 -1"/>
      <limit lower="${-radians(170)}" upper="${radians(170)}" effort="0" velocity="${radians(220)}"/>
    </joint>
    <joint name="${prefix}flange" type="fixed">
      <origin xyz="0.1 0 0"/>
      <parent link="${prefix}link_1"/>
      <child link="${prefix}tool0"/>
    </joint>
  </xacro:macro>
</robot>
"#;

fn refusal(text: &str) -> String {
    read("/nowhere/arm.xacro", "arm", text).unwrap_err().to_string()
}

#[test]
fn one_macro_becomes_the_robot_with_an_empty_prefix() {
    let found = read("/nowhere/arm.xacro", "arm", MACRO).unwrap();
    let joint = &found.robot.joints()[0];
    assert_eq!(joint.name, "joint_1");
    let limits = joint.limits.unwrap();
    assert!((limits.upper - 170_f64.to_radians()).abs() < 1e-12);
    let at = found.robot.chain().base_from_flange(&[0.0]).translation.vector;
    // 0.45 + 0.05 high; x of the link points up after the turn by -90 deg about y.
    assert!((at.z - 0.6).abs() < 1e-12, "{at}");
    assert!(
        found
            .remarks
            .iter()
            .any(|remark| remark.contains("common_materials.xacro was not found")),
        "{:?}",
        found.remarks
    );
    assert_eq!(found.sources[0].place, "/nowhere/arm.xacro");
}

#[test]
fn files_are_found_beside_and_in_the_packages_around() {
    let folder = tempfile::tempdir().unwrap();
    let urdf = folder.path().join("maker_support/urdf");
    let other = folder.path().join("maker_constants/urdf");
    fs::create_dir_all(&urdf).unwrap();
    fs::create_dir_all(&other).unwrap();
    let constants = "<robot xmlns:xacro=\"http://ros.org/wiki/xacro\"><xacro:property name=\"h\" value=\"0.45\"/></robot>";
    fs::write(other.join("numbers.xacro"), constants).unwrap();
    fs::write(
        urdf.join("arm_macro.xacro"),
        MACRO.replace(
            "<xacro:property name=\"h\" value=\"0.45\"/>",
            "<xacro:include filename=\"$(find maker_constants)/urdf/numbers.xacro\"/>",
        ),
    )
    .unwrap();
    let text = r#"<robot name="arm" xmlns:xacro="http://ros.org/wiki/xacro">
        <xacro:include filename="$(find maker_support)/urdf/arm_macro.xacro"/>
        <xacro:maker_arm prefix="left_"/></robot>"#;
    for place in [
        urdf.join("arm.xacro"),
        folder.path().join("maker_support/robots/arm.xacro"),
    ] {
        let found = read_to_tip(&place, "arm", text, None).unwrap();
        assert_eq!(found.robot.joints()[0].name, "left_joint_1");
        assert_eq!(found.title, "arm");
    }
    // Far from it all.
    let text = read("/nowhere/arm.xacro", "arm", text).unwrap_err().to_string();
    assert!(
        text.contains("arm.xacro:2:34: cannot find the included file")
            && text.contains("/nowhere/arm_macro.xacro"),
        "{text}"
    );
}

#[test]
fn what_cannot_be_worked_out_is_told_where_it_stands() {
    for (from, to, words) in [
        (
            "${h + 0.1",
            "${height + 0.1",
            "arm.xacro:14:26: cannot expand the xacro: Failed to evaluate",
        ),
        ("${h + 0.1", "${height + 0.1", "height"),
        ("${-pi/2.0}", "${-pi/}", "-pi/"),
        (
            "${radians(220)}",
            "${load_yaml('speeds.yaml')['s']}",
            "speeds.yaml",
        ),
        ("${radians(220)}", "$(env SPEED)", "env"),
        (
            "<axis xyz=\"0 0 -1\"/>",
            "<xacro:axis_of_maker/>",
            "arm.xacro:17:14: no macro is called `axis_of_maker`",
        ),
    ] {
        let text = refusal(&MACRO.replace(from, to));
        assert!(text.contains(words), "no `{words}` in {text}");
    }
}

#[test]
fn files_without_robot_or_with_several_are_told() {
    let colours = "<robot xmlns:xacro=\"http://ros.org/wiki/xacro\"><xacro:property name=\"red\" value=\"1 0 0 1\"/>\
         <xacro:macro name=\"material_red\"><material name=\"\"><color rgba=\"${red}\"/></material></xacro:macro></robot>";
    let text = refusal(colours);
    assert!(
        text.contains("makes no robot") && text.contains("colours"),
        "{text}"
    );
    let second = MACRO.replace(
        "</robot>",
        "<xacro:macro name=\"other_arm\" params=\"prefix\"><joint/></xacro:macro></robot>",
    );
    let text = refusal(&second);
    assert!(
        text.contains("several robot macros") && text.contains("maker_arm, other_arm"),
        "{text}"
    );
    let text = refusal(&MACRO.replace("params=\"prefix\"", "params=\"prefix speeds parent:=world\""));
    assert!(
        text.contains("arm.xacro:5:22: macro `maker_arm` wants values for speeds"),
        "{text}"
    );
}

#[test]
fn circles_and_depths_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.xacro");
    let text = MACRO.replace("$(find maker_resources)/urdf/common_materials.xacro", "arm.xacro");
    fs::write(&path, &text).unwrap();
    let text = read_to_tip(&path, "arm", &text, None).unwrap_err().to_string();
    assert!(text.contains("includes itself"), "{text}");
    let deep = MACRO.replace(
        "${h + 0.1",
        &format!("${{{}1{} + 0.1", "(".repeat(500), ")".repeat(500)),
    );
    assert!(refusal(&deep).contains("brackets go deeper than 40"));
    let endless = MACRO.replace(
        "<link name=\"${prefix}tool0\"/>",
        "<xacro:maker_arm prefix=\"x\"/>",
    );
    assert!(refusal(&endless).contains("recursion"), "{}", refusal(&endless));
    let circle = MACRO.replace("value=\"0.45\"", "value=\"${h}\"");
    assert!(refusal(&circle).contains('h'));
}

#[test]
fn a_tip_that_is_not_there_lists_the_links() {
    let text = read_to_tip(Path::new("/nowhere/arm.xacro"), "arm", MACRO, Some("gripper"))
        .unwrap_err()
        .to_string();
    assert!(
        text.contains("`gripper`") && text.contains("base_link, link_1, tool0"),
        "{text}"
    );
}
