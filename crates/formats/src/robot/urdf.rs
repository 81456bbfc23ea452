//! URDF: XML robot descriptions of ROS, in m and rad.
//!
//! The chain runs from the root link to the tip with the most moving joints (`tool0` among equals); side
//! branches are left out. `origin rpy` turns about fixed axes: `R = Rz(y) Ry(p) Rx(r)`. An axis that counts
//! against a coordinate axis becomes a joint of negative sign. URDF knows no compliance; `effort="0"` and
//! `velocity="0"` mean not given.

use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::robot::joint::Sign;
use armill_core::robot::{Amount, Axis, Joint, Limits, Motion, Robot};
use urdf_rs::JointType;

use super::description::{JointNote, RobotDescription, Source};
use crate::document::{self, Problem, Problems};

/// A component of an axis below this counts as none: files print six digits and more.
const ALIGNED: f64 = 1e-9;

/// The robot of this URDF text; `path` is what errors show, `id` the robot's name in results.
///
/// # Errors
/// What is not XML or not a URDF, joints of kinds that no serial arm has, chains without a moving joint.
pub fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    let file = document::Source::new(path, text);
    let whole = |message: String, hint: &str| {
        Problems::from(vec![file.problem(0..0, message, Some(hint.to_owned()))])
    };
    let urdf = urdf_rs::read_from_string(text).map_err(|error| {
        whole(
            format!("not a URDF: {error}"),
            "xacro files must be expanded first",
        )
    })?;
    let joints = chain_to_tip(&urdf).map_err(|message| {
        whole(
            message,
            "a serial arm has one root link and joints that lead away from it without a loop",
        )
    })?;

    let mut problems = Vec::new();
    let mut motions = Vec::new();
    let mut moving = Vec::new();
    for joint in joints {
        motions.extend(displacement(&joint.origin));
        match joint.joint_type {
            JointType::Fixed => {}
            JointType::Revolute | JointType::Continuous | JointType::Prismatic => match moved(joint, moving.len()) {
                Ok((motion, described)) => {
                    motions.extend(motion);
                    moving.push(described);
                }
                Err(message) => problems.push(at_joint(&file, &joint.name, message)),
            },
            ref other => problems.push(at_joint(
                &file,
                &joint.name,
                format!("joint `{}` is of type {other:?}: a serial arm has revolute, continuous, prismatic and fixed joints", joint.name),
            )),
        }
    }
    Problems::from(problems).into_result()?;
    let notes = vec![
        JointNote {
            source: Some("urdf".to_owned()),
            ..JointNote::default()
        };
        moving.len()
    ];
    let symbols = vec![None; motions.len()];
    let robot = Robot::new(id, motions, moving)
        .map_err(|error| whole(error.to_string(), "the file describes no robot that could move"))?;
    Ok(RobotDescription {
        robot,
        title: urdf.name.clone(),
        note: Some("URDF: no compliance; the base is its root link".to_owned()),
        payload_kg: None,
        symbols,
        joints: notes,
        sources: vec![Source {
            key: "urdf".to_owned(),
            what: "chain, limits and speeds".to_owned(),
            place: path.to_owned(),
            licence: "the user's file".to_owned(),
        }],
    })
}

fn at_joint(file: &document::Source, name: &str, message: String) -> Problem {
    let start = file
        .text()
        .find(&format!("\"{name}\""))
        .map_or(0, |quote| quote + 1);
    let end = if start == 0 { 0 } else { start + name.len() };
    file.problem(start..end, message, None)
}

/// The joints from the root link to the tip with the most moving joints.
fn chain_to_tip(urdf: &urdf_rs::Robot) -> Result<Vec<&urdf_rs::Joint>, String> {
    for joint in &urdf.joints {
        for link in [&joint.parent.link, &joint.child.link] {
            if !urdf.links.iter().any(|known| known.name == *link) {
                return Err(format!(
                    "joint `{}` names link `{link}`, which is not in the file",
                    joint.name
                ));
            }
        }
        let parents = urdf
            .joints
            .iter()
            .filter(|other| other.child.link == joint.child.link)
            .count();
        if parents > 1 {
            return Err(format!(
                "link `{}` is the child of {parents} joints",
                joint.child.link
            ));
        }
    }
    let is_child = |link: &str| urdf.joints.iter().any(|joint| joint.child.link == link);
    let is_parent = |link: &str| urdf.joints.iter().any(|joint| joint.parent.link == link);
    let roots = urdf.links.iter().filter(|link| !is_child(&link.name)).count();
    if roots != 1 {
        return Err(format!("{roots} links have no parent: one root is wanted"));
    }
    let tips = urdf
        .links
        .iter()
        .map(|link| link.name.as_str())
        .filter(|link| !is_parent(link));
    let chains = tips
        .map(|tip| Ok((tip, path_from_root(urdf, tip)?)))
        .collect::<Result<Vec<_>, String>>()?;
    let moving = |chain: &[&urdf_rs::Joint]| {
        chain
            .iter()
            .filter(|joint| joint.joint_type != JointType::Fixed && joint.mimic.is_none())
            .count()
    };
    let longest = chains
        .into_iter()
        .max_by_key(|(tip, chain)| (moving(chain), *tip == "tool0", chain.len()));
    longest
        .map(|(_, chain)| chain)
        .ok_or_else(|| "the file has no link".to_owned())
}

fn path_from_root<'a>(urdf: &'a urdf_rs::Robot, tip: &str) -> Result<Vec<&'a urdf_rs::Joint>, String> {
    let mut chain = Vec::new();
    let mut link = tip;
    while let Some(joint) = urdf.joints.iter().find(|joint| joint.child.link == link) {
        chain.push(joint);
        link = &joint.parent.link;
        if chain.len() > urdf.joints.len() {
            return Err(format!("the joints that lead to link `{tip}` form a loop"));
        }
    }
    chain.reverse();
    Ok(chain)
}

/// The motion of a moving joint, turned so that its axis is a coordinate axis, and what is known of it.
fn moved(joint: &urdf_rs::Joint, index: usize) -> Result<(Vec<Motion>, Joint), String> {
    let axis = Vector3::from(joint.axis.xyz.0);
    let Some(unit) = axis
        .try_normalize(1e-12)
        .filter(|unit| unit.iter().all(|c| c.is_finite()))
    else {
        return Err(format!("joint `{}` has an axis of length zero", joint.name));
    };
    let slides = joint.joint_type == JointType::Prismatic;
    let motion = |axis| match slides {
        true => Motion::Along(axis, Amount::Joint(index)),
        false => Motion::About(axis, Amount::Joint(index)),
    };
    let along = |axis: Axis| unit.dot(&axis.unit());
    let (motions, sign) = match [Axis::X, Axis::Y, Axis::Z]
        .into_iter()
        .find(|a| 1.0 - along(*a).abs() < ALIGNED)
    {
        Some(axis) => (
            vec![motion(axis)],
            if along(axis) < 0.0 {
                Sign::Negative
            } else {
                Sign::Positive
            },
        ),
        None => {
            let turn = UnitQuaternion::rotation_between(&Vector3::z(), &unit).unwrap_or_default();
            let mut motions = rotation(turn);
            motions.push(motion(Axis::Z));
            motions.extend(rotation(turn.inverse()));
            (motions, Sign::Positive)
        }
    };
    let limits = (joint.joint_type != JointType::Continuous && joint.limit.lower < joint.limit.upper)
        .then_some(Limits {
            lower: joint.limit.lower,
            upper: joint.limit.upper,
        });
    let max_speed = (joint.limit.velocity > 0.0).then_some(joint.limit.velocity);
    Ok((
        motions,
        Joint {
            sign,
            limits,
            max_speed,
            ..Joint::plain(&joint.name)
        },
    ))
}

fn displacement(pose: &urdf_rs::Pose) -> Vec<Motion> {
    let along =
        |(axis, value): (Axis, f64)| (value != 0.0).then_some(Motion::Along(axis, Amount::Constant(value)));
    let about =
        |(axis, value): (Axis, f64)| (value != 0.0).then_some(Motion::About(axis, Amount::Constant(value)));
    let ([x, y, z], [roll, pitch, yaw]) = (pose.xyz.0, pose.rpy.0);
    let translations = [(Axis::X, x), (Axis::Y, y), (Axis::Z, z)]
        .into_iter()
        .filter_map(along);
    let rotations = [(Axis::Z, yaw), (Axis::Y, pitch), (Axis::X, roll)]
        .into_iter()
        .filter_map(about);
    translations.chain(rotations).collect()
}

fn rotation(turn: UnitQuaternion<f64>) -> Vec<Motion> {
    let (roll, pitch, yaw) = turn.euler_angles();
    let about = |(axis, angle): (Axis, f64)| Motion::About(axis, Amount::Constant(angle));
    [(Axis::Z, yaw), (Axis::Y, pitch), (Axis::X, roll)]
        .into_iter()
        .map(about)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use armill_core::frame::Isometry;
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
    fn an_oblique_axis_turns_as_the_file_says() {
        let robot = read("s.urdf", "s", &urdf(&sound())).unwrap().robot;
        let q = [0.4, -0.7];
        let reached = posture_at(&robot, &q, &Isometry::identity()).base_from_tool;
        let origin = armill_core::frame::from_xyz_and_fixed_angles;
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
            text.contains("s.urdf:1:1") && text.contains("link `a` is the child of 2 joints"),
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
        assert!(text.contains("type Floating"), "{text}");
    }

    #[test]
    fn what_is_no_urdf_is_refused_in_one_line() {
        for text in ["", "<robot", "<robot name=\"x\"/>", "{}"] {
            assert!(read("s.urdf", "s", text).is_err(), "`{text}` was read");
        }
    }
}
