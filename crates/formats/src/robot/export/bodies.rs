//! An arm as bodies that follow one another, each with the joints that move it relative to the body before.
//!
//! ```text
//! parent_from_body(q) = parent_from_body . J_1(q_1) . J_2(q_2) ...        J(q): turn by q about, or shift by q along, the axis
//! ```
//!
//! The first body is the base, the last one the flange; between them is one for each joint. Lengths m, angles rad, stiffness N m/rad (N/m).

use armill_core::clearance::Shape;
use armill_core::frame::Isometry;
use armill_core::nalgebra::{Matrix3, Point3, Vector3};
use armill_core::robot::{Attachment, Limits, Robot};

/// An arm, base to flange.
#[derive(Clone, Debug)]
pub(super) struct Linkage {
    /// Name of the robot.
    pub name: String,
    /// Base, a body for each joint, flange.
    pub bodies: Vec<Body>,
    /// Frames fixed to the base.
    pub frames: Vec<(String, Isometry)>,
    /// What a user should know of this linkage; each begins with the consequence.
    pub warnings: Vec<String>,
}

/// A rigid body.
#[derive(Clone, Debug)]
pub(super) struct Body {
    /// Its name. Names of bodies, frames, joints and links between them differ from each other.
    pub name: String,
    /// In the body before, with its joints at zero.
    pub parent_from_body: Isometry,
    /// Those that move it, from the body before on.
    pub joints: Vec<BodyJoint>,
    /// Names of links between its joints, for formats with one joint between two links: one fewer than joints.
    pub between: Vec<String>,
    /// Mass and inertia, if known.
    pub inertial: Option<Inertial>,
    /// What it looks like.
    pub shapes: Vec<BodyShape>,
}

/// A joint between a body and the body before.
#[derive(Clone, Debug)]
pub(super) struct BodyJoint {
    /// Its name.
    pub name: String,
    /// Whether it is prismatic.
    pub slides: bool,
    /// Unit vector, axes of the body with its joints at zero.
    pub axis: Vector3<f64>,
    /// A point on the axis, in the frame of the body, m.
    pub point: Vector3<f64>,
    /// What moves it.
    pub kind: JointKind,
}

/// What moves a joint.
#[derive(Clone, Debug)]
pub(super) enum JointKind {
    /// A drive.
    Drive(Drive),
    /// The position of another joint times a factor.
    Follower {
        /// Name of the other joint.
        of: String,
        /// The factor.
        factor: f64,
    },
    /// A spring that is at zero without load.
    Spring {
        /// N m/rad (N/m).
        stiffness: f64,
    },
}

/// A joint with a drive.
#[derive(Clone, Debug)]
pub(super) struct Drive {
    /// Index of the joint in the robot.
    pub joint: usize,
    /// Range, if known.
    pub limits: Option<Limits>,
    /// Greatest speed, if known.
    pub max_speed: Option<f64>,
    /// Inertia of the rotor at the joint, kg m^2 (kg), if known.
    pub rotor_inertia: Option<f64>,
    /// Stiffness of the joint itself, if it is exported as a spring, N m/rad (N/m), and the position without load.
    pub spring: Option<[f64; 2]>,
}

/// Mass and inertia of a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inertial {
    /// kg
    pub mass: f64,
    /// In the frame of the body, m.
    pub centre: Vector3<f64>,
    /// About the centre, axes of the body, kg m^2.
    pub inertia: Matrix3<f64>,
}

/// A shape of a body.
#[derive(Clone, Debug)]
pub(super) struct BodyShape {
    /// Where it is in the body.
    pub body_from_shape: Isometry,
    /// The shape.
    pub geometry: Geometry,
}

/// A shape in its own frame.
#[derive(Clone, Debug)]
pub(super) enum Geometry {
    /// A body of the robot file.
    Solid(Shape),
    /// A mesh file.
    Mesh {
        /// As the source names it.
        file: String,
        /// Factors that make metres of it.
        scale: [f64; 3],
        /// Whether it is how the body looks, or its coarser shape for collisions.
        looks: bool,
    },
}

impl Linkage {
    /// Bodies that move relative to the base and whose mass is not known.
    pub fn without_mass(&self) -> impl Iterator<Item = &Body> {
        let moving = self.bodies.iter().filter(|body| !body.joints.is_empty());
        moving.filter(|body| body.inertial.is_none())
    }

    /// The flange without joints of its own is rigid on the body before: its mass is added there.
    #[must_use]
    pub fn with_rigid_flange(mut self) -> Linkage {
        let Some(flange) = self.bodies.pop() else {
            return self;
        };
        let mut flange = flange;
        if flange.joints.is_empty()
            && let (Some(own), Some(before)) = (flange.inertial.take(), self.bodies.last_mut())
        {
            let moved = own.seen_from(&flange.parent_from_body);
            before.inertial = Some(before.inertial.map_or(moved, |other| other.joined(&moved)));
        }
        self.bodies.push(flange);
        self
    }
}

impl Inertial {
    /// The same in another frame, in which the old one is at `new_from_old`.
    pub(super) fn seen_from(&self, new_from_old: &Isometry) -> Inertial {
        let turn = new_from_old.rotation.to_rotation_matrix();
        Inertial {
            mass: self.mass,
            centre: (new_from_old * Point3::from(self.centre)).coords,
            inertia: turn * self.inertia * turn.transpose(),
        }
    }

    /// Both as one body.
    pub(super) fn joined(&self, other: &Inertial) -> Inertial {
        let mass = self.mass + other.mass;
        let centre = match mass > 0.0 {
            true => (self.centre * self.mass + other.centre * other.mass) / mass,
            false => self.centre,
        };
        let about_centre = |body: &Inertial| {
            let by = body.centre - centre;
            body.inertia + (Matrix3::identity() * by.norm_squared() - by * by.transpose()) * body.mass
        };
        Inertial {
            mass,
            centre,
            inertia: about_centre(self) + about_centre(other),
        }
    }
}

/// Index of the body that moves with this attachment; none for the tool.
pub(super) fn body_of(attachment: Attachment, robot: &Robot) -> Option<usize> {
    let joints = robot.joints().len();
    (attachment != Attachment::Tool).then(|| attachment.rank(joints))
}
