//! Masses of the links of a URDF against a walk through its elements.

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::{Matrix3, UnitQuaternion, Vector3};
use armill_core::robot::Attachment;
use armill_core::robot::deflected_arm::attachment_frame;
use armill_core::robot::forward::forward;

use crate::robot::urdf::read;

/// Two joints, the second oblique, a flange, a box on the first link, and a finger behind a joint of its own.
fn urdf(inertials: [&str; 6]) -> String {
    let links: String = ["base_link", "a", "b", "tool0", "box", "finger"]
        .iter()
        .zip(inertials)
        .map(|(name, inertial)| format!("<link name=\"{name}\">{inertial}</link>"))
        .collect();
    let joint = |name: &str, kind: &str, ends: [&str; 2], inner: &str| {
        let [parent, child] = ends;
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>{inner}</joint>"
        )
    };
    let origin = |xyz: &str, rpy: &str| format!("<origin xyz=\"{xyz}\" rpy=\"{rpy}\"/>");
    let limit = "<limit lower=\"-1\" upper=\"2\" effort=\"0\" velocity=\"0\"/>";
    format!(
        "<robot name=\"small\">{links}{}{}{}{}{}</robot>",
        joint(
            "j1",
            "revolute",
            ["base_link", "a"],
            &format!("{}<axis xyz=\"0 0 -1\"/>{limit}", origin("0 0 0.4", "0 0 0"))
        ),
        joint(
            "j2",
            "revolute",
            ["a", "b"],
            &format!(
                "{}<axis xyz=\"0.6 0 0.8\"/>{limit}",
                origin("0.3 0 0", "0.1 0.2 0.3")
            )
        ),
        joint("flange", "fixed", ["b", "tool0"], &origin("0.1 0 0", "0 1.57 0")),
        joint("mount", "fixed", ["a", "box"], &origin("0 0.2 0", "0.3 0 0")),
        joint(
            "grip",
            "prismatic",
            ["a", "finger"],
            &format!("{limit}<mimic joint=\"j2\"/>")
        ),
    )
}

const BODY: &str = "<inertial><origin xyz=\"0.01 0.02 0.03\" rpy=\"0.4 0.5 0.6\"/><mass value=\"7\"/>\
     <inertia ixx=\"0.3\" ixy=\"0.01\" ixz=\"-0.02\" iyy=\"0.4\" iyz=\"0.03\" izz=\"0.5\"/></inertial>";

#[test]
fn links_have_their_masses_where_the_file_puts_them() {
    let found = read("s.urdf", "s", &urdf(["", BODY, BODY, BODY, BODY, BODY])).unwrap();
    let robot = &found.robot;
    let masses = &robot.structure().masses;
    let attachments: Vec<Attachment> = masses.iter().map(|mass| mass.attachment).collect();
    assert_eq!(attachments, [0, 1, 1, 0].map(Attachment::Joint));
    let remark = "masses behind joints outside the chain are left out: finger";
    assert!(
        found.remarks.iter().any(|given| given == remark),
        "{:?}",
        found.remarks
    );
    let q = [0.4, -0.7];
    let frames = forward(robot, &q);
    let turn = |axis: Vector3<f64>, angle: f64| {
        Isometry::from_parts(Default::default(), UnitQuaternion::new(axis * angle))
    };
    let origin = |xyz: [f64; 3], rpy: [f64; 3]| from_xyz_and_fixed_angles(xyz.into(), rpy.into());
    let a = origin([0.0, 0.0, 0.4], [0.0; 3]) * turn(-Vector3::z(), q[0]);
    let b = a * origin([0.3, 0.0, 0.0], [0.1, 0.2, 0.3]) * turn(Vector3::new(0.6, 0.0, 0.8), q[1]);
    let links = [
        a,
        b,
        b * origin([0.1, 0.0, 0.0], [0.0, 1.57, 0.0]),
        a * origin([0.0, 0.2, 0.0], [0.3, 0.0, 0.0]),
    ];
    let given = Matrix3::new(0.3, 0.01, -0.02, 0.01, 0.4, 0.03, -0.02, 0.03, 0.5);
    for (mass, base_from_link) in masses.iter().zip(links) {
        let frame = attachment_frame(mass.attachment, &frames, &frames.base_from_flange);
        let body = base_from_link * origin([0.01, 0.02, 0.03], [0.4, 0.5, 0.6]);
        assert!((frame * mass.centre - body.translation.vector).coords.norm() < 1e-14);
        let (ours, theirs) = (
            frame.rotation.matrix(),
            body.rotation.to_rotation_matrix().into_inner(),
        );
        let ours = ours * mass.inertia.unwrap() * ours.transpose();
        assert!((ours - theirs * given * theirs.transpose()).amax() < 1e-14);
    }
}

#[test]
fn what_cannot_be_used_is_left_out_with_a_remark_and_never_an_error() {
    let cases = [
        (
            "<inertial/>",
            "the mass of link `a` is left out: its <inertial> has no <mass",
        ),
        (
            "<inertial><mass value=\"heavy\"/></inertial>",
            "the mass of link `a` is left out: `heavy`",
        ),
        (
            "<inertial><mass value=\"-3\"/></inertial>",
            "the mass of link `a` is left out: -3 kg",
        ),
        (
            "<inertial><mass value=\"3\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"9\"/></inertial>",
            "link `a` is taken as a point with mass: principal inertias",
        ),
    ];
    let plain = read("s.urdf", "s", &urdf([""; 6])).unwrap();
    assert!(plain.robot.structure().masses.is_empty());
    for (inertial, said) in cases {
        let found = read("s.urdf", "s", &urdf(["", inertial, "", "", "", ""])).unwrap();
        assert!(
            found.remarks.iter().any(|remark| remark.starts_with(said)),
            "{said}: {:?}",
            found.remarks
        );
        assert!(
            found
                .robot
                .structure()
                .masses
                .iter()
                .all(|mass| mass.inertia.is_none())
        );
        assert_eq!(found.robot.chain().motions(), plain.robot.chain().motions());
    }
    let weightless = "<inertial><mass value=\"0\"/><inertia ixx=\"0\" iyy=\"0\" izz=\"0\"/></inertial>";
    let found = read("s.urdf", "s", &urdf([weightless; 6])).unwrap();
    assert!(found.robot.structure().masses.is_empty());
}

#[test]
fn a_mass_without_inertia_is_a_point() {
    let found = read(
        "s.urdf",
        "s",
        &urdf(["", "", "<inertial><mass value=\"3\"/></inertial>", "", "", ""]),
    )
    .unwrap();
    let masses = &found.robot.structure().masses;
    assert_eq!((masses.len(), masses[0].mass, masses[0].inertia), (1, 3.0, None));
}
