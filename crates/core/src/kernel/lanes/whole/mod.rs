//! The whole model in lanes: any chain at known joint positions, springs, masses, geometry, thermal growth.
//!
//! The same sum as `predict.rs`, a block of points at a time. Loops over parts are outside, loops over points inside:
//! only the latter become vectors.
//!
//! In reading order: `chain` (frames of the links), `model` (constants of an arm and its parts), `parts` (screws and
//! torques of gravity), `sum` (the displacements), `answer` (the worst case, shares, uncertainty),
//! `inputs` (uncertainty by load and tool). [`WholeModel`] runs them.

mod answer;
mod chain;
mod inputs;
mod model;
mod parts;
mod sum;

use nalgebra::Vector3;

use crate::kernel::lanes::load::Worst;
use crate::load::InputUncertainty;
use crate::numbers::{BLOCK, Backend, Plane, Planes, planes};
use crate::source::Arm;
use crate::spatial::Wrench;
use answer::{FindShares, TakeCase};
use chain::{FindFrames, FramePlanes};
use inputs::AddInputs;
use model::ModelConstants;
use parts::{FindParts, PartPlanes};
use sum::{FindStill, OneWrench, StillPlanes};

/// An arm with all parts of its model, and memory for a block of points; one per thread.
#[derive(Clone, Debug)]
pub(in crate::kernel) struct WholeModel {
    model: ModelConstants,
    backend: Backend,
    frames: Vec<FramePlanes<f64>>,
    actual: Vec<FramePlanes<f64>>,
    parts: Vec<PartPlanes<f64>>,
    still: Box<StillPlanes<f64>>,
    along: Planes<f64, 3>,
    by_load: Plane<f64>,
}

/// The answers of a block.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct WholeAnswers {
    /// Deviation under each load case, m, base.
    pub deviations: Vec<Planes<f64, 3>>,
    pub worst: Worst<f64>,
    /// Part of each contributor along the in-plane deviation of the worst case, m.
    pub shares: Vec<Plane<f64>>,
    /// Standard uncertainty of that deviation, m.
    pub uncertainty: Plane<f64>,
}

impl WholeAnswers {
    /// Memory for this many load cases and contributors.
    pub fn with(cases: usize, contributors: usize) -> WholeAnswers {
        WholeAnswers {
            deviations: vec![planes(); cases],
            worst: Worst {
                in_plane: [0.0; BLOCK],
                normal: [0.0; BLOCK],
                full: [0.0; BLOCK],
                case: [0.0; BLOCK],
                components: planes(),
                wrench: planes(),
            },
            shares: vec![[0.0; BLOCK]; contributors],
            uncertainty: [0.0; BLOCK],
        }
    }
}

impl WholeModel {
    /// For this arm; none if it has a part that lanes do not know.
    pub fn of(arm: &Arm<'_>, backend: Backend) -> Option<WholeModel> {
        let model = ModelConstants::of(arm)?;
        let frames = model.chain.joints() + 3;
        Some(WholeModel {
            frames: vec![FramePlanes::unknown(); frames],
            actual: vec![FramePlanes::unknown(); if model.actual.is_some() { frames } else { 0 }],
            parts: vec![PartPlanes::unknown(); model.parts.len()],
            still: Box::new(StillPlanes {
                gravity: planes(),
                geometry: planes(),
                lengths: planes(),
            }),
            along: planes(),
            by_load: [0.0; BLOCK],
            model,
            backend,
        })
    }

    /// Puts the arm of each point at these joint positions, rad (m), one plane per joint.
    pub(in crate::kernel::lanes) fn set_joints(&mut self, joints: &[Plane<f64>]) {
        let WholeModel {
            model,
            backend,
            frames,
            actual,
            parts,
            still,
            ..
        } = self;
        let flange_from_tool = &model.flange_from_tool;
        backend.run(FindFrames {
            chain: &model.chain,
            flange_from_tool,
            joints,
            frames,
        });
        if let Some(chain) = &model.actual {
            backend.run(FindFrames {
                chain,
                flange_from_tool,
                joints,
                frames: actual,
            });
        }
        backend.run(FindParts { model, frames, parts });
        backend.run(FindStill {
            model,
            frames,
            actual: model.actual.as_ref().map(|_| actual.as_slice()),
            parts,
            still,
        });
    }

    /// Displacement of the tool under `wrench` (at the TCP, base), m, base.
    fn deviate(&self, wrench: &Wrench, deviation: &mut Planes<f64, 3>) {
        self.backend.run(OneWrench {
            model: &self.model,
            parts: &self.parts,
            still: &self.still,
            force: wrench.force,
            moment: wrench.moment,
            deviation,
        });
    }
}

impl WholeModel {
    /// Number of contributors.
    pub(in crate::kernel::lanes) fn contributors(&self) -> usize {
        self.model.contributors
    }

    /// Deviations under these wrenches (at the TCP, base) and the worst case; `plane` is two directions across the
    /// normal, then the normal, base.
    pub(in crate::kernel::lanes) fn envelope(
        &mut self,
        cases: &[Wrench],
        plane: &[Vector3<f64>; 3],
        out: &mut WholeAnswers,
    ) {
        for (case, (wrench, deviation)) in cases.iter().zip(&mut out.deviations).enumerate() {
            self.deviate(wrench, deviation);
            self.backend.run(TakeCase {
                case,
                force: wrench.force,
                moment: wrench.moment,
                plane,
                deviation,
                worst: &mut out.worst,
            });
        }
    }

    /// [`WholeModel::envelope`] with shares and uncertainty, that of load and tool included.
    pub(in crate::kernel::lanes) fn answer(
        &mut self,
        cases: &[Wrench],
        plane: &[Vector3<f64>; 3],
        inputs: &InputUncertainty,
        out: &mut WholeAnswers,
    ) {
        self.envelope(cases, plane, out);
        self.backend.run(FindShares {
            model: &self.model,
            parts: &self.parts,
            still: &self.still,
            plane,
            worst: &out.worst,
            along: &mut self.along,
            by_load: &mut self.by_load,
            shares: &mut out.shares,
            uncertainty: &mut out.uncertainty,
        });
        if !inputs.is_none() {
            self.backend.run(AddInputs {
                model: &self.model,
                inputs,
                frames: &self.frames,
                parts: &self.parts,
                worst: &out.worst,
                along: &self.along,
                uncertainty: &mut out.uncertainty,
            });
        }
    }
}

#[cfg(test)]
mod tests;
