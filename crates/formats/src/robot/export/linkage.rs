//! An arm as bodies that follow one another, each with the joints that move it relative to the body before.
//!
//! ```text
//! parent_from_body(q) = parent_from_body . J_1(q_1) . J_2(q_2) ...        J(q): turn by q about, or shift by q along, the axis
//! ```
//!
//! The first body is the base, the last one the flange; between them is one for each joint, whose frame is that of the joint after its
//! motion. Its pose at zero contains the zero offset of the joint, and its axis the sign: positions are those of the robot file. Lengths m,
//! angles rad, stiffness N m/rad (N/m).
//!
//! | element of the robot | becomes |
//! |---|---|
//! | motions between two joints, calibrated ones included | `parent_from_body` |
//! | joint with sign and zero offset | a joint of kind [`JointKind::Drive`] |
//! | coupling `q + k q'` to an earlier joint | [`JointKind::Follower`] in front of the drive: its position is `k q'` |
//! | compliance of a drive, spring of the structure | [`JointKind::Spring`] behind the drive |
//! | masses with the same attachment | one [`Inertial`] |

use armill_core::clearance::Shape;
use armill_core::frame::Isometry;
use armill_core::nalgebra::{Matrix3, Point3, Vector3};
use armill_core::robot::{Amount, Attachment, Axis, Limits, Mass, Motion, Robot};

use super::elasticity::{drive_stiffness, spring_joint};
use super::names::Names;
use super::{CoupledJoints, ExportError, ExportOptions, ExportedStiffness};
use crate::robot::RobotDescription;

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
    /// Its name, different from those of all other bodies and frames.
    pub name: String,
    /// In the body before, with its joints at zero.
    pub parent_from_body: Isometry,
    /// Those that move it, from the body before on.
    pub joints: Vec<BodyJoint>,
    /// Mass and inertia, if known.
    pub inertial: Option<Inertial>,
    /// What it looks like.
    pub shapes: Vec<BodyShape>,
}

/// A joint between a body and the body before.
#[derive(Clone, Debug)]
pub(super) struct BodyJoint {
    /// Its name, different from those of all other joints.
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
    /// The linkage of a robot.
    ///
    /// # Errors
    /// Coupled joints without a decision; a stiffness that is requested but not known.
    pub fn of(found: &RobotDescription, options: &ExportOptions) -> Result<Linkage, ExportError> {
        let robot = &found.robot;
        let mut warnings = Vec::new();
        let mut names = Names::new(["base_link", "flange"]);
        let frames = frames(robot, &mut names);
        let mut bodies = bodies(robot, &mut names);
        let mut joint_names = Names::new(robot.joints().iter().map(|joint| joint.name.as_str()));
        for (index, body) in bodies.iter_mut().enumerate().skip(1).take(robot.joints().len()) {
            body.joints = drive(robot, index - 1, (options, &mut joint_names, &mut warnings))?;
        }
        if options.stiffness != ExportedStiffness::None {
            for spring in &robot.structure().springs {
                match spring_joint(robot, spring, &mut joint_names) {
                    Ok(Some((at, joint))) => bodies
                        .get_mut(at)
                        .into_iter()
                        .for_each(|b| b.joints.push(joint.clone())),
                    Ok(None) => {}
                    Err(warning) => warnings.push(warning),
                }
            }
        }
        let masses = &robot.structure().masses;
        for (index, body) in bodies.iter_mut().enumerate() {
            let here: Vec<&Mass> = masses
                .iter()
                .filter(|mass| body_of(mass.attachment, robot) == Some(index))
                .collect();
            body.inertial = inertial(&here);
        }
        if masses.iter().any(|mass| mass.attachment == Attachment::Tool) {
            warnings.push("masses of the tool are left out: an exported robot ends at its flange".to_owned());
        }
        for (at, shape) in shapes(found, options) {
            bodies
                .get_mut(at)
                .into_iter()
                .for_each(|body| body.shapes.push(shape.clone()));
        }
        Ok(Linkage {
            name: found.title.clone(),
            bodies,
            frames,
            warnings,
        })
    }

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
    fn seen_from(&self, new_from_old: &Isometry) -> Inertial {
        let turn = new_from_old.rotation.to_rotation_matrix();
        Inertial {
            mass: self.mass,
            centre: (new_from_old * Point3::from(self.centre)).coords,
            inertia: turn * self.inertia * turn.transpose(),
        }
    }

    /// Both as one body.
    fn joined(&self, other: &Inertial) -> Inertial {
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

/// The masses of one attachment as one body.
fn inertial(masses: &[&Mass]) -> Option<Inertial> {
    let own = masses.iter().map(|mass| Inertial {
        mass: mass.mass,
        centre: mass.centre.coords,
        inertia: mass.inertia.unwrap_or_else(Matrix3::zeros),
    });
    own.reduce(|a, b| a.joined(&b))
}

/// Index of the body that moves with this attachment; none for the tool.
pub(super) fn body_of(attachment: Attachment, robot: &Robot) -> Option<usize> {
    let joints = robot.joints().len();
    (attachment != Attachment::Tool).then(|| attachment.rank(joints))
}

/// Frames of the robot file; the one of the controller is `base`, as in ROS-Industrial.
fn frames(robot: &Robot, names: &mut Names) -> Vec<(String, Isometry)> {
    let frames = robot.frames().iter();
    let named = frames.map(|frame| {
        let name = match frame.name.as_str() {
            "controller" => "base",
            other => other,
        };
        (names.unique(name), frame.base_from_frame)
    });
    named.collect()
}

/// Base, links and flange without joints.
fn bodies(robot: &Robot, names: &mut Names) -> Vec<Body> {
    let body = |name: String, parent_from_body: Isometry| Body {
        name,
        parent_from_body,
        joints: Vec::new(),
        inertial: None,
        shapes: Vec::new(),
    };
    let mut bodies = vec![body("base_link".to_owned(), Isometry::identity())];
    let mut fixed = Isometry::identity();
    for motion in robot.chain().motions() {
        match motion.amount() {
            Amount::Constant(value) => fixed *= motion.displacement(value),
            Amount::Joint(index) => {
                let joint = &robot.joints()[index];
                fixed *= motion.displacement(joint.zero_offset);
                bodies.push(body(names.unique(&format!("{}_link", joint.name)), fixed));
                fixed = Isometry::identity();
            }
        }
    }
    bodies.push(body("flange".to_owned(), fixed));
    bodies
}

/// The joints of the body behind joint `index`: follower, drive, spring of the drive.
fn drive(
    robot: &Robot,
    index: usize,
    (options, names, warnings): (&ExportOptions, &mut Names, &mut Vec<String>),
) -> Result<Vec<BodyJoint>, ExportError> {
    let (joint, slides) = (&robot.joints()[index], robot.slides(index));
    let (Motion::Along(axis, _) | Motion::About(axis, _)) = robot.chain().links()[index].motion;
    let axis: Vector3<f64> = Axis::unit(axis) * joint.sign.factor();
    let with = |name: String, kind: JointKind| BodyJoint {
        name,
        slides,
        axis,
        point: Vector3::zeros(),
        kind,
    };
    let mut joints = Vec::new();
    let mut limits = joint.limits;
    for coupling in &joint.coupling {
        let other = &robot.joints()[coupling.joint];
        match options.coupling {
            None => {
                return Err(ExportError::Coupled {
                    joint: joint.name.clone(),
                    other: other.name.clone(),
                });
            }
            Some(CoupledJoints::Follower) => {
                let name = names.unique(&format!("{}_follows_{}", joint.name, other.name));
                let factor = coupling.factor;
                joints.push(with(
                    name,
                    JointKind::Follower {
                        of: other.name.clone(),
                        factor,
                    },
                ));
            }
            Some(CoupledJoints::Own) => {
                warnings.push(format!(
                    "positions of joint {0} are not those of the robot file: in the exported file they are {0} {1:+} x {2}, \
                     and its limits are the widest that occur",
                    joint.name, coupling.factor, other.name
                ));
                limits = match (limits, other.limits) {
                    (Some(own), Some(of_other)) => {
                        let ends = [of_other.lower, of_other.upper].map(|end| end * coupling.factor);
                        Some(Limits {
                            lower: own.lower + ends[0].min(ends[1]),
                            upper: own.upper + ends[0].max(ends[1]),
                        })
                    }
                    _ => None,
                };
            }
        }
    }
    let motors = robot.structure().motors.iter();
    let mut drive = Drive {
        joint: index,
        limits,
        max_speed: joint.max_speed,
        rotor_inertia: motors
            .filter(|motor| motor.joint == index)
            .map(|motor| motor.inertia_at_joint())
            .reduce(|a, b| a + b),
        spring: None,
    };
    let mut behind = None;
    if options.stiffness != ExportedStiffness::None {
        let stiffness = drive_stiffness(robot, index, warnings)?;
        match options.stiffness {
            ExportedStiffness::None => {}
            ExportedStiffness::Joints => {
                let Some(stiffness) = stiffness else {
                    return Err(ExportError::Rigid(joint.name.clone()));
                };
                let position = options.positions(robot, index)?;
                drive.spring = Some([stiffness, position]);
            }
            ExportedStiffness::Passive => {
                behind = stiffness.map(|stiffness| {
                    let name = names.unique(&format!("{}_spring", joint.name));
                    with(name, JointKind::Spring { stiffness })
                });
            }
        }
    }
    joints.push(with(joint.name.clone(), JointKind::Drive(drive)));
    joints.extend(behind);
    Ok(joints)
}

/// Bodies of the robot file and meshes of its source, each with the index of its body.
fn shapes<'a>(
    found: &'a RobotDescription,
    options: &'a ExportOptions,
) -> impl Iterator<Item = (usize, BodyShape)> + 'a {
    let solids = found.bodies.iter().filter_map(|body| {
        let shape = BodyShape {
            body_from_shape: body.attachment_from_body,
            geometry: Geometry::Solid(body.shape.clone()),
        };
        Some((body_of(body.attachment, &found.robot)?, shape))
    });
    let meshes = options.meshes.iter().filter_map(|mesh| {
        let shape = BodyShape {
            body_from_shape: mesh.attachment_from_mesh,
            geometry: Geometry::Mesh {
                file: mesh.file.clone(),
                scale: mesh.scale,
                looks: mesh.looks,
            },
        };
        Some((body_of(mesh.attachment, &found.robot)?, shape))
    });
    solids.filter(|_| options.meshes.is_empty()).chain(meshes)
}
