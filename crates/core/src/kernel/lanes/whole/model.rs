//! The constants of an arm and of all parts of its model.

use nalgebra::{DMatrix, Vector3};

use super::backlash::GapConstants;
use super::chain::{ChainConstants, Displacement};
use crate::robot::{Attachment, BacklashSide};
use crate::source::{Arm, ArmState, Contributor};
use crate::spatial::Twist;

/// A drive or spring.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct PartConstants {
    /// Rank of its attachment.
    pub rank: usize,
    /// Its motion in the frame of the attachment.
    pub linear: Vector3<f64>,
    pub angular: Vector3<f64>,
    /// rad/(N m) or m/N.
    pub compliance: f64,
    pub uncertainty: f64,
    /// Index of its contributor.
    pub contributor: usize,
    /// Displacement by gravity at tool setting, m, and the same per unit of compliance.
    pub reference: [Vector3<f64>; 2],
}

/// A mass.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct MassConstants {
    pub rank: usize,
    pub mass: f64,
    pub centre: Vector3<f64>,
}

/// An arm whose parts lanes support.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct ModelConstants {
    pub chain: ChainConstants,
    pub flange_from_tool: Displacement,
    /// The drives, then the springs.
    pub parts: Vec<PartConstants>,
    pub masses: Vec<MassConstants>,
    /// Of free fall, base, m/s^2; none where gravity is neglected.
    pub acceleration: Option<Vector3<f64>>,
    /// Covariance of the first compliances, the others being independent: row by row up to the diagonal, the entries
    /// beside it twice.
    pub covariance: Vec<Vec<f64>>,
    /// The joints with backlash, in their order.
    pub backlash: Vec<GapConstants>,
    /// The calibrated arm.
    pub actual: Option<ChainConstants>,
    /// Relative growth of the links and its standard uncertainty.
    pub growth: Option<[f64; 2]>,
    /// Fraction of the deviation by load and gravity that no compliance explains; standard deviation of the attained
    /// position, m.
    pub model_error: f64,
    pub repeatability: f64,
    /// Number of contributors; index of the geometry and of thermal growth among them.
    pub contributors: usize,
    pub geometry: Option<usize>,
    pub thermal: Option<usize>,
}

impl ModelConstants {
    /// The constants of `arm`, with or without geometry, thermal growth and backlash (`unloaded`); none if it has a part
    /// that lanes do not know: torque curves, a compensator, a covariance, a load-dependent equilibrium, a rail that
    /// grows.
    pub fn of(arm: &Arm<'_>, unloaded: bool) -> Option<ModelConstants> {
        let (robot, model) = (arm.robot, arm.model);
        let structure = &model.structure;
        let thermal = model.thermal.filter(|_| unloaded);
        if !model.is_affine() || structure.compensator.is_some() {
            return None;
        }
        let joints = robot.joints().len();
        let contributors = model.contributors(joints);
        let place = |wanted: Contributor| contributors.iter().position(|one| *one == wanted);
        let gravity = model.gravity.as_ref().filter(|_| !structure.masses.is_empty());
        let at_reference = reference(arm);
        let chain = ChainConstants::of(robot);
        let drives = (0..joints).map(|joint| {
            let (axis, slides) = chain.axis(joint);
            let unit = Vector3::from_fn(|k, _| f64::from(u8::from(k == axis)));
            let (linear, angular) = if slides {
                (unit, Vector3::zeros())
            } else {
                (Vector3::zeros(), unit)
            };
            (
                Attachment::Joint(joint),
                Twist { linear, angular },
                arm.compliance[joint],
            )
        });
        let springs = structure.springs.iter();
        let springs = springs.map(|spring| (spring.attachment, spring.direction, spring.compliance));
        let parts = drives
            .chain(springs)
            .enumerate()
            .map(|(k, (attachment, direction, c))| {
                Some(PartConstants {
                    rank: attachment.rank(joints),
                    linear: direction.linear,
                    angular: direction.angular,
                    compliance: c.value,
                    uncertainty: c.standard_uncertainty,
                    contributor: place(Contributor::At(attachment))?,
                    reference: at_reference.get(k).copied().unwrap_or_default(),
                })
            });
        let gaps = structure.joints_with_backlash().filter(|_| unloaded);
        let gaps = gaps.map(|(joint, gap)| GapConstants {
            joint,
            half: 0.5 * gap.gap,
            relative: gap.standard_uncertainty / gap.gap,
            by_torque: gap.side == BacklashSide::Torque,
        });
        let actual = model.actual.as_deref().filter(|_| unloaded);
        Some(ModelConstants {
            flange_from_tool: Displacement::of(arm.flange_from_tool),
            parts: parts.collect::<Option<_>>()?,
            masses: gravity.map_or(Vec::new(), |_| {
                let masses = structure.masses.iter();
                masses
                    .map(|mass| MassConstants {
                        rank: mass.attachment.rank(joints),
                        mass: mass.mass,
                        centre: mass.centre.coords,
                    })
                    .collect()
            }),
            acceleration: gravity.map(|gravity| gravity.acceleration),
            covariance: structure.covariance.as_ref().map_or(Vec::new(), rows),
            backlash: gaps.collect(),
            actual: actual.map(ChainConstants::of),
            growth: thermal.map(|thermal| [thermal.growth, thermal.standard_uncertainty]),
            model_error: structure.model_error,
            repeatability: structure.repeatability,
            contributors: contributors.len(),
            geometry: actual.and_then(|_| place(Contributor::Geometry)),
            thermal: thermal.and_then(|_| place(Contributor::Thermal)),
            chain,
        })
    }
}

/// Rows of a quadratic form up to the diagonal.
fn rows(form: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let entry = |i: usize, j: usize| match i == j {
        true => form[(i, i)],
        false => form[(i, j)] + form[(j, i)],
    };
    let row = |i| (0..=i).map(|j| entry(i, j)).collect();
    (0..form.nrows()).map(row).collect()
}

/// Displacement by gravity at tool setting, part by part, and per unit of compliance; empty without gravity.
fn reference(arm: &Arm<'_>) -> Vec<[Vector3<f64>; 2]> {
    let Some(gravity) = arm.model.gravity.as_ref() else {
        return Vec::new();
    };
    let mut there = ArmState::new(*arm);
    there.set_joints(&gravity.reference);
    let each = there
        .screws()
        .iter()
        .zip(there.gravity_torques())
        .zip(arm.compliances());
    each.map(|((screw, torque), c)| [screw.linear * (c.value * torque), screw.linear * *torque])
        .collect()
}
