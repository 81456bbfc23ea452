//! URDF: XML robot descriptions of ROS, in m and rad.
//!
//! The chain runs from the root link to a tip: the one asked for, or the one with the most moving joints
//! (`tool0` among equals). Side branches are left out, as are masses, meshes and collision shapes. `origin rpy`
//! turns about fixed axes: `R = Rz(y) Ry(p) Rx(r)`. An axis that counts against a coordinate axis becomes a joint
//! of negative sign. URDF knows no compliance; `effort="0"` and `velocity="0"` mean not given. A link `base` that
//! hangs rigidly on the root is where the controller counts from (ROS-Industrial): it becomes the frame
//! `controller`.

mod joints;
mod tree;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::robot::joint::Sign;
use armill_core::robot::model::NamedFrame;
use armill_core::robot::{Amount, Axis, Joint, Limits, Motion, Robot};

use self::joints::{JointElement, Kind};
use super::description::RobotDescription;
use super::{MOST_JOINTS, xml};
use crate::document::{self, Problems};

/// Joints of a chain, fixed ones included: a few stand between two that move.
const MOST_ELEMENTS: usize = 4 * MOST_JOINTS;

/// A component of an axis below this counts as none: files print six digits and more.
const ALIGNED: f64 = 1e-9;

/// The robot of this URDF text; `path` is what errors show, `id` the robot's name in results.
///
/// # Errors
/// As [`read_to_tip`].
pub fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    read_to_tip(path, id, text, None)
}

/// The robot of this URDF text with its flange at the link `tip`.
///
/// # Errors
/// What is not XML or not a URDF, a tree with a loop, a tip that is not there, joints of kinds that no serial arm
/// has, an axis of length zero, chains without a moving joint.
pub fn read_to_tip(
    path: &str,
    id: &str,
    text: &str,
    tip: Option<&str>,
) -> Result<RobotDescription, Problems> {
    let file = document::Source::new(path, text);
    let parsed = xml::parse(&file)?;
    let root = parsed.root_element();
    if root.tag_name().name() != "robot" {
        let message = format!(
            "not a URDF: its root is <{}>, not <robot>",
            root.tag_name().name()
        );
        return Err(file.problem(xml::tag(root), message, None).into());
    }
    let elements = joints::read(&file, root)?;
    let tree = tree::Tree::new(&file, root, &elements)?;
    let chain = tree.chain(&file, tip)?;

    let mut problems = Vec::new();
    let mut motions = Vec::new();
    let mut moving = Vec::new();
    if let Some(joint) = chain.joints.get(MOST_ELEMENTS) {
        let message = format!("the chain has more than {MOST_ELEMENTS} joints, fixed ones included");
        return Err(file.problem(joint.place.clone(), message, None).into());
    }
    for joint in &chain.joints {
        motions.extend(displacement(joint));
        match moved(joint, moving.len()) {
            Ok(Some(_)) if moving.len() >= MOST_JOINTS => {
                let message = format!("more than {MOST_JOINTS} joints move");
                problems.push(file.problem(joint.place.clone(), message, None));
                break;
            }
            Ok(Some((motion, described))) => {
                if moving.iter().any(|other: &Joint| other.name == described.name) {
                    let message = format!("another joint is called `{}`", described.name);
                    problems.push(file.problem(joint.place.clone(), message, None));
                }
                motions.extend(motion);
                moving.push(described);
            }
            Ok(None) => {}
            Err((message, hint)) => {
                problems.push(file.problem(joint.place.clone(), message, hint.map(str::to_owned)));
            }
        }
    }
    Problems::from(problems).into_result()?;
    let frames = controller_frame(&tree);
    let mut remarks = vec![format!(
        "the base is link `{}`, the flange link `{}`",
        tree.root, chain.tip
    )];
    if !frames.is_empty() {
        remarks.push("the frame `controller` is the link `base`, as ROS-Industrial has it".to_owned());
    }
    if !chain.left_out.is_empty() {
        remarks.push(format!(
            "moving joints off the chain are left out: {}",
            chain.left_out.join(", ")
        ));
    }
    let robot = Robot::new(id, motions, moving)
        .map_err(|error| {
            let hint = "the file describes no robot that could move".to_owned();
            Problems::from(file.problem(xml::tag(root), error.to_string(), Some(hint)))
        })?
        .with_frames(frames);
    let mut found = RobotDescription::of_one_source(robot, "urdf", path, "chain, limits and speeds");
    if let Some(name) = root.attribute("name").filter(|name| !name.trim().is_empty()) {
        found.title = name.to_owned();
    }
    found.note = Some("URDF: no compliance; the base is its root link".to_owned());
    found.remarks = remarks;
    Ok(found)
}

/// The link `base`, if it hangs rigidly on the root link and is not the root itself.
fn controller_frame(tree: &tree::Tree<'_>) -> Vec<NamedFrame> {
    let Some(path) = tree.path_from_root("base") else {
        return Vec::new();
    };
    let rigid = path.iter().all(|joint| joint.kind == Kind::Fixed);
    let base_from_frame = path
        .iter()
        .fold(Isometry::identity(), |pose, joint| pose * origin(joint));
    (rigid && !path.is_empty())
        .then(|| NamedFrame {
            name: "controller".to_owned(),
            base_from_frame,
        })
        .into_iter()
        .collect()
}

/// The motion of a moving joint, turned so that its axis is a coordinate axis, and what is known of it; nothing
/// for a fixed one.
#[allow(
    clippy::type_complexity,
    reason = "a motion with its joint, or a message with its hint"
)]
fn moved(
    joint: &JointElement,
    index: usize,
) -> Result<Option<(Vec<Motion>, Joint)>, (String, Option<&'static str>)> {
    let name = &joint.name;
    let slides = match &joint.kind {
        Kind::Fixed => return Ok(None),
        Kind::Turning => false,
        Kind::Sliding => true,
        Kind::Other(kind) => {
            let message = format!(
                "joint `{name}` is of type `{kind}`: a serial arm has revolute, continuous, prismatic and fixed joints"
            );
            return Err((message, Some("--tip LINK ends the chain before it")));
        }
    };
    if let Some(other) = &joint.mimics {
        let message =
            format!("joint `{name}` on the way to the tip mimics `{other}`: it has no position of its own");
        return Err((message, Some("--tip LINK ends the chain at another link")));
    }
    let Some(unit) = Vector3::from(joint.axis).try_normalize(1e-12) else {
        let message = format!("joint `{name}` has an axis of length zero");
        return Err((message, Some("an axis is a direction such as xyz=\"0 0 1\"")));
    };
    let motion = |axis| match slides {
        true => Motion::Along(axis, Amount::Joint(index)),
        false => Motion::About(axis, Amount::Joint(index)),
    };
    let along = |axis: Axis| unit.dot(&axis.unit());
    let aligned = [Axis::X, Axis::Y, Axis::Z]
        .into_iter()
        .find(|a| 1.0 - along(*a).abs() < ALIGNED);
    let (motions, sign) = match aligned {
        Some(axis) if along(axis) < 0.0 => (vec![motion(axis)], Sign::Negative),
        Some(axis) => (vec![motion(axis)], Sign::Positive),
        None => {
            let turn = UnitQuaternion::rotation_between(&Vector3::z(), &unit).unwrap_or_default();
            let mut motions = rotation(turn);
            motions.push(motion(Axis::Z));
            motions.extend(rotation(turn.inverse()));
            (motions, Sign::Positive)
        }
    };
    Ok(Some((
        motions,
        Joint {
            sign,
            limits: joint.limits.map(|[lower, upper]| Limits { lower, upper }),
            max_speed: joint.velocity,
            ..Joint::plain(name)
        },
    )))
}

/// Where a joint stands in its parent link.
fn origin(joint: &JointElement) -> Isometry {
    from_xyz_and_fixed_angles(joint.xyz.into(), joint.rpy.into())
}

fn displacement(joint: &JointElement) -> Vec<Motion> {
    let ([x, y, z], [roll, pitch, yaw]) = (joint.xyz, joint.rpy);
    [
        Motion::Along(Axis::X, Amount::Constant(x)),
        Motion::Along(Axis::Y, Amount::Constant(y)),
        Motion::Along(Axis::Z, Amount::Constant(z)),
        Motion::About(Axis::Z, Amount::Constant(yaw)),
        Motion::About(Axis::Y, Amount::Constant(pitch)),
        Motion::About(Axis::X, Amount::Constant(roll)),
    ]
    .into_iter()
    .filter(|motion| motion.amount() != Amount::Constant(0.0))
    .collect()
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
mod tests;
