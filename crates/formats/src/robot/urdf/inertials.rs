//! The `<inertial>` elements of a URDF as masses of the arm.
//!
//! | element | content |
//! |---|---|
//! | `mass value` | kg |
//! | `origin xyz`, `rpy` | centre of mass in the frame of the link, m, and the axes of `inertia` |
//! | `inertia ixx ixy ixz iyy iyz izz` | inertia about the centre of mass, kg m^2; 0 where left out |
//!
//! A link that joints of type `fixed` connect to the chain moves with the chain. Links behind other joints outside the chain, such as
//! the fingers of a gripper, are left out. Nothing of an `<inertial>` is an error, because most uses of a URDF do not need it: what
//! cannot be used is left out, with a remark.
//!
//! Source: the XML specification of URDF (wiki.ros.org/urdf/XML/link).

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::{Matrix3, Vector3, convert};
use armill_core::robot::chain::LONGEST;
use armill_core::robot::deflected_arm::attachment_frame;
use armill_core::robot::forward::forward;
use armill_core::robot::{Attachment, Mass, Robot};
use roxmltree::Node;

use super::joints::{JointElement, Kind, origin, origin_of};
use super::tree;
use crate::document::{Problems, Source};
use crate::robot::body_inertia::not_of_a_body;
use crate::xml::{children, numbers, required};

/// Greatest mass of a link, kg: as in robot files.
const HEAVIEST: f64 = 1e6;

/// The masses of the links, and what is left out.
#[derive(Default)]
pub(super) struct Inertials {
    /// In the order of the links of the file.
    pub masses: Vec<Mass>,
    /// One line for each kind of thing that is left out.
    pub remarks: Vec<String>,
}

/// The masses of all links below `root` that move with the chain of this robot, whose joints are at zero at zero of the file.
pub(super) fn read(
    file: &Source,
    root: Node<'_, '_>,
    tree: &tree::Tree<'_>,
    (chain, robot): (&tree::Chain<'_>, &Robot),
) -> Inertials {
    let frames = forward(robot, &vec![0.0; robot.joints().len()]);
    let base_from_tool = frames.base_from_flange;
    let (mut found, mut behind_joints) = (Inertials::default(), Vec::new());
    for link in children(root, "link") {
        let Some(inertial) = children(link, "inertial").next() else {
            continue;
        };
        let name = link.attribute("name").unwrap_or_default();
        let Some(way) = tree.path_from_root(name) else {
            continue;
        };
        let Some(attachment) = attachment(&way, chain) else {
            behind_joints.push(name);
            continue;
        };
        let base_from_link = way
            .iter()
            .fold(Isometry::identity(), |pose, joint| pose * origin(joint));
        let base_from_attachment: Isometry = convert(attachment_frame(attachment, &frames, &base_from_tool));
        match mass(file, inertial) {
            Ok((mass, refused)) => {
                found
                    .remarks
                    .extend(refused.map(|why| format!("link `{name}` is taken as a point with mass: {why}")));
                let attachment_from_link = base_from_attachment.inv_mul(&base_from_link);
                let mass = mass.attached_to(attachment, &attachment_from_link);
                if mass.centre.coords.amax() > LONGEST {
                    found.remarks.push(format!(
                        "the mass of link `{name}` is left out: its centre is more than {LONGEST} m away"
                    ));
                } else if mass.mass > 0.0 || mass.inertia.is_some_and(|own| own.amax() > 0.0) {
                    found.masses.push(mass);
                }
            }
            Err(problems) => {
                let why = problems
                    .as_slice()
                    .first()
                    .map_or("", |problem| problem.message());
                found
                    .remarks
                    .push(format!("the mass of link `{name}` is left out: {why}"));
            }
        }
    }
    if !behind_joints.is_empty() {
        let links = behind_joints.join(", ");
        found.remarks.push(format!(
            "masses behind joints outside the chain are left out: {links}"
        ));
    }
    found
}

/// Where a link at the end of this way moves with the chain; `None` behind a joint outside the chain that is not fixed.
fn attachment(way: &[&JointElement], chain: &tree::Chain<'_>) -> Option<Attachment> {
    let mut attachment = Attachment::Base;
    let mut moving = 0;
    let mut on_chain = chain.joints.iter();
    let mut left = false;
    for joint in way {
        left |= on_chain.next().is_none_or(|of_chain| of_chain.name != joint.name);
        match (&joint.kind, left) {
            (Kind::Fixed, _) => {}
            (Kind::Turning | Kind::Sliding, false) => {
                attachment = Attachment::Joint(moving);
                moving += 1;
            }
            _ => return None,
        }
    }
    Some(attachment)
}

/// The mass of an `<inertial>`, attached to its own link, and why its inertia is left out, if it is.
///
/// # Errors
/// No mass, or one out of range; text in place of a number.
fn mass(file: &Source, inertial: Node<'_, '_>) -> Result<(Mass, Option<String>), Problems> {
    let element = |name: &'static str| children(inertial, name).next();
    let Some(mass_element) = element("mass") else {
        let message = "its <inertial> has no <mass value=\"...\"/>";
        return Err(file.problem(crate::xml::tag(inertial), message, None).into());
    };
    required(file, mass_element, "value")?;
    let [mass] = numbers(file, mass_element, "value", [0.0])?;
    if !(0.0..=HEAVIEST).contains(&mass) {
        let message = format!("{mass} kg is not from 0 to {HEAVIEST:e}");
        let place = crate::xml::value_place(mass_element, "value");
        return Err(file.problem(place, message, None).into());
    }
    let (xyz, rpy) = match element("origin") {
        Some(origin) => origin_of(file, origin)?,
        None => ([0.0; 3], [0.0; 3]),
    };
    let inertia = match element("inertia") {
        Some(inertia) => {
            let of = |key: &str| numbers(file, inertia, key, [0.0]).map(|[value]| value);
            let [xy, xz, yz] = [of("ixy")?, of("ixz")?, of("iyz")?];
            Some(Matrix3::new(
                of("ixx")?,
                xy,
                xz,
                xy,
                of("iyy")?,
                yz,
                xz,
                yz,
                of("izz")?,
            ))
        }
        None => None,
    };
    let refused = inertia.as_ref().and_then(not_of_a_body);
    let link_from_body: Isometry = from_xyz_and_fixed_angles(xyz.into(), rpy.into());
    let body = Mass {
        attachment: Attachment::Base,
        mass,
        centre: Vector3::zeros().into(),
        inertia: inertia.filter(|_| refused.is_none()),
        relative_uncertainty: 0.0,
    };
    Ok((body.attached_to(Attachment::Base, &link_from_body), refused))
}

#[cfg(test)]
mod tests;
