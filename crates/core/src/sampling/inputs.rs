//! The uncertain inputs of an arm as independent standard normal numbers, and the arm with a sample of them.
//!
//! ```text
//! x = m + sum_k z_k l_k        z_k ~ N(0, 1)        S = sum_k l_k l_k'
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `x`, `m`, `S` | compliances, backlash, masses, small motions of the geometry, ...; their values in the robot file; their covariance |
//! | `z_k` | independent input `k`, a standard normal number |
//! | `l_k` | change of the values by one standard uncertainty of input `k` |
//!
//! Correlated compliances have inputs along the axes of the part of their covariance that connects them; all others have an input each.
//! Compliances, backlash and masses cannot be negative: where a sample would be, it is 0 ([`SampledArm::cut`]).
//! Where no torque decides the side of a backlash, each side has the same probability: an input of its own, of which only the sign has an effect.
//!
//! Source: JCGM 101:2008, 6.4.7 and 6.4.8 (normal distributions); JCGM 100:2008, 5.2.

use std::sync::Arc;

use nalgebra::{DMatrix, SymmetricEigen, Vector3};

use crate::frame::Isometry;
use crate::robot::{Attachment, BacklashSide, Joint, JointCompliance, Robot, Structure};
use crate::source::{Arm, Contributor, StiffnessModel};

/// Variances below this part of the largest one of their block are rounding.
const NEGLIGIBLE: f64 = 1e-13;

/// What an input belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum InputSource {
    /// Compliances of drives and springs.
    Compliance,
    /// Width of a backlash.
    Backlash,
    /// Side of a backlash, where no torque decides it.
    BacklashSide,
    /// Masses.
    Mass,
    /// Geometry of the chain.
    Geometry,
    /// What was learnt of measured positions.
    Learnt,
    /// What no compliance explains of the deviation under load.
    ModelError,
    /// Scatter between repetitions.
    Repeatability,
}

impl InputSource {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            InputSource::Compliance => "compliance",
            InputSource::Backlash => "backlash",
            InputSource::BacklashSide => "backlash side",
            InputSource::Mass => "mass",
            InputSource::Geometry => "geometry",
            InputSource::Learnt => "learnt",
            InputSource::ModelError => "model error",
            InputSource::Repeatability => "repeatability",
        }
    }
}

/// One independent input.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledInput {
    /// What it belongs to.
    pub source: InputSource,
    /// The joints, attachments and other contributors that it changes; none for an input of the arm as a whole.
    pub contributors: Vec<Contributor>,
    change: Change,
}

/// The effect of one standard uncertainty of an input.
#[derive(Clone, Debug, PartialEq)]
enum Change {
    /// Of drives, then springs, by index.
    Compliances(Vec<(usize, f64)>),
    Backlash(usize, f64),
    Side(usize),
    Mass(usize, f64),
    Geometry(usize),
    Learnt(usize),
    ModelError(f64),
    Repeatability(usize, f64),
}

/// The independent inputs of an arm.
#[derive(Clone, Debug, PartialEq)]
pub struct InputSpace {
    inputs: Vec<SampledInput>,
}

impl InputSpace {
    /// Of an arm; those with a standard uncertainty of zero are left out.
    pub fn of(arm: &Arm<'_>) -> InputSpace {
        let structure = &arm.model.structure;
        let mut inputs = of_compliances(arm);
        for (joint, backlash) in structure.joints_with_backlash() {
            let at = vec![Contributor::At(Attachment::Joint(joint))];
            if backlash.standard_uncertainty > 0.0 {
                inputs.push(SampledInput {
                    source: InputSource::Backlash,
                    contributors: at.clone(),
                    change: Change::Backlash(joint, backlash.standard_uncertainty),
                });
            }
            if backlash.side == BacklashSide::Motion {
                inputs.push(SampledInput {
                    source: InputSource::BacklashSide,
                    contributors: at,
                    change: Change::Side(joint),
                });
            }
        }
        for (mass, m) in structure.masses.iter().enumerate() {
            if m.relative_uncertainty > 0.0 {
                inputs.push(SampledInput {
                    source: InputSource::Mass,
                    contributors: vec![Contributor::At(m.attachment)],
                    change: Change::Mass(mass, m.relative_uncertainty),
                });
            }
        }
        let of_arm = |source, contributor: Option<Contributor>, change| SampledInput {
            source,
            contributors: contributor.into_iter().collect(),
            change,
        };
        let geometry = structure
            .geometry
            .as_ref()
            .map_or(0, |geometry| geometry.inputs());
        inputs.extend((0..geometry).map(|input| {
            of_arm(
                InputSource::Geometry,
                Some(Contributor::Geometry),
                Change::Geometry(input),
            )
        }));
        if structure.learnt.is_some() {
            let shift = |axis| {
                of_arm(
                    InputSource::Learnt,
                    Some(Contributor::Learnt),
                    Change::Learnt(axis),
                )
            };
            inputs.extend((0..3).map(shift));
        }
        if structure.model_error > 0.0 {
            let change = Change::ModelError(structure.model_error);
            inputs.push(of_arm(InputSource::ModelError, None, change));
        }
        if structure.repeatability > 0.0 {
            inputs.extend((0..3).map(|axis| {
                let change = Change::Repeatability(axis, structure.repeatability);
                of_arm(InputSource::Repeatability, None, change)
            }));
        }
        InputSpace { inputs }
    }

    /// The inputs.
    pub fn inputs(&self) -> &[SampledInput] {
        &self.inputs
    }

    /// Names of the inputs of an arm with these joints: source and contributors, numbered where there are several of one name.
    pub fn names(&self, joints: &[Joint]) -> Vec<String> {
        let name = |input: &SampledInput| {
            let at: Vec<String> = (input.contributors.iter())
                .filter(|contributor| matches!(contributor, Contributor::At(_)))
                .map(|contributor| contributor.name(joints))
                .collect();
            let at = at.join("+");
            format!("{} {at}", input.source.name()).trim_end().to_owned()
        };
        let names: Vec<String> = self.inputs.iter().map(name).collect();
        let numbered = |(index, name): (usize, &String)| {
            let before = names[..index].iter().filter(|other| *other == name).count();
            match names.iter().filter(|other| *other == name).count() {
                1 => name.clone(),
                _ => format!("{name} {}", before + 1),
            }
        };
        names.iter().enumerate().map(numbered).collect()
    }

    /// `arm` with the inputs `z`, one standard normal number each.
    ///
    /// # Panics
    /// If `z` has another length than the inputs, or `arm` is not the one of these inputs.
    pub fn sampled(&self, arm: &Arm<'_>, z: &[f64]) -> SampledArm {
        assert_eq!(z.len(), self.inputs.len(), "one number for each input");
        let mut sampled = SampledArm::exact(arm);
        let structure = &mut sampled.model.structure;
        let mut by = vec![0.0; sampled.compliance.len() + structure.springs.len()];
        let inputs = structure
            .geometry
            .as_ref()
            .map_or(0, |geometry| geometry.inputs());
        let (mut motions, mut learnt) = (vec![0.0; inputs], [0.0; 3]);
        for (input, z) in self.inputs.iter().zip(z) {
            match &input.change {
                Change::Compliances(changes) => {
                    for (index, change) in changes {
                        by[*index] += z * change;
                    }
                }
                Change::Backlash(joint, u) => {
                    if let Some(backlash) = &mut structure.backlash[*joint] {
                        backlash.gap = not_negative(backlash.gap + z * u, &mut sampled.cut);
                    }
                }
                Change::Side(joint) => sampled.side[*joint] = 1.0_f64.copysign(*z),
                Change::Mass(mass, u) => {
                    let factor = not_negative(1.0 + z * u, &mut sampled.cut);
                    let mass = &mut structure.masses[*mass];
                    mass.mass *= factor;
                    mass.inertia = mass.inertia.map(|inertia| inertia * factor);
                }
                Change::Geometry(input) => motions[*input] = *z,
                Change::Learnt(axis) => learnt[*axis] = *z,
                Change::ModelError(u) => sampled.model_error = z * u,
                Change::Repeatability(axis, u) => sampled.scatter[*axis] = z * u,
            }
        }
        add(&mut sampled.compliance, structure, &by, &mut sampled.cut);
        if inputs > 0 {
            structure.geometry = structure
                .geometry
                .as_ref()
                .map(|geometry| Arc::new(geometry.shifted_by(&motions)));
        }
        if learnt != [0.0; 3] {
            structure.learnt = structure
                .learnt
                .as_ref()
                .map(|known| Arc::new(known.shifted_by(&learnt.into())));
        }
        sampled
    }
}

/// An arm with a sample of its uncertain inputs.
///
/// Its compliances and its model have no uncertainty of their own, apart from that of geometry and learnt residual.
#[derive(Clone, Debug)]
pub struct SampledArm {
    /// Compliance of each joint.
    pub compliance: Vec<JointCompliance>,
    /// The other parts of the model.
    pub model: StiffnessModel,
    /// Relative error of the deviation under load.
    pub model_error: f64,
    /// Displacement by scatter, m, base.
    pub scatter: Vector3<f64>,
    /// Side of the backlash where no torque decides it: -1 or 1; 0 without a sample, in the middle.
    pub side: Vec<f64>,
    /// Number of values that are 0 because the sample would be negative.
    pub cut: usize,
}

impl SampledArm {
    /// The arm as it is, with its uncertainties.
    pub fn nominal(arm: &Arm<'_>) -> SampledArm {
        SampledArm {
            compliance: arm.compliance.to_vec(),
            model: arm.model.clone(),
            model_error: 0.0,
            scatter: Vector3::zeros(),
            side: vec![0.0; arm.robot.joints().len()],
            cut: 0,
        }
    }

    /// The arm without the uncertainties that its inputs have.
    fn exact(arm: &Arm<'_>) -> SampledArm {
        let exact = |compliance: &JointCompliance| JointCompliance {
            standard_uncertainty: 0.0,
            ..*compliance
        };
        let mut sampled = SampledArm::nominal(arm);
        sampled.compliance = sampled.compliance.iter().map(exact).collect();
        let structure = &mut sampled.model.structure;
        (
            structure.covariance,
            structure.model_error,
            structure.repeatability,
        ) = (None, 0.0, 0.0);
        for spring in &mut structure.springs {
            spring.compliance = exact(&spring.compliance);
        }
        for backlash in structure.backlash.iter_mut().flatten() {
            backlash.standard_uncertainty = 0.0;
        }
        for mass in &mut structure.masses {
            mass.relative_uncertainty = 0.0;
        }
        sampled
    }

    /// The arm, a variant of `robot`.
    pub fn arm<'a>(&'a self, robot: &'a Robot, flange_from_tool: &'a Isometry) -> Arm<'a> {
        Arm {
            robot,
            compliance: &self.compliance,
            model: &self.model,
            flange_from_tool,
        }
    }

    /// Compliances of all drives, then of all springs.
    pub fn compliances(&self) -> Vec<f64> {
        let springs = self
            .model
            .structure
            .springs
            .iter()
            .map(|spring| spring.compliance);
        (self.compliance.iter().copied().chain(springs))
            .map(|compliance| compliance.value)
            .collect()
    }

    /// Positions of the links within their backlash where no torque decides the side, one per joint, rad (m).
    pub fn links(&self) -> Vec<f64> {
        let mut links = vec![0.0; self.side.len()];
        for (joint, backlash) in self.model.structure.joints_with_backlash() {
            links[joint] = 0.5 * self.side[joint] * backlash.gap;
        }
        links
    }
}

/// Inputs of the compliances: one for each axis of the blocks of the covariance.
fn of_compliances(arm: &Arm<'_>) -> Vec<SampledInput> {
    let (covariance, attachments) = (arm.compliance_covariance(), arm.attachments());
    let entry = |i: usize, j: usize| covariance[(i, j)];
    let mut inputs = Vec::new();
    for block in blocks(attachments.len(), |i, j| entry(i, j) != 0.0 || entry(j, i) != 0.0) {
        let covariance = DMatrix::from_fn(block.len(), block.len(), |i, j| entry(block[i], block[j]));
        let least = NEGLIGIBLE * covariance.amax();
        let axes = SymmetricEigen::new(covariance);
        let mut contributors: Vec<Contributor> = Vec::new();
        for k in &block {
            let contributor = Contributor::At(attachments[*k]);
            if !contributors.contains(&contributor) {
                contributors.push(contributor);
            }
        }
        for (axis, variance) in axes.eigenvalues.iter().enumerate().filter(|(_, v)| **v > least) {
            let change = |(row, k): (usize, &usize)| (*k, axes.eigenvectors[(row, axis)] * variance.sqrt());
            inputs.push(SampledInput {
                source: InputSource::Compliance,
                contributors: contributors.clone(),
                change: Change::Compliances(block.iter().enumerate().map(change).collect()),
            });
        }
    }
    inputs
}

/// Groups of indices below `count` that are connected, in the order of their first members.
fn blocks(count: usize, connected: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut is_taken = vec![false; count];
    let mut found = Vec::new();
    for first in 0..count {
        if std::mem::replace(&mut is_taken[first], true) {
            continue;
        }
        let (mut block, mut next) = (vec![first], 0);
        while next < block.len() {
            for (other, is_taken) in is_taken.iter_mut().enumerate() {
                if !*is_taken && connected(block[next], other) {
                    *is_taken = true;
                    block.push(other);
                }
            }
            next += 1;
        }
        block.sort_unstable();
        found.push(block);
    }
    found
}

/// Adds `by` to the compliances of drives and springs; a torque curve turns by as much more per unit of torque.
fn add(compliance: &mut [JointCompliance], structure: &mut Structure, by: &[f64], cut: &mut usize) {
    let (drives, springs) = by.split_at(compliance.len());
    for (joint, by) in drives.iter().enumerate() {
        let before = compliance[joint].value;
        compliance[joint].value = not_negative(before + by, cut);
        if let Some(Some(curve)) = structure.curves.get_mut(joint) {
            *curve = curve.more_compliant(compliance[joint].value - before);
        }
    }
    for (spring, by) in structure.springs.iter_mut().zip(springs) {
        spring.compliance.value = not_negative(spring.compliance.value + by, cut);
    }
}

/// `value`, or 0 where it is negative, which is counted.
fn not_negative(value: f64, cut: &mut usize) -> f64 {
    if value < 0.0 {
        *cut += 1;
    }
    value.max(0.0)
}

#[cfg(test)]
mod tests;
