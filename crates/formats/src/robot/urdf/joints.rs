//! The joints of a URDF as they are in the file, each with its place.
//!
//! What the file leaves out is as the specification of URDF has it:
//!
//! | left out | taken as |
//! |---|---|
//! | `<origin>`, its `xyz` or `rpy` | zero |
//! | `<axis>` | `1 0 0` |
//! | `lower`, `upper` | 0; both 0 means no limits |
//! | `velocity`, or `velocity="0"` | not known |
//! | `<limit>` of a `continuous` joint | always none |
//!
//! `inf`, and numbers beyond 1000, mean an open end.

use std::ops::Range;

use armill_core::frame::{Isometry, fixed_angles, from_xyz_and_fixed_angles};
use armill_core::nalgebra::{Quaternion, UnitQuaternion};
use armill_core::robot::chain::LONGEST;
use roxmltree::Node;

use super::super::TWO_TURNS;
use crate::document::{Problems, Source};
use crate::xml::{children, numbers, required, tag, value_place};

/// An axis is a direction; squares of far larger components are none.
const LARGEST_AXIS: f64 = 1e6;

/// How a joint moves.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    /// `fixed`.
    Fixed,
    /// `revolute` and `continuous`.
    Turning,
    /// `prismatic`.
    Sliding,
    /// As the file says it.
    Other(String),
}

/// A `<joint>`; lengths m, angles rad.
#[derive(Clone, Debug)]
pub(super) struct JointElement {
    pub name: String,
    pub kind: Kind,
    /// Name of the link it is fixed to.
    pub parent: String,
    /// Name of the link that it moves.
    pub child: String,
    /// Where it is in its parent link, m.
    pub xyz: [f64; 3],
    /// Turns about the fixed axes x, y, z of its parent link, rad.
    pub rpy: [f64; 3],
    /// Direction in its own frame, of any length, zero included.
    pub axis: [f64; 3],
    /// Lower and upper end as given, infinite where open; `None` where there are none.
    pub limits: Option<[f64; 2]>,
    /// Greatest speed, rad/s or m/s.
    pub velocity: Option<f64>,
    /// The joint that this one follows.
    pub mimics: Option<String>,
    /// Its start tag, or what of it will be complained of.
    pub place: Range<usize>,
    /// The name of its child link.
    pub child_place: Range<usize>,
}

/// Where a joint is in its parent link.
pub(super) fn origin(joint: &JointElement) -> Isometry {
    from_xyz_and_fixed_angles(joint.xyz.into(), joint.rpy.into())
}

/// More joints than this are not accepted: a whole cell has a few hundred.
const MOST_ELEMENTS: usize = 10_000;

/// Every `<joint>` below the root.
///
/// # Errors
/// All that lack a name, a type or their links, or contain a text where a number is required.
pub(super) fn read(file: &Source, root: Node<'_, '_>) -> Result<Vec<JointElement>, Problems> {
    let mut problems = Vec::new();
    let mut joints = Vec::new();
    for (index, node) in children(root, "joint").enumerate() {
        if index == MOST_ELEMENTS {
            let message = format!("the file has more than {MOST_ELEMENTS} joints");
            return Err(file.problem(tag(node), message, None).into());
        }
        match joint(file, node) {
            Ok(joint) => joints.push(joint),
            Err(found) => problems.extend(found),
        }
    }
    Problems::from(problems).into_result().map(|()| joints)
}

/// One `<joint>` element.
///
/// # Errors
/// The first thing that is missing or not a number. An axis of length zero is reported later, and only of a joint of
/// the chain.
fn joint(file: &Source, node: Node<'_, '_>) -> Result<JointElement, Problems> {
    let name = required(file, node, "name")?.to_owned();
    let kind = match required(file, node, "type")? {
        "fixed" => Kind::Fixed,
        "revolute" | "continuous" => Kind::Turning,
        "prismatic" => Kind::Sliding,
        other => Kind::Other(other.to_owned()),
    };
    let link = |end: &str| -> Result<_, Problems> {
        let Some(element) = children(node, end).next() else {
            let message = format!("joint `{name}` has no <{end} link=\"...\"/>");
            return Err(file.problem(tag(node), message, None).into());
        };
        Ok((
            required(file, element, "link")?.to_owned(),
            value_place(element, "link"),
        ))
    };
    let (parent, _) = link("parent")?;
    let (child, child_place) = link("child")?;
    let (xyz, rpy) = match children(node, "origin").next() {
        Some(origin) => origin_of(file, origin)?,
        None => ([0.0; 3], [0.0; 3]),
    };
    let axis_element = children(node, "axis").next();
    let axis = match axis_element {
        Some(axis) => axis_of(file, axis)?,
        None => [1.0, 0.0, 0.0],
    };
    let limit = children(node, "limit").next();
    let end = |attribute: &str| end_of(file, limit, attribute);
    let ends = [end("lower")?, end("upper")?];
    let free = node.attribute("type") == Some("continuous")
        || ends == [0.0, 0.0]
        || ends == [f64::NEG_INFINITY, f64::INFINITY];
    let velocity = Some(end("velocity")?).filter(|speed| *speed > 0.0 && speed.is_finite());
    let mimic = children(node, "mimic").next();
    Ok(JointElement {
        kind,
        parent,
        child,
        xyz,
        rpy,
        axis,
        limits: (!free).then_some(ends),
        velocity,
        mimics: mimic.map(|mimic| mimic.attribute("joint").unwrap_or("another joint").to_owned()),
        place: match axis_element {
            Some(element) if axis == [0.0; 3] => value_place(element, "xyz"),
            _ => value_place(node, "name"),
        },
        child_place,
        name,
    })
}

/// The direction of an axis, of any length up to [`LARGEST_AXIS`].
///
/// # Errors
/// Components that are not numbers, or beyond it.
fn axis_of(file: &Source, axis: Node<'_, '_>) -> Result<[f64; 3], Problems> {
    let xyz = numbers(file, axis, "xyz", [1.0, 0.0, 0.0])?;
    match xyz.iter().find(|part| part.abs() > LARGEST_AXIS) {
        Some(far) => {
            let message = format!("{far:e} in an axis is beyond {LARGEST_AXIS:e}");
            let hint = "an axis is a direction such as xyz=\"0 0 1\"".to_owned();
            Err(file.problem(value_place(axis, "xyz"), message, Some(hint)).into())
        }
        None => Ok(xyz),
    }
}

/// A number of `<limit>`, infinite where it means an open end; zero where it is left out.
///
/// # Errors
/// What is not a number; `inf` and `-inf` are two.
fn end_of(file: &Source, limit: Option<Node<'_, '_>>, attribute: &str) -> Result<f64, Problems> {
    let Some(limit) = limit else { return Ok(0.0) };
    match limit.attribute(attribute).map(str::trim) {
        Some("inf") => Ok(f64::INFINITY),
        Some("-inf") => Ok(f64::NEG_INFINITY),
        _ => match numbers(file, limit, attribute, [0.0])? {
            // Files without limits write numbers that nothing reaches.
            [value] if value.abs() > LONGEST => Ok(f64::INFINITY.copysign(value)),
            [value] => Ok(value),
        },
    }
}

/// Position (m) and turns about the fixed axes x, y, z (rad).
///
/// # Errors
/// Positions beyond 1000 m, turns beyond two, a quaternion of length zero.
pub(super) fn origin_of(file: &Source, origin: Node<'_, '_>) -> Result<([f64; 3], [f64; 3]), Problems> {
    let xyz = numbers(file, origin, "xyz", [0.0; 3])?;
    if let Some(far) = xyz.iter().find(|value| value.abs() > LONGEST) {
        let message = format!("an origin {far} m away is beyond {LONGEST} m");
        let hint = "lengths of a URDF are in m".to_owned();
        return Err(file
            .problem(value_place(origin, "xyz"), message, Some(hint))
            .into());
    }
    let rpy = numbers(file, origin, "rpy", [0.0; 3])?;
    if let Some(far) = rpy.iter().find(|value| value.abs() > TWO_TURNS) {
        let message = format!("a rotation by {far} rad exceeds two turns");
        let hint = "angles of a URDF are in rad".to_owned();
        return Err(file
            .problem(value_place(origin, "rpy"), message, Some(hint))
            .into());
    }
    if origin.attribute("quat_xyzw").is_none() {
        return Ok((xyz, rpy));
    }
    // Since URDF 1.1 a quaternion may be there, and goes before `rpy`.
    let [x, y, z, w] = numbers(file, origin, "quat_xyzw", [0.0, 0.0, 0.0, 1.0])?;
    let Some(turn) = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9) else {
        let message = "a quaternion of length zero is not an orientation";
        return Err(file
            .problem(value_place(origin, "quat_xyzw"), message, None)
            .into());
    };
    Ok((xyz, fixed_angles(&turn).into()))
}
