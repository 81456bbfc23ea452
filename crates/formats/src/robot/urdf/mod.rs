//! URDF: XML robot descriptions of ROS, in m and rad.
//!
//! The chain runs from the root link to a tip: the one requested, or the one with the most moving joints
//! (`tool0` among equals). Side branches are left out, except for masses of links that are fixed to the chain; so are meshes and collision shapes. `origin rpy`
//! turns about fixed axes: `R = Rz(y) Ry(p) Rx(r)`. An axis opposite to a coordinate axis becomes a joint
//! of negative sign. URDF has no compliance; `effort="0"` and `velocity="0"` mean not given. A link `base` that
//! hangs rigidly on the root is the reference of the controller (ROS-Industrial): it becomes the frame
//! `controller`.
//!
//! In reading order: `joints` (the elements as written), `tree` (links, joints and the chain to a tip), here the
//! motions of that chain, `inertials` (masses of its links), and [`meshes`] (how its links look).
//!
//! | element | motions |
//! |---|---|
//! | `origin xyz`, `rpy` | `Tx(x) Ty(y) Tz(z) Rz(yaw) Ry(pitch) Rx(roll)`, those that are not zero |
//! | `axis` along a coordinate axis | `Rx`, `Ry`, `Rz` (sliding: `Tx`, `Ty`, `Tz`) of the joint, sign as the axis |
//! | any other `axis` | `Rz(yaw) Ry(pitch)`, the joint about or along z, `Ry(-pitch) Rz(-yaw)` |
//! | `limit` | lower and upper, greatest speed; rad or m |
//!
//! Source: the XML specification of URDF (wiki.ros.org/urdf/XML).

mod inertials;
mod joints;
pub mod meshes;
mod tree;

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::robot::joint::Sign;
use armill_core::robot::model::NamedFrame;
use armill_core::robot::{Amount, Axis, Joint, Limits, Motion, Robot, Structure};

use self::joints::{JointElement, Kind, origin};
use super::MOST_JOINTS;
use super::description::RobotDescription;
use crate::document::{self, Problems};
use crate::xml;

/// Joints of a chain, fixed ones included: a few are between two that move.
const MOST_ELEMENTS: usize = 4 * MOST_JOINTS;

/// An axis of unit length whose components are all within this of a coordinate axis is that axis: files print six
/// digits and more.
const ALIGNED: f64 = 1e-6;

/// The robot of this URDF text; `path` is what errors show, `id` the robot's name in results.
///
/// # Errors
/// As [`read_to_tip`].
pub fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    read_to_tip(path, id, text, None)
}

/// The robot of this URDF text with its flange at the link `tip`.
///
/// Without `tip` the one that the header describes. Joints have the names of the file, zero at its zero.
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

    let arm = arm(&file, &chain.joints)?;
    let frames = controller_frame(&tree);
    let mut remarks = remarks(&tree, &chain, &arm, &frames);
    let robot = Robot::new(id, arm.motions, arm.joints)
        .map_err(|error| {
            let hint = "the file describes no robot that could move".to_owned();
            Problems::from(file.problem(xml::tag(root), error.to_string(), Some(hint)))
        })?
        .with_frames(frames);
    let inertials = inertials::read(&file, root, &tree, (&chain, &robot));
    remarks.extend(inertials.remarks);
    let structure = Structure {
        masses: inertials.masses,
        ..Structure::EMPTY
    };
    let robot = robot
        .with_structure(structure)
        .map_err(|error| Problems::from(file.problem(xml::tag(root), error.to_string(), None)))?;
    let mut found = RobotDescription::of_one_source(robot, "urdf", path, "chain, limits and speeds");
    if let Some(name) = root.attribute("name").filter(|name| !name.trim().is_empty()) {
        found.title = name.to_owned();
    }
    found.note = Some("URDF: no compliance; the base is its root link".to_owned());
    found.remarks = remarks;
    Ok(found)
}

/// A chain in the terms of the core, and the names of joints that were changed.
#[derive(Default)]
struct Arm {
    /// Base to tip.
    motions: Vec<Motion>,
    /// Those that move, in the order of the chain.
    joints: Vec<Joint>,
    /// Their axis is nearly along a coordinate axis, and is taken as that.
    aligned: Vec<String>,
    /// Their limits are not a valid range.
    unlimited: Vec<String>,
}

/// The motions and joints of a chain.
///
/// A fixed joint gives its displacement alone.
///
/// # Errors
/// All joints that no serial arm has, or that share a name; more joints than any arm has.
fn arm(file: &document::Source, chain: &[&JointElement]) -> Result<Arm, Problems> {
    if let Some(joint) = chain.get(MOST_ELEMENTS) {
        let message = format!("the chain has more than {MOST_ELEMENTS} joints, fixed ones included");
        return Err(file.problem(joint.place.clone(), message, None).into());
    }
    let mut problems = Vec::new();
    let mut arm = Arm::default();
    for joint in chain {
        let mut refuse = |message: String, hint: Option<&str>| {
            problems.push(file.problem(joint.place.clone(), message, hint.map(str::to_owned)));
        };
        arm.motions.extend(displacement(joint));
        let motion = match motion(joint) {
            Ok(Some(motion)) => motion,
            Ok(None) => continue,
            Err((message, hint)) => {
                refuse(message, Some(hint));
                continue;
            }
        };
        if arm.joints.len() >= MOST_JOINTS {
            refuse(format!("more than {MOST_JOINTS} joints move"), None);
            break;
        }
        if arm.joints.iter().any(|other| other.name == joint.name) {
            refuse(format!("another joint is called `{}`", joint.name), None);
        }
        arm.add(joint, motion);
    }
    Problems::from(problems).into_result().map(|()| arm)
}

/// The link `base`, if it hangs rigidly on the root link and is not the root itself.
///
/// One frame or none; its pose is in the root link.
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

/// What a reader should know of the arm.
///
/// Side branches, axes and limits that were changed are named with their joints.
fn remarks(tree: &tree::Tree<'_>, chain: &tree::Chain<'_>, arm: &Arm, frames: &[NamedFrame]) -> Vec<String> {
    let mut remarks = vec![format!(
        "the base is link `{}`, the flange link `{}`",
        tree.root, chain.tip
    )];
    if !frames.is_empty() {
        remarks.push("the frame `controller` is the link `base`, as ROS-Industrial has it".to_owned());
    }
    let named = [
        (
            "moving joints outside the chain are left out",
            chain.left_out.join(", "),
        ),
        (
            "axes within 1e-6 of a coordinate axis are taken as that axis",
            arm.aligned.join(", "),
        ),
        (
            "limits without a valid range are left out",
            arm.unlimited.join(", "),
        ),
    ];
    let named = named.into_iter().filter(|(_, joints)| !joints.is_empty());
    remarks.extend(named.map(|(what, joints)| format!("{what}: {joints}")));
    remarks
}

/// How a moving joint moves the links behind it.
struct Moving {
    /// A turn or slide by the amount.
    motion: fn(Axis, Amount) -> Motion,
    /// Unit vector.
    axis: Vector3<f64>,
}

/// How this joint moves; nothing for a fixed one.
///
/// # Errors
/// Message and hint for a joint that no serial arm has.
fn motion(joint: &JointElement) -> Result<Option<Moving>, (String, &'static str)> {
    let name = &joint.name;
    let motion = match &joint.kind {
        Kind::Fixed => return Ok(None),
        Kind::Turning => Motion::About,
        Kind::Sliding => Motion::Along,
        Kind::Other(kind) => {
            let message = format!(
                "joint `{name}` is of type `{kind}`: a serial arm has revolute, continuous, prismatic and fixed joints"
            );
            return Err((message, "--tip LINK ends the chain before it"));
        }
    };
    if let Some(other) = &joint.mimics {
        let message =
            format!("joint `{name}` on the way to the tip mimics `{other}`: it has no position of its own");
        return Err((message, "--tip LINK ends the chain at another link"));
    }
    match Vector3::from(joint.axis).try_normalize(1e-12) {
        Some(axis) => Ok(Some(Moving { motion, axis })),
        None => {
            let message = format!("joint `{name}` has an axis of length zero");
            Err((message, "an axis is a direction such as xyz=\"0 0 1\""))
        }
    }
}

impl Arm {
    /// Adds a joint that moves, turned so that its axis is a coordinate axis.
    ///
    /// Limits that are not a valid range are left out and named in `unlimited`. An axis along a coordinate axis but for
    /// the digits of a print is taken as that and named in `aligned`, unless it is exact.
    fn add(&mut self, joint: &JointElement, Moving { motion, axis }: Moving) {
        let amount = Amount::Joint(self.joints.len());
        let nearest = Axis::ALL[axis.iamax()];
        let sign = if axis[nearest.index()] < 0.0 {
            Sign::Negative
        } else {
            Sign::Positive
        };
        let off = axis - nearest.unit() * sign.factor();
        let sign = if off.amax() < ALIGNED {
            self.motions.push(motion(nearest, amount));
            if joint.axis.iter().filter(|part| **part != 0.0).count() > 1 {
                self.aligned.push(joint.name.clone());
            }
            sign
        } else {
            // Rz(yaw) Ry(pitch) takes z to the axis; by arc tangents, which lose no digits near z.
            let yaw = (Axis::Z, axis.y.atan2(axis.x));
            let pitch = (Axis::Y, axis.x.hypot(axis.y).atan2(axis.z));
            let turn = |(about, angle)| Motion::About(about, Amount::Constant(angle));
            let back = |(about, angle): (Axis, f64)| turn((about, -angle));
            self.motions.extend([turn(yaw), turn(pitch)]);
            self.motions.push(motion(Axis::Z, amount));
            self.motions.extend([back(pitch), back(yaw)]);
            Sign::Positive
        };
        let range = |[lower, upper]: &[f64; 2]| lower < upper && lower.is_finite() && upper.is_finite();
        let limits = joint.limits.filter(range);
        if joint.limits.is_some() && limits.is_none() {
            self.unlimited.push(joint.name.clone());
        }
        self.joints.push(Joint {
            sign,
            limits: limits.map(|[lower, upper]| Limits { lower, upper }),
            max_speed: joint.velocity,
            ..Joint::plain(&joint.name)
        });
    }
}

/// From the parent link to the joint, constants that are zero left out.
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

#[cfg(test)]
mod tests;
