//! Robot files that cannot be.

use super::lever;
use crate::cell::{Cell, LEVER, MH12_URDF};

#[test]
fn reversed_limits_of_a_joint_are_reported_with_both() {
    let words = [
        "lever.toml:14:14",
        "joint A: lower limit 120 deg is not below upper limit -100 deg",
        "[lower, upper]",
    ];
    lever("[-100, 120]", "[120, -100]").refused(&words);
}

#[test]
fn a_negative_compliance_of_a_joint_is_reported() {
    lever("= 2e-6", "= -2e-6").refused(&["lever.toml:16:", "compliance_rad_per_n_m", "-2e-6", "at least 0"]);
}

#[test]
fn a_chain_without_joints_is_reported() {
    let start = LEVER.find("[[joint]]").unwrap();
    let end = LEVER.find("[sources").unwrap();
    let text = format!("{}{}", &LEVER[..start], &LEVER[end..])
        .replace("name = \"lever\"", "name = \"lever\"\njoint = []")
        .replace("  { about = \"z\", joint = \"A\" },\n", "")
        .replace("  { along = \"x\", joint = \"B\" },\n", "");
    let cell = Cell::new();
    cell.file("rod.toml", text);
    cell.armill(&["robots", "rod.toml"])
        .refused(&["rod.toml:", "the chain has no joint", "[[joint]]"]);
    let fixed = MH12_URDF.replace("type=\"revolute\"", "type=\"fixed\"");
    cell.file("rod.urdf", fixed);
    cell.armill(&["robots", "rod.urdf"]).refused(&["rod.urdf:"]);
}

#[test]
fn a_length_beyond_all_reason_is_refused_in_a_robot_file() {
    lever("= 500", "= 1e305").refused(&["lever.toml:8:30", "1e305 mm", "at most 1000000 mm"]);
}

#[test]
fn a_broken_urdf_is_reported_with_its_file() {
    let cell = Cell::new();
    let half = &MH12_URDF[..MH12_URDF.len() / 2];
    let loop_of_joints = MH12_URDF.replace("<child link=\"tool0\"/>", "<child link=\"l2\"/>");
    for (text, word) in [
        ("", "the file is empty"),
        ("<robot", "not XML"),
        (half, "not XML"),
        ("<sdf/>", "not a URDF: its root is <sdf>"),
        (&MH12_URDF.replace("0.450", "0,450"), "arm.urdf:"),
        (&MH12_URDF.replace("0.450", "nan"), "`nan` in xyz"),
        (&MH12_URDF.replace("0.450", "1e305"), "lengths of a URDF are in m"),
        (
            &MH12_URDF.replace("<parent link=\"l2\"/>", "<parent link=\"gone\"/>"),
            "`gone`",
        ),
        (
            &MH12_URDF.replace("xyz=\"0 -1 0\"", "xyz=\"0 0 0\""),
            "axis of length zero",
        ),
        (&MH12_URDF.replacen("revolute", "floating", 1), "`floating`"),
        (&loop_of_joints, "arm.urdf:"),
    ] {
        cell.file("arm.urdf", text);
        cell.armill(&["pose", "arm.urdf", "--joints-deg", "0,0,0,0,0,0"])
            .refused(&["arm.urdf:", word]);
    }
}

#[test]
fn an_unknown_robot_name_is_reported() {
    Cell::new()
        .armill(&["pose", "lathe", "--joints-deg", "0"])
        .refused(&["`lathe`", "`armill robots`"]);
    Cell::new()
        .armill(&["pose", "gone.urdf", "--joints-deg", "0"])
        .refused(&["cannot read robot file gone.urdf"]);
    let cell = Cell::new();
    std::fs::create_dir(cell.at("folder.toml")).unwrap();
    cell.armill(&["robots", "folder.toml"]).refused(&["folder.toml"]);
}
