//! Masses of links, estimated from the mass of the whole arm and the bodies that enclose its links.
//!
//! ```text
//! m_l = (M - M_given) V_l / sum V        r_l = 1/V_l int r dV        I_l = m_l / V_l int ( (d.d) 1 - d d^T ) dV,  d = r - r_l
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `M`, `M_given` | mass of the whole arm; that of its links which are known | kg |
//! | `V_l` | volume of the union of the bodies at link `l`; the sum is over the links without a known mass, the base included | m^3 |
//! | `m_l`, `r_l` | mass and centre of link `l`, in the frame of its attachment | kg, m |
//! | `I_l` | inertia about the centre, same axes | kg m^2 |
//!
//! The density is taken to be the same in all links. It is not: motors and gears are near the joints, cast arms are hollow. Against
//! the published masses of 25 links of five arms the natural logarithm of the ratio has a root mean square of 0.45
//! (`validation/estimated-masses`): this is [`LINK_UNCERTAINTY`].
//!
//! The integrals are sums over a lattice of 64 cells along the longest edge of the box around the bodies, and as many as needed for nearly cubic cells
//! along the others: an error of one or two per cent.

use nalgebra::{IsometryMatrix3, Matrix3, Point3, Vector3};

use super::cell::ArmBody;
use super::shape::{Placed, Shape};
use crate::robot::{Attachment, Mass};

/// Relative standard uncertainty of the estimated mass of a link.
pub const LINK_UNCERTAINTY: f64 = 0.45;

/// Cells of the lattice along the longest edge.
const CELLS: f64 = 64.0;

/// Volume of bodies, its centre, and its inertia for a unit mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Of the union, m^3.
    pub volume: f64,
    /// Centre of the volume, m, frame of the attachment.
    pub centre: Point3<f64>,
    /// Inertia about the centre of a unit of mass, m^2, same axes.
    pub inertia_of_unit_mass: Matrix3<f64>,
}

/// Why masses cannot be estimated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EstimateError {
    /// No link without a mass has a body with a volume.
    #[error("no link without a given mass has a body")]
    WithoutBodies,
    /// The given masses, kg, are all of the arm, or more.
    #[error("the links with a given mass already have {given} kg")]
    NothingLeft {
        /// Sum of the given masses.
        given: f64,
    },
    /// A mesh, by the name of its body.
    #[error("body `{0}` is a mesh, whose volume is not evaluated")]
    Mesh(String),
}

/// Masses of the links that have bodies and no mass among `given`, from the mass of the whole arm without its tool, kg. The result has the
/// order base to flange.
///
/// # Errors
/// [`EstimateError`].
pub fn estimated_masses(bodies: &[ArmBody], total: f64, given: &[Mass]) -> Result<Vec<Mass>, EstimateError> {
    let of_arm = |at: &Attachment| matches!(at, Attachment::Base | Attachment::Joint(_));
    let known = given.iter().filter(|mass| of_arm(&mass.attachment));
    let sum: f64 = known.map(|mass| mass.mass).sum();
    let joints = bodies.iter().filter_map(|body| match body.attachment {
        Attachment::Joint(joint) => Some(joint + 1),
        _ => None,
    });
    let joints = 0..joints.max().unwrap_or(0);
    let links = std::iter::once(Attachment::Base).chain(joints.map(Attachment::Joint));
    let mut solids = Vec::new();
    for link in links.filter(|link| given.iter().all(|mass| mass.attachment != *link)) {
        let own: Vec<&ArmBody> = bodies.iter().filter(|body| body.attachment == link).collect();
        if let Some(mesh) = own.iter().find(|body| matches!(body.shape, Shape::Mesh(_))) {
            return Err(EstimateError::Mesh(mesh.name.clone()));
        }
        solids.extend(solid_of(&own).map(|solid| (link, solid)));
    }
    let volume: f64 = solids.iter().map(|(_, solid)| solid.volume).sum();
    if solids.is_empty() {
        return Err(EstimateError::WithoutBodies);
    }
    if total <= sum {
        return Err(EstimateError::NothingLeft { given: sum });
    }
    let density = (total - sum) / volume;
    let mass = |(attachment, solid): (Attachment, Solid)| Mass {
        attachment,
        mass: density * solid.volume,
        centre: solid.centre,
        inertia: Some(solid.inertia_of_unit_mass * (density * solid.volume)),
        relative_uncertainty: LINK_UNCERTAINTY,
    };
    Ok(solids.into_iter().map(mass).collect())
}

/// The union of bodies of one attachment; `None` without any, or where the lattice finds no volume.
fn solid_of(bodies: &[&ArmBody]) -> Option<Solid> {
    let placed: Vec<Placed> = bodies
        .iter()
        .map(|body| {
            let from_body: IsometryMatrix3<f64> = nalgebra::convert(body.attachment_from_body);
            body.shape.placed(&from_body)
        })
        .collect();
    let least = |axis: usize, sign: f64| {
        let direction = Vector3::ith(axis, sign);
        let reach = placed
            .iter()
            .map(|one| sign * one.farthest_along(&direction)[axis]);
        sign * reach.fold(f64::NEG_INFINITY, f64::max)
    };
    let lower = Vector3::from_fn(|axis, _| least(axis, -1.0));
    let edges = Vector3::from_fn(|axis, _| least(axis, 1.0)) - lower;
    let largest = edges.max() / CELLS;
    if placed.is_empty() || edges.min() <= 0.0 {
        return None;
    }
    let counts = edges.map(|edge| (edge / largest).ceil());
    let step = edges.component_div(&counts);
    let at = |cell: f64, axis: usize| lower[axis] + (cell + 0.5) * step[axis];
    let cells = |axis: usize| (0..counts[axis] as usize).map(|cell| cell as f64);
    let (mut count, mut sum, mut square) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for x in cells(0) {
        for y in cells(1) {
            for z in cells(2) {
                let point = Point3::new(at(x, 0), at(y, 1), at(z, 2));
                if placed.iter().any(|one| one.distance_of(&point, largest) <= 0.0) {
                    count += 1.0;
                    sum += point.coords;
                    square += point.coords * point.coords.transpose();
                }
            }
        }
    }
    if count == 0.0 {
        return None;
    }
    let centre = sum / count;
    // Within a cell: a twelfth of its edge squared along each axis.
    let within = Matrix3::from_diagonal(&step.map(|edge| edge * edge / 12.0));
    let spread = square / count - centre * centre.transpose() + within;
    Some(Solid {
        volume: count * step.product(),
        centre: centre.into(),
        inertia_of_unit_mass: Matrix3::identity() * spread.trace() - spread,
    })
}

#[cfg(test)]
mod tests;
