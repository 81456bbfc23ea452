//! Functions of the joint positions that describe the load of a joint.
//!
//! ```text
//! without a robot          cos q_j, sin q_j                                 N m of the motor each
//! of a robot               z_j . ((R_b e) x g/|g|), two e for each body b    N m of the motor each
//! of a robot with masses   -tau_g(q)                                        coefficient: torque of the motor per torque of gravity, 1/ratio
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `q_j`, `z_j` | position and axis of the joint | rad, 1 (base axes) |
//! | `b`, `R_b` | a body that the joint moves: its own link, and the following ones as long as their axes are parallel to it; its rotation | |
//! | `e` | two directions fixed to the body, at right angles to its axis | 1 |
//! | `g` | gravity, along -z of the base | m/s^2 |
//! | `tau_g` | torque of gravity and of a compensator on the joint, from the masses of the robot file, in the direction of `q` | N m |
//!
//! A counterbalance on a joint depends on its position alone. Over the range of a log its torque is nearly one of sine and cosine, so that it cannot be distinguished from gravity: it is contained in the load.
//!
//! Not checked: that the base of the robot is upright, that the robot has no load at its flange but that of its file, and that no joint is coupled to another.

use nalgebra::{Rotation3, Vector3};

use crate::frame::{Isometry, both_across};
use crate::robot::forward::forward;
use crate::robot::jacobian::screws_at;
use crate::robot::{JointCompliance, Robot};
use crate::source::ArmState;
use crate::source::stiffness_model::{Arm, FREE_FALL, Gravity, StiffnessModel};

/// Sine of the angle between axes that are parallel.
const PARALLEL: f64 = 1e-6;
/// Values of a function below this are rounding.
const ROUNDING: f64 = 1e-9;

/// Unit of the coefficients of a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadUnit {
    /// N m of the motor.
    Torque,
    /// N m of the motor per N m at the joint.
    PerTorque,
}

/// One or two functions of the positions that belong together, at each instant.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadTerm {
    /// Name of each function.
    pub names: Vec<String>,
    /// Unit of their coefficients.
    pub unit: LoadUnit,
    /// Values of each function.
    // unit: those of the header
    pub values: Vec<Vec<f64>>,
}

/// Sine and cosine of the position of the joint itself, rad.
pub fn of_own_position(positions: &[f64]) -> Vec<LoadTerm> {
    let values = [f64::cos, f64::sin].map(|of| positions.iter().map(|q| of(*q)).collect());
    vec![LoadTerm {
        names: ["cosine", "sine"]
            .map(|of| format!("{of} of the position"))
            .to_vec(),
        unit: LoadUnit::Torque,
        values: values.to_vec(),
    }]
}

/// The load terms of each joint of `robot` at joint positions, rad, one list per instant.
///
/// Not checked: that each list has as many positions as the robot has joints, and that these are rotary.
pub fn of_robot(robot: &Robot, positions: &[Vec<f64>]) -> Vec<Vec<LoadTerm>> {
    match robot.structure().masses.is_empty() {
        true => by_directions(robot, positions),
        false => by_masses(robot, positions),
    }
}

fn by_masses(robot: &Robot, positions: &[Vec<f64>]) -> Vec<Vec<LoadTerm>> {
    let joints = robot.joints().len();
    let model = StiffnessModel {
        structure: robot.structure().clone(),
        gravity: Some(Gravity {
            acceleration: -FREE_FALL * Vector3::z(),
            reference: robot.middles(),
        }),
        ..StiffnessModel::DRIVES.clone()
    };
    // The torque of gravity does not depend on it.
    let rigid = vec![
        JointCompliance {
            value: 0.0,
            standard_uncertainty: 0.0,
        };
        joints
    ];
    let flange = Isometry::identity();
    let mut state = ArmState::new(Arm {
        robot,
        compliance: robot.compliance().unwrap_or(&rigid),
        model: &model,
        flange_from_tool: &flange,
    });
    let mut values = vec![Vec::with_capacity(positions.len()); joints];
    for q in positions {
        state.set_joints(q);
        // From the chain to the direction in which the controller counts.
        for ((own, torque), joint) in values.iter_mut().zip(state.gravity_torques()).zip(robot.joints()) {
            own.push(-joint.sign.factor() * torque);
        }
    }
    let term = |values: Vec<f64>| LoadTerm {
        names: vec!["torque of gravity".to_owned()],
        unit: LoadUnit::PerTorque,
        values: vec![values],
    };
    values.into_iter().map(|values| vec![term(values)]).collect()
}

/// Axes (base) and rotations of the links at one instant.
struct LinksAt {
    axes: Vec<Vector3<f64>>,
    rotations: Vec<Rotation3<f64>>,
}

impl LinksAt {
    fn of(robot: &Robot, q: &[f64]) -> LinksAt {
        let frames = forward(robot, q);
        let tcp = frames.base_from_flange.translation.vector.into();
        let screws = screws_at(robot, &frames, &tcp);
        LinksAt {
            axes: screws.iter().map(|screw| screw.angular).collect(),
            rotations: frames
                .base_from_joint
                .iter()
                .map(|frame| frame.rotation)
                .collect(),
        }
    }
}

fn by_directions(robot: &Robot, positions: &[Vec<f64>]) -> Vec<Vec<LoadTerm>> {
    let joints = robot.joints().len();
    let states: Vec<LinksAt> = positions.iter().map(|q| LinksAt::of(robot, q)).collect();
    let Some(LinksAt { axes, rotations }) = states.first() else {
        return vec![Vec::new(); joints];
    };
    let term = |joint: usize, body: usize| {
        let values = both_across(&axes[body]).map(|direction| {
            let own = rotations[body].inverse() * direction;
            states
                .iter()
                .map(|at| at.axes[joint].dot(&Vector3::z().cross(&(at.rotations[body] * own))))
                .map(|value| if value.abs() < ROUNDING { 0.0 } else { value })
                .collect()
        });
        LoadTerm {
            names: ["first", "second"]
                .map(|which| format!("{which} direction of link {}", body + 1))
                .to_vec(),
            unit: LoadUnit::Torque,
            values: values.to_vec(),
        }
    };
    (0..joints)
        .map(|joint| {
            (joint..joints)
                .take_while(|body| axes[joint].cross(&axes[*body]).norm() < PARALLEL)
                .map(|body| term(joint, body))
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector, Point3};

    use super::*;
    use crate::arms::{Stream, kr120};
    use crate::robot::{Attachment, Mass, Structure};

    fn positions(robot: &Robot) -> Vec<Vec<f64>> {
        let mut stream = Stream(11);
        (0..60).map(|_| stream.joints(robot)).collect()
    }

    /// Masses of a KR 120 on its links 2 and 3: both descriptions are independent (potential energy; axes and rotations).
    #[test]
    fn the_torque_of_masses_is_a_sum_of_the_directions() {
        let plain = kr120();
        let mass = |joint: usize, mass: f64, centre: [f64; 3]| Mass {
            attachment: Attachment::Joint(joint),
            mass,
            centre: Point3::from(centre),
            inertia: None,
            relative_uncertainty: 0.0,
        };
        let structure = Structure {
            masses: vec![
                mass(1, 300.0, [0.5, 0.02, 0.1]),
                mass(2, 200.0, [0.4, -0.03, 0.2]),
            ],
            ..Structure::EMPTY
        };
        let heavy = plain.clone().with_structure(structure).unwrap();
        let all = positions(&plain);
        let (directions, torques) = (of_robot(&plain, &all), of_robot(&heavy, &all));
        // Axis 1 is vertical; axes 2 and 3 are parallel.
        assert!(
            directions[0]
                .iter()
                .flat_map(|term| &term.values)
                .flatten()
                .all(|value| *value == 0.0)
        );
        assert_eq!([1, 2].map(|joint| directions[joint].len()), [2, 1]);
        assert_eq!(
            [&directions, &torques].map(|terms| terms[1][0].unit),
            [LoadUnit::Torque, LoadUnit::PerTorque]
        );
        for joint in [1, 2] {
            let columns: Vec<&Vec<f64>> = directions[joint].iter().flat_map(|term| &term.values).collect();
            let x = DMatrix::from_fn(all.len(), columns.len(), |row, column| columns[column][row]);
            let y = DVector::from_column_slice(&torques[joint][0].values[0]);
            let found = x.clone().svd(true, true).solve(&y, 1e-12).unwrap();
            let rest = (&y - &x * found).amax();
            assert!(
                rest < 1e-9 * y.amax() && y.amax() > 100.0,
                "joint {joint}: {rest} of {}",
                y.amax()
            );
        }
    }

    /// 10 kg at 1 m in front of axis 2 of an arm stretched forward: the motor has to push by 98.07 N m against its fall, which is toward positive A2.
    #[test]
    fn the_motor_holds_a_mass_against_its_fall() {
        let structure = Structure {
            masses: vec![Mass {
                attachment: Attachment::Joint(1),
                mass: 10.0,
                centre: Point3::new(1.0, 0.0, 0.0),
                inertia: None,
                relative_uncertainty: 0.0,
            }],
            ..Structure::EMPTY
        };
        let arm = kr120().with_structure(structure).unwrap();
        let found = of_robot(&arm, &[vec![0.0; 6]])[1][0].values[0][0];
        assert!((found + 98.0665).abs() < 1e-9, "{found}");
    }

    #[test]
    fn without_instants_there_is_no_load() {
        assert!(of_robot(&kr120(), &[]).iter().all(Vec::is_empty));
    }
}
