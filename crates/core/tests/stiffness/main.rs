//! The full stiffness model against independent references: closed forms, energies, finite differences, the simple
//! model.
//!
//! `added_springs`: springs in addition to the drives; `gravity`: masses; `compensator_and_curves`: joints other than
//! linear springs; `under_load`: the equilibrium of the deflected arm; `at_points`: the same model in the kernel.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used)]

mod added_springs;
#[path = "../arms/mod.rs"]
mod arms;
mod at_points;
mod compensator_and_curves;
mod gravity;
mod under_load;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::robot::{Attachment, JointCompliance, Mass, Robot, Spring, Structure};
use armill_core::source::stiffness_model::FREE_FALL;
use armill_core::source::{Arm, Gravity, StiffnessModel};
use armill_core::spatial::Wrench;
use proptest::prelude::*;

/// Acceleration of free fall, base.
const DOWN: Vector3<f64> = Vector3::new(0.0, 0.0, -FREE_FALL);

/// A compliance known to a tenth.
fn spring(value: f64) -> JointCompliance {
    JointCompliance {
        value,
        standard_uncertainty: 0.1 * value,
    }
}

/// Springs at every kind of attachment, none in a special direction.
fn springs() -> Vec<Spring> {
    vec![
        Spring::about(Attachment::Joint(1), Vector3::x(), spring(2.4e-7)),
        Spring::about(Attachment::Base, Vector3::y(), spring(4e-8)),
        Spring::along(Attachment::Tool, Vector3::x(), spring(9e-7)),
        Spring::about(Attachment::Joint(4), Vector3::new(0.6, 0.0, 0.8), spring(1e-6)),
        Spring::about(Attachment::Joint(1), Vector3::y(), spring(5e-8)),
        Spring::along(Attachment::Flange, Vector3::z(), spring(1e-8)),
    ]
}

/// Masses and centres of Liu et al. 2026 (MIT), link frames of the modified DH rows of `arms::r2000ic`.
const FANUC: [(f64, [f64; 3]); 6] = [
    (262.614, [-0.0139, 0.0765, -0.1107]),
    (156.154, [0.4248, 0.04287, 0.2163]),
    (149.341, [0.1342, 0.2415, 0.0391]),
    (10.190, [0.0, 0.0019, -0.1055]),
    (17.698, [0.0, 0.0543, -0.0277]),
    (41.450, [0.0005, -0.0336, 0.2654]),
];
/// `d` of the rows: a link's frame is behind it, an attachment before it.
const FANUC_D: [f64; 6] = [0.670, 0.0, 0.0, 1.280, 0.0, 0.215];

/// Its masses at the attachments of its joints.
fn fanuc_masses() -> Vec<Mass> {
    let mass = |(joint, ((mass, [x, y, z]), d)): (usize, (&(f64, [f64; 3]), f64))| Mass {
        attachment: Attachment::Joint(joint),
        mass: *mass,
        centre: Point3::new(*x, *y, z + d),
        inertia: None,
        relative_uncertainty: 0.0,
    };
    FANUC.iter().zip(FANUC_D).enumerate().map(mass).collect()
}

/// A model with this structure under gravity, the tool set at the joint zeros.
fn weighing(structure: Structure) -> StiffnessModel {
    StiffnessModel {
        structure,
        gravity: Some(Gravity {
            acceleration: DOWN,
            reference: vec![0.0; 6],
        }),
        load_dependent: false,
        ..StiffnessModel::DRIVES.clone()
    }
}

/// The arm with the compliances of its file, this model and this tool.
fn full_arm<'a>(robot: &'a Robot, model: &'a StiffnessModel, tool: &'a Isometry) -> Arm<'a> {
    Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model,
        flange_from_tool: tool,
    }
}

/// One of `arms::ALL`, and parts of the ranges of its joints.
fn arm() -> impl Strategy<Value = (usize, [f64; 6])> {
    (0..arms::ALL.len(), prop::array::uniform6(0.0..1.0_f64))
}

/// Up to 500 N and 100 N m along each axis.
fn wrench() -> impl Strategy<Value = Wrench> {
    prop::array::uniform6(-1.0..1.0_f64).prop_map(|[a, b, c, d, e, f]| Wrench {
        force: Vector3::new(a, b, c) * 500.0,
        moment: Vector3::new(d, e, f) * 100.0,
    })
}
