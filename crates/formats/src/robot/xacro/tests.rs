use std::fs;
use std::path::PathBuf;

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

fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    read_to_tip(Path::new(path), id, text, None)
}

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
fn masses_of_links_are_read_and_left_out_with_a_remark_where_an_expression_fails() {
    let found = read("/nowhere/arm.xacro", "arm", MACRO).unwrap();
    assert!(found.robot.structure().masses.is_empty());
    let remark = |found: &RobotDescription| {
        found
            .remarks
            .iter()
            .any(|given| given.starts_with("masses of links are left out: "))
    };
    assert!(remark(&found), "{:?}", found.remarks);
    // Directly, by a macro with a name of masses, and inside a condition.
    let property = "<xacro:property name=\"unknown_mass\" value=\"4.5\"/><xacro:macro name=\"rod_inertia\" params=\"mass\">\
         <inertial><mass value=\"${mass}\"/><inertia ixx=\"${mass*0.1}\" iyy=\"${mass*0.1}\" izz=\"${mass*0.1}\"/></inertial></xacro:macro>";
    let text = MACRO
        .replace("<xacro:property name=\"h\"", &format!("{property}<xacro:property name=\"h\""))
        .replace(
            "<link name=\"${prefix}link_1\"/>",
            "<link name=\"${prefix}link_1\"><xacro:rod_inertia mass=\"${2*3}\"/></link>",
        )
        .replace(
            "<link name=\"${prefix}tool0\"/>",
            "<link name=\"${prefix}tool0\"><xacro:if value=\"${1 == 1}\"><inertial><mass value=\"2\"/></inertial></xacro:if></link>",
        );
    let found = read("/nowhere/arm.xacro", "arm", &text).unwrap();
    assert!(!remark(&found), "{:?}", found.remarks);
    let masses: Vec<f64> = found
        .robot
        .structure()
        .masses
        .iter()
        .map(|mass| mass.mass)
        .collect();
    assert_eq!(masses, [4.5, 6.0, 2.0]);
}

#[test]
fn meshes_are_kept_on_request_and_nothing_else_of_a_shape() {
    let path = Path::new("/nowhere/arm.xacro");
    let expanded = expand_with_meshes(path, MACRO).unwrap().urdf;
    let meshes = urdf::meshes::meshes("arm.xacro", &expanded).unwrap();
    assert_eq!(meshes.len(), 1);
    assert_eq!(
        (meshes[0].link.as_str(), meshes[0].file.as_str()),
        ("base_link", "package://maker/meshes/base.stl")
    );
    assert!(!expanded.contains("orange") && !expanded.contains("inertial"));
    assert!(!expand(path, MACRO).unwrap().urdf.contains("mesh"));
}

#[test]
fn files_are_found_next_to_it_and_in_the_packages_around() {
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
fn expressions_that_cannot_be_evaluated_are_reported_at_their_place() {
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
fn files_without_robot_or_with_several_are_reported() {
    let colours = "<robot xmlns:xacro=\"http://ros.org/wiki/xacro\"><xacro:property name=\"red\" value=\"1 0 0 1\"/>\
         <xacro:macro name=\"material_red\"><material name=\"\"><color rgba=\"${red}\"/></material></xacro:macro></robot>";
    let text = refusal(colours);
    assert!(
        text.contains("defines no robot") && text.contains("colours"),
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
        text.contains("arm.xacro:5:22: macro `maker_arm` requires values for speeds"),
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

/// A robot of one joint whose file also contains `more`.
fn with(more: &str) -> String {
    MACRO
        .replace(
            "</robot>",
            &format!("{more}<xacro:maker_arm prefix=\"\"/></robot>"),
        )
        .replace("http://wiki.ros.org/xacro", "http://ros.org/wiki/xacro")
}

#[test]
fn macros_that_double_at_every_level_are_refused_at_once() {
    let doubling: String = (1..45)
        .map(|level| {
            let below = level - 1;
            format!("<xacro:macro name=\"m{level}\"><xacro:m{below}/><xacro:m{below}/></xacro:macro>")
        })
        .collect();
    let bottom = "<xacro:macro name=\"m0\"><link name=\"x\"/></xacro:macro>";
    let text = refusal(&with(&format!("{bottom}{doubling}<xacro:m44/>")));
    assert!(text.contains("may expand to more than 1 MiB"), "{text}");
    assert!(text.contains("expand it with ROS"), "{text}");
    // As many levels that do not double are fine.
    let single: String = (1..40)
        .map(|level| {
            let below = level - 1;
            format!("<xacro:macro name=\"m{level}\"><xacro:m{below}/></xacro:macro>")
        })
        .collect();
    let text = with(&format!("{bottom}{single}<xacro:m39/>"));
    let found = expand(Path::new("/nowhere/arm.xacro"), &text);
    assert!(found.unwrap().urdf.contains("<link name=\"x\""));
}

#[test]
fn a_macro_that_calls_itself_twice_is_refused_and_once_under_a_condition_is_not() {
    let own = |calls: &str| {
        with(&format!(
            "<xacro:macro name=\"row\" params=\"n\"><link name=\"l${{n}}\"/>\
             <xacro:if value=\"${{n > 0}}\">{calls}</xacro:if></xacro:macro><xacro:row n=\"5\"/>"
        ))
    };
    let call = "<xacro:row n=\"${n - 1}\"/>";
    let found = expand(Path::new("/nowhere/arm.xacro"), &own(call)).unwrap();
    assert!(found.urdf.contains("\"l5\"") && found.urdf.contains("\"l0\""));
    let text = refusal(&own(&call.repeat(2)));
    assert!(text.contains("`row` may expand to more than"), "{text}");
}

#[test]
fn blocks_that_double_and_values_that_double_are_refused() {
    let twice = "<xacro:insert_block name=\"b\"/>".repeat(2);
    let nested = format!(
        "<xacro:macro name=\"two\" params=\"**b\">{twice}</xacro:macro>{}<x><link name=\"x\"/></x>{}",
        "<xacro:two><x>".repeat(22),
        "</x></xacro:two>".repeat(22)
    );
    let text = refusal(&with(&nested));
    assert!(text.contains("may expand to more than"), "{text}");
    let values: String = (1..60)
        .map(|level| {
            let below = level - 1;
            format!("<xacro:property name=\"p{level}\" value=\"${{p{below}}}${{p{below}}}\"/>")
        })
        .collect();
    let text = refusal(&with(&format!(
        "<xacro:property name=\"p0\" value=\"x\"/>{values}<link name=\"${{p59}}\"/>"
    )));
    assert!(text.contains("may grow longer than 64 KiB"), "{text}");
}

#[test]
fn expressions_that_make_much_of_little_are_refused() {
    for (value, words) in [
        ("${'a'.zfill(99999999999)}", "`zfill` is not understood"),
        (
            "${(lambda f: f(f))(lambda f: f(f))}",
            "`lambda` is not understood",
        ),
        ("${[x for x in [1, 2]]}", "`for` is not understood"),
        ("$", "a `$` begins an expression"),
    ] {
        let text = refusal(&with(&format!("<xacro:property name=\"p\" value=\"{value}\"/>")));
        assert!(text.contains(words), "{text}");
    }
    let long = format!("${{1{}}}", " + 1".repeat(1000));
    let text = refusal(&with(&format!("<link name=\"{long}\"/><joint name=\"{long}\"/>")));
    assert!(text.contains("longer than 2000 bytes"), "{text}");
}

/// A folder with `arm.xacro`, whose joint 1 is as fast as `expression` says, and these other files.
fn folder_with(expression: &str, files: &[(&str, &str)]) -> (tempfile::TempDir, PathBuf, String) {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let text = MACRO.replace("${radians(220)}", expression);
    let path = folder.path().join("robot/arm.xacro");
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(&path, &text).unwrap();
    (folder, path, text)
}

#[test]
fn data_of_yaml_files_is_found_from_the_folder_of_the_xacro_that_names_it() {
    let speeds = ("robot/config/speeds.yaml", "joint_1:\n  speed: !degrees 220\n");
    let value = "['joint_1']['speed']";
    for expression in [
        format!("${{xacro.load_yaml('config/speeds.yaml'){value}}}"),
        format!("${{2 * load_yaml( 'config/speeds.yaml' ){value} / 2}}"),
    ] {
        let (_folder, path, text) = folder_with(&expression, &[speeds]);
        let urdf = expand(&path, &text).unwrap().urdf;
        assert!(urdf.contains("velocity=\"3.839"), "{expression}: {urdf}");
    }
    // By the names that packages of ROS hand the file through: argument, parameter, property.
    let (_folder, path, _) = folder_with("", &[speeds, ("robot/package.xml", "<package/>")]);
    let text = with(
        "<xacro:arg name=\"kind\" default=\"speeds\"/>
         <xacro:arg name=\"file\" default=\"$(find robot)/config/$(arg kind).yaml\"/>
         <xacro:macro name=\"inner\" params=\"file\"><xacro:property name=\"data\" value=\"${xacro.load_yaml(file)}\"/>
           <link name=\"v${data['joint_1']['speed']}\"/></xacro:macro>
         <xacro:macro name=\"outer\" params=\"file\"><xacro:inner file=\"${file}\"/></xacro:macro>
         <xacro:outer file=\"$(arg file)\"/>",
    );
    let urdf = expand(&path, &text).unwrap().urdf;
    assert!(urdf.contains("\"v3.839"), "{urdf}");
}

#[test]
fn data_of_yaml_files_that_are_not_the_robots_own_is_refused() {
    let refused = |name: &str, files: &[(&str, &str)], words: &str| {
        let (_folder, path, text) = folder_with(&format!("${{load_yaml({name})['s']}}"), files);
        let error = expand(&path, &text).unwrap_err().to_string();
        assert!(
            error.contains("load_yaml") && error.contains(words),
            "no `{words}` in {error}"
        );
        assert!(!error.contains("secret-value"), "{error}");
        assert!(error.contains("arm.xacro:18:86"), "{error}");
    };
    let secret = ("secret.yaml", "s: secret-value");
    refused("'../secret.yaml'", &[secret], "is outside the folder");
    refused("'/etc/passwd'", &[], "is outside the folder");
    refused("'none.yaml'", &[], "cannot read");
    refused("'.'", &[], "it is a folder");
    refused(
        "'a' + '.yaml'",
        &[("robot/a.yaml", "s: 1")],
        "is not known before",
    );
    refused(
        "prefix + '.yaml'",
        &[("robot/.yaml", "s: 1")],
        "is not known before",
    );
    refused("'$(find etc)/passwd'", &[], "is not known before");
    let (_folder, path, _) = folder_with("", &[]);
    let text =
        with("<xacro:property name=\"f\" value=\"$(find etc)/passwd\"/><link name=\"${load_yaml(f)}\"/>");
    let error = expand(&path, &text).unwrap_err().to_string();
    assert!(error.contains("not in a ROS package `etc`"), "{error}");
    let large = format!("s: 1\n#{}", "x".repeat(1 << 20));
    refused("'a.yaml'", &[("robot/a.yaml", &large)], "larger than 1 MiB");
    refused(
        "'a.yaml'",
        &[("robot/a.yaml", &"[".repeat(100))],
        "nested deeper than 16",
    );
    refused(
        "'a.yaml'",
        &[("robot/a.yaml", &"[".repeat(3000))],
        "not valid YAML",
    );
    refused("'a.yaml'", &[("robot/a.yaml", "s: [")], "not valid YAML");
    // Two calls with a file each: which one the name means depends on the call.
    let (_folder, path, _) = folder_with("", &[("robot/a.yaml", "s: 1"), ("robot/b.yaml", "s: 2")]);
    let text = with(
        "<xacro:macro name=\"one\" params=\"f\"><link name=\"${load_yaml(f)['s']}\"/></xacro:macro>
         <xacro:one f=\"a.yaml\"/><xacro:one f=\"b.yaml\"/>",
    );
    assert!(
        expand(&path, &text)
            .unwrap_err()
            .to_string()
            .contains("is not known before")
    );
    // A name that is made of parts is not a call that is replaced, and the evaluator has no reader of its own.
    let text =
        with("<xacro:property name=\"p\" value=\"load_ya\"/><link name=\"${${p}ml('a.yaml')['s']}\"/>");
    assert!(expand(&path, &text).is_err());
    let text = with("<x>${load_yaml('a.yaml')['s']}</x>");
    assert!(expand(&path, &text).is_err());
}

#[cfg(unix)]
#[test]
fn links_and_pipes_are_no_way_to_other_files() {
    let (folder, path, text) = folder_with(
        "${load_yaml('a.yaml')['s']}",
        &[("secret.yaml", "s: secret-value")],
    );
    let named = path.with_file_name("a.yaml");
    std::os::unix::fs::symlink(folder.path().join("secret.yaml"), &named).unwrap();
    let error = expand(&path, &text).unwrap_err().to_string();
    assert!(
        error.contains("is outside the folder") && !error.contains("secret-value"),
        "{error}"
    );
    fs::remove_file(&named).unwrap();
    let made = std::process::Command::new("mkfifo").arg(&named).status().unwrap();
    assert!(made.success());
    let error = expand(&path, &text).unwrap_err().to_string();
    assert!(error.contains("is not a regular file"), "{error}");
}

#[test]
fn many_includes_of_one_file_are_reported_from_a_circle() {
    let include = |name: &str| format!("<xacro:include filename=\"{name}\"/>");
    let empty = "<robot xmlns:xacro=\"http://ros.org/wiki/xacro\"></robot>";
    let (_folder, path, _) = folder_with("", &[("robot/other.xacro", empty)]);
    assert!(expand(&path, &with(&include("other.xacro").repeat(100))).is_ok());
    let error = expand(&path, &with(&include("other.xacro").repeat(1000))).unwrap_err();
    assert_eq!(error.as_slice().len(), 1);
    assert!(error.to_string().contains("more than 100 includes"), "{error}");
    let text = with(&include("../robot/arm.xacro"));
    fs::write(&path, &text).unwrap();
    let error = expand(&path, &text).unwrap_err().to_string();
    assert!(error.contains("includes itself"), "{error}");
}
