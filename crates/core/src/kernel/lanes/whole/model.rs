//! The constants of an arm and of all parts of its model.

use std::cmp::Reverse;

use nalgebra::{DMatrix, Vector3};

use super::chain::{ChainConstants, Displacement};
use super::curve_angles::CurveConstants;
use crate::robot::{Attachment, BacklashSide, Compensator, JointCompliance, Mass};
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
    /// The axis of the frame that it turns about, if `about`: then its motion is one unit about it.
    pub axis: usize,
    pub about: bool,
    /// rad/(N m) or m/N; zero where the joint has a torque curve or a compensator, which are added to the sum separately.
    pub compliance: f64,
    pub uncertainty: f64,
    /// Index of its contributor.
    pub contributor: usize,
    /// Displacement by gravity at tool setting per unit of compliance.
    pub reference: Vector3<f64>,
}

/// Parts with one frame, one after the other: about one axis each, at most three, or a single one with any motion.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct Group {
    pub rank: usize,
    pub first: usize,
    pub count: usize,
    pub about: bool,
}

/// A row of a covariance: part, and entries with itself and others; those with others are there once, twice as large.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct CovarianceRow {
    pub part: usize,
    pub entries: Vec<(usize, f64)>,
}

/// A joint with backlash.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct GapConstants {
    /// Index of the drive of its joint.
    pub part: usize,
    /// Half of the backlash, rad (m), and its standard uncertainty over it.
    pub half: f64,
    pub relative: f64,
    pub by_torque: bool,
}

/// Most gaps that lanes know. They are computed six or eight at once; those that an arm lacks are zero.
pub(in crate::kernel::lanes) const MOST_GAPS: usize = 8;

/// A joint with a compensator.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct CompensatorConstants {
    /// Index of the drive of the joint.
    pub part: usize,
    /// Its compliance without the compensator, rad/(N m), and the standard uncertainty of that if it is independent.
    pub compliance: f64,
    pub uncertainty: f64,
    /// Displacement by gravity at tool setting, m, base.
    pub reference: Vector3<f64>,
    pub compensator: Compensator,
    /// Whether its torque acts: not where gravity is neglected.
    pub weighs: bool,
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
    /// Drives and springs from tool to base, and their groups in the same order.
    pub parts: Vec<PartConstants>,
    pub groups: Vec<Group>,
    /// Displacement by gravity at tool setting, m, base.
    pub reference: Vector3<f64>,
    pub masses: Vec<MassConstants>,
    /// Of free fall, base, m/s^2; none where gravity is neglected.
    pub acceleration: Option<Vector3<f64>>,
    /// Covariance of the compliances that are not independent: the uncertainty of these is zero.
    pub covariance: Vec<CovarianceRow>,
    /// The joints with backlash, in their order.
    pub backlash: Vec<GapConstants>,
    /// The joints with torque curves.
    pub curves: Vec<CurveConstants>,
    pub compensator: Option<CompensatorConstants>,
    /// Weight of the masses that move with the end of the tool, N, base.
    pub weight_on_tool: Vector3<f64>,
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
    /// that lanes do not know: a load-dependent equilibrium, gravity on masses of known uncertainty, gravity or thermal growth of an arm whose part a positioner
    /// moves, a torque curve on the joint of the compensator or with more
    /// knots than lanes know, more than [`MOST_GAPS`] joints with backlash, no equilibrium at tool setting.
    pub fn of(arm: &Arm<'_>, unloaded: bool) -> Option<ModelConstants> {
        let (robot, model) = (arm.robot, arm.model);
        let structure = &model.structure;
        let thermal = model.thermal.filter(|_| unloaded);
        let special = structure.compensator.as_ref();
        if model.load_dependent || special.is_some_and(|c| structure.curve(c.joint).is_some()) {
            return None;
        }
        let uncertain = structure
            .masses
            .iter()
            .any(|mass| mass.relative_uncertainty > 0.0);
        if model.gravity.is_some() && uncertain {
            return None;
        }
        let turns = !robot.chain().ground().is_base();
        if turns && (thermal.is_some() || model.gravity.is_some()) {
            return None;
        }
        let joints = robot.joints().len();
        let contributors = model.contributors(joints);
        let place = |wanted: Contributor| contributors.iter().position(|one| *one == wanted);
        let gravity = model.gravity.as_ref().filter(|_| !structure.masses.is_empty());
        let at_reference = reference(arm)?;
        let there = |k: usize| at_reference.get(k).copied().unwrap_or_default();
        let chain = ChainConstants::of(robot);
        let correlated = structure.covariance.as_ref().map_or(0, DMatrix::nrows);
        let all = compliant(arm, &chain).into_iter().enumerate();
        let parts = all.map(|(k, (attachment, direction, c))| {
            let axis = direction.angular.iamax();
            let unit = direction.angular == Vector3::ith(axis, 1.0);
            let part = PartConstants {
                rank: attachment.rank(joints),
                linear: direction.linear,
                angular: direction.angular,
                axis,
                about: unit && direction.linear == Vector3::zeros(),
                compliance: c.value,
                uncertainty: if k < correlated {
                    0.0
                } else {
                    c.standard_uncertainty
                },
                contributor: place(Contributor::At(attachment))?,
                reference: there(k).1,
            };
            Some((k, part))
        });
        let mut parts = parts.collect::<Option<Vec<(usize, PartConstants)>>>()?;
        parts.sort_by_key(|(_, part)| (Reverse(part.rank), !part.about));
        let (order, mut parts): (Vec<usize>, Vec<PartConstants>) = parts.into_iter().unzip();
        let index = |k: usize| order.iter().position(|one| *one == k);
        let gaps = structure.joints_with_backlash().filter(|_| unloaded);
        let gaps = gaps.map(|(joint, gap)| {
            Some(GapConstants {
                part: index(joint)?,
                half: 0.5 * gap.gap,
                relative: gap.standard_uncertainty / gap.gap,
                by_torque: gap.side == BacklashSide::Torque,
            })
        });
        let backlash = gaps.collect::<Option<Vec<GapConstants>>>()?;
        let curved = (0..joints).filter_map(|joint| Some((joint, structure.curve(joint)?)));
        let curves = curved.map(|(joint, curve)| CurveConstants::of(curve, index(joint)?, there(joint).0));
        let curves = curves.collect::<Option<Vec<CurveConstants>>>()?;
        for curve in &curves {
            parts[curve.part].compliance = 0.0;
        }
        let compensator = match special {
            Some(compensator) => {
                let part = &mut parts[index(compensator.joint)?];
                Some(CompensatorConstants {
                    part: index(compensator.joint)?,
                    compliance: std::mem::take(&mut part.compliance),
                    uncertainty: std::mem::take(&mut part.uncertainty),
                    reference: there(compensator.joint).0,
                    compensator: *compensator,
                    weighs: model.gravity.is_some(),
                })
            }
            None => None,
        };
        if backlash.len() > MOST_GAPS {
            return None;
        }
        let covariance = structure.covariance.as_ref();
        if unloaded && (structure.learnt.is_some() || structure.geometry.is_some()) {
            return None;
        }
        let actual = model.actual.as_deref().filter(|_| unloaded);
        Some(ModelConstants {
            flange_from_tool: Displacement::of(arm.flange_from_tool),
            groups: groups(&parts),
            parts,
            reference: at_reference.iter().map(|(displacement, _)| displacement).sum(),
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
            covariance: covariance.map_or(Some(Vec::new()), |form| rows(form, index))?,
            backlash,
            curves,
            compensator,
            weight_on_tool: gravity.map_or_else(Vector3::zeros, |gravity| {
                let on_tool = |mass: &&Mass| mass.attachment == Attachment::Tool;
                let masses = structure.masses.iter().filter(on_tool);
                gravity.acceleration * masses.map(|mass| mass.mass).sum::<f64>()
            }),
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

/// Attachment, direction and compliance of the drives, then of the springs.
fn compliant(arm: &Arm<'_>, chain: &ChainConstants) -> Vec<(Attachment, Twist, JointCompliance)> {
    let drives = arm.compliance.iter().enumerate().map(|(joint, c)| {
        let (axis, slides) = chain.axis(joint);
        let (unit, none) = (Vector3::ith(axis, 1.0), Vector3::zeros());
        let (linear, angular) = if slides { (unit, none) } else { (none, unit) };
        (Attachment::Joint(joint), Twist { linear, angular }, *c)
    });
    let springs = arm.model.structure.springs.iter();
    let springs = springs.map(|spring| (spring.attachment, spring.direction, spring.compliance));
    drives.chain(springs).collect()
}

/// Groups of neighbours.
fn groups(parts: &[PartConstants]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (k, part) in parts.iter().enumerate() {
        match groups.last_mut() {
            Some(last) if last.rank == part.rank && last.about && part.about && last.count < 3 => {
                last.count += 1;
            }
            _ => groups.push(Group {
                rank: part.rank,
                first: k,
                count: 1,
                about: part.about,
            }),
        }
    }
    groups
}

/// Rows of a quadratic form up to the diagonal, without zeros; `index` gives the part of a row.
fn rows(form: &DMatrix<f64>, index: impl Fn(usize) -> Option<usize>) -> Option<Vec<CovarianceRow>> {
    let mut rows = Vec::new();
    for i in 0..form.nrows() {
        let mut entries = vec![(index(i)?, form[(i, i)])];
        for j in 0..i {
            entries.push((index(j)?, form[(i, j)] + form[(j, i)]));
        }
        entries.retain(|(_, value)| *value != 0.0);
        rows.push(CovarianceRow {
            part: index(i)?,
            entries,
        });
    }
    Some(rows)
}

/// Displacement by gravity at tool setting, m, part by part, and the same per unit of compliance; empty without gravity,
/// none where the arm has no equilibrium there.
fn reference(arm: &Arm<'_>) -> Option<Vec<(Vector3<f64>, Vector3<f64>)>> {
    let Some(gravity) = arm.model.gravity.as_ref() else {
        return Some(Vec::new());
    };
    let mut there = ArmState::new(*arm);
    there.set_joints(&gravity.reference);
    let parts = there.sagging()?.into_iter();
    Some(
        parts
            .map(|(displacement, per_unit)| (displacement.linear, per_unit))
            .collect(),
    )
}
