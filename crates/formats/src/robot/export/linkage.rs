//! The linkage of a robot.
//!
//! The frame of a body is that of its joint after its motion. Its pose at zero contains the zero offset of the joint, and its axis the sign: positions are
//! those of the robot file.
//!
//! | element of the robot | becomes |
//! |---|---|
//! | motions between two joints, calibrated ones included | `parent_from_body` |
//! | joint with sign and zero offset | a joint of kind [`JointKind::Drive`] |
//! | coupling `q + k q'` to an earlier joint | [`JointKind::Follower`] in front of the drive: its position is `k q'` |
//! | compliance of a drive, spring of the structure | [`JointKind::Spring`] behind the drive |
//! | masses with the same attachment | one [`Inertial`] |

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Matrix3, Vector3};
use armill_core::robot::{Amount, Attachment, Axis, Limits, Mass, Motion, Motor, Robot};

use super::bodies::{Body, BodyJoint, BodyShape, Drive, Geometry, Inertial, JointKind, Linkage, body_of};
use super::elasticity::{drive_stiffness, spring_joint};
use super::error::ExportError;
use super::names::Names;
use super::options::{CoupledJoints, ExportOptions, ExportedStiffness};
use crate::robot::RobotDescription;

impl Linkage {
    /// The linkage of a robot.
    ///
    /// # Errors
    /// Coupled joints without a decision; a stiffness that is requested but not known.
    pub fn of(found: &RobotDescription, options: &ExportOptions) -> Result<Linkage, ExportError> {
        let robot = &found.robot;
        let mut warnings = Vec::new();
        let mut names = Names::new(robot.joints().iter().map(|joint| joint.name.as_str()));
        let [base, flange] = ["base_link", "flange"].map(|name| names.unique(name));
        let frames = frames(robot, &mut names);
        let mut bodies = bodies(robot, &mut names, [base, flange]);
        for (index, body) in bodies.iter_mut().enumerate().skip(1).take(robot.joints().len()) {
            body.joints = drive(robot, index - 1, (options, &mut names, &mut warnings))?;
        }
        if options.stiffness != ExportedStiffness::None {
            for spring in &robot.structure().springs {
                match spring_joint(robot, spring, &mut names) {
                    Ok(Some((at, joint))) => bodies
                        .get_mut(at)
                        .into_iter()
                        .for_each(|b| b.joints.push(joint.clone())),
                    Ok(None) => {}
                    Err(warning) => warnings.push(warning),
                }
            }
        }
        for body in &mut bodies {
            let joints = body.joints.iter().skip(1);
            body.between = joints
                .map(|joint| names.unique(&format!("{}_carrier", joint.name)))
                .collect();
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
fn bodies(robot: &Robot, names: &mut Names, [base, flange]: [String; 2]) -> Vec<Body> {
    let body = |name: String, parent_from_body: Isometry| Body {
        name,
        parent_from_body,
        joints: Vec::new(),
        between: Vec::new(),
        inertial: None,
        shapes: Vec::new(),
    };
    let mut bodies = vec![body(base, Isometry::identity())];
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
    bodies.push(body(flange, fixed));
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
            .map(Motor::inertia_at_joint)
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
