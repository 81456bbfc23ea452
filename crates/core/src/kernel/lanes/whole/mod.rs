//! The whole model in lanes: any chain at known joint positions, springs, torque curves, masses, compensator, geometry,
//! thermal growth, backlash.
//!
//! The same sum as `predict.rs`, a block of points at a time. Loops over parts are outside, loops over points inside:
//! only the latter become vectors.
//!
//! In reading order: `chain` (frames of the links), `model` (constants of an arm and its parts), `parts` (screws and
//! torques of gravity), `compensator` (a spring against gravity), `sum` (the displacements), `curves` (joints whose
//! stiffness depends on their torque), `backlash` (sides of the links), `answer` (the worst case, shares, uncertainty),
//! `inputs` (uncertainty by load and tool). [`WholeModel`] runs them.
//!
//! Not known: a load-dependent equilibrium, a torque curve on the joint of the compensator, curves of more than 34 pairs,
//! more than eight joints with backlash. Such arms are computed one point after the other.

mod answer;
mod backlash;
mod chain;
mod compensator;
mod curves;
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
pub(in crate::kernel::lanes) use answer::TakeRoot;
use answer::{FindShares, TakeCase};
use backlash::{CaseOnPlane, GapPlanes, KeepOffsets, ShareBacklash, Worn, gaps_of, settle};
use chain::FindTool;
pub(in crate::kernel::lanes) use chain::{ChainConstants, Displacement, FindFrames, FramePlanes};
use compensator::{AddCompensated, Compensated, CompensatorPlanes, FindCompensation};
use curves::{AddTurns, CurvePlanes, Curved, FindSag, curves_of};
use inputs::AddInputs;
use model::ModelConstants;
pub(in crate::kernel::lanes) use parts::ResponsePlanes;
use parts::{FindParts, PartPlanes};
use sum::StillPlanes;
pub(in crate::kernel::lanes) use sum::under;
use sum::{AddStill, FindUnloaded, OneCase, OneWrench};

/// An arm with all parts of its model, and memory for a block of points; one per thread.
#[derive(Clone, Debug)]
pub(in crate::kernel) struct WholeModel {
    model: ModelConstants,
    /// Whether shares and uncertainty are computed.
    shares: bool,
    backend: Backend,
    frames: Vec<FramePlanes<f64>>,
    /// The tool of the calibrated arm, and memory.
    actual: Box<[FramePlanes<f64>; 2]>,
    parts: Vec<PartPlanes<f64>>,
    gaps: Vec<GapPlanes<f64>>,
    curves: Vec<CurvePlanes<f64>>,
    compensated: Option<Box<CompensatorPlanes<f64>>>,
    /// What the response to the current load case does not contain, m, base.
    rest: Box<Planes<f64, 3>>,
    /// Memory for a wrench at each point.
    wrench: Box<Planes<f64, 6>>,
    still: Box<StillPlanes<f64>>,
    along: Planes<f64, 3>,
    response: Box<ResponsePlanes<f64>>,
    by_unit: Vec<Plane<f64>>,
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
            worst: Worst::none(),
            shares: vec![[0.0; BLOCK]; contributors],
            uncertainty: [0.0; BLOCK],
        }
    }
}

impl WholeModel {
    /// For this arm; none if it has a part that lanes do not know.
    pub fn of(arm: &Arm<'_>, backend: Backend) -> Option<WholeModel> {
        Some(WholeModel::with(ModelConstants::of(arm, true)?, true, backend))
    }

    /// The same by load and gravity alone: without geometry, thermal growth and backlash, and without shares and
    /// uncertainty.
    pub fn by_load(arm: &Arm<'_>, backend: Backend) -> Option<WholeModel> {
        Some(WholeModel::with(ModelConstants::of(arm, false)?, false, backend))
    }

    fn with(model: ModelConstants, shares: bool, backend: Backend) -> WholeModel {
        let frames = model.chain.joints() + 3;
        WholeModel {
            frames: vec![FramePlanes::unknown(); frames],
            actual: Box::new([FramePlanes::unknown(), FramePlanes::unknown()]),
            parts: vec![PartPlanes::unknown(); model.parts.len()],
            still: Box::new(StillPlanes {
                sum: planes(),
                geometry: planes(),
                lengths: planes(),
            }),
            along: planes(),
            response: Box::new(ResponsePlanes::none()),
            by_unit: vec![[0.0; BLOCK]; model.parts.len()],
            gaps: gaps_of(&model),
            curves: curves_of(&model),
            compensated: model
                .compensator
                .as_ref()
                .map(|_| Box::new(CompensatorPlanes::unknown())),
            rest: Box::new(planes()),
            wrench: Box::new(planes()),
            model,
            shares,
            backend,
        }
    }

    /// Puts the arm of each point at these joint positions, rad (m), one plane per joint.
    pub(in crate::kernel::lanes) fn set_joints(&mut self, joints: &[Plane<f64>]) {
        let WholeModel {
            model,
            backend,
            frames,
            actual,
            compensated,
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
            let [tool, before] = &mut **actual;
            backend.run(FindTool {
                chain,
                flange_from_tool,
                joints,
                tool,
                before,
            });
        }
        if let (Some(constants), Some(out)) = (&model.compensator, compensated.as_deref_mut()) {
            backend.run(FindCompensation {
                model,
                constants,
                joints,
                out,
            });
        }
        if model.geometry.is_some() || model.growth.is_some() {
            backend.run(FindUnloaded {
                model,
                joints,
                frames,
                actual: &actual[0],
                still,
            });
        }
    }

    /// Frames at the joint positions set, by rank.
    pub(in crate::kernel::lanes) fn frames(&self) -> &[FramePlanes<f64>] {
        &self.frames
    }

    /// Axis of joint `index` in its own frame: 0, 1, 2 for x, y, z.
    pub(in crate::kernel::lanes) fn axis(&self, index: usize) -> usize {
        self.model.chain.axis(index).0
    }

    /// The response of the tool to the wrench of [`WholeModel::load`], and the displacement that it does not contain,
    /// m, base.
    pub(in crate::kernel::lanes) fn response(&self) -> (&ResponsePlanes<f64>, &Planes<f64, 3>) {
        let rest = if self.curves.is_empty() {
            &self.still.sum
        } else {
            &*self.rest
        };
        (&self.response, rest)
    }

    /// Whether lanes know an equilibrium of point `i` at the joint positions set.
    pub(in crate::kernel::lanes) fn is_stable(&self, i: usize) -> bool {
        self.compensated
            .as_ref()
            .is_none_or(|compensated| compensated.unstable[i] == 0.0)
    }

    /// Whether a joint has backlash, which the response does not contain.
    pub(in crate::kernel::lanes) fn has_backlash(&self) -> bool {
        !self.gaps.is_empty()
    }

    /// Frames of the flange at the joint positions set.
    pub(in crate::kernel::lanes) fn flange(&self) -> &FramePlanes<f64> {
        &self.frames[self.frames.len() - 2]
    }

    /// Computes the response of the tool; that to moments only if `MOMENTS`, its parts if `PARTS`.
    pub(in crate::kernel::lanes) fn respond<const MOMENTS: bool, const PARTS: bool>(&mut self) {
        if PARTS || self.compensated.is_some() || !self.curves.is_empty() {
            self.add_up::<MOMENTS, true>();
        } else {
            self.add_up::<MOMENTS, false>();
        }
    }

    fn add_up<const MOMENTS: bool, const PARTS: bool>(&mut self) {
        let WholeModel {
            model,
            backend,
            frames,
            parts,
            curves,
            compensated,
            response,
            still,
            ..
        } = self;
        backend.run(FindParts::<f64, MOMENTS, PARTS> {
            model,
            frames,
            parts,
            response,
        });
        if let (Some(constants), Some(compensated)) = (&model.compensator, compensated) {
            backend.run(AddCompensated::<f64, MOMENTS> {
                model,
                constants,
                compensated,
                frames,
                parts,
                response,
            });
        }
        backend.run(AddStill {
            model,
            response,
            still,
        });
        if !curves.is_empty() {
            backend.run(FindSag {
                model,
                parts,
                curves,
                still,
            });
        }
    }

    /// Prepares the response to these wrenches (at the TCP, base), after [`WholeModel::respond`]; their moments act only
    /// if `MOMENTS`.
    pub(in crate::kernel::lanes) fn load<const MOMENTS: bool>(&mut self, wrench: &Planes<f64, 6>) {
        if !self.curves.is_empty() {
            *self.wrench = *wrench;
            self.turn::<MOMENTS>();
        }
    }

    /// [`WholeModel::load`] with the same wrench at every point.
    fn load_all<const MOMENTS: bool>(&mut self, wrench: &Wrench) {
        if !self.curves.is_empty() {
            let values = wrench.force.iter().chain(wrench.moment.iter());
            for (plane, value) in self.wrench.iter_mut().zip(values) {
                plane.fill(*value);
            }
            self.turn::<MOMENTS>();
        }
    }

    /// Adds what joints with torque curves do under the wrench in memory to the displacement without load.
    fn turn<const MOMENTS: bool>(&mut self) {
        *self.rest = self.still.sum;
        self.backend.run(AddTurns::<f64, MOMENTS> {
            arm: Curved {
                model: &self.model,
                frames: &self.frames,
                parts: &self.parts,
                curves: &self.curves,
            },
            wrench: &self.wrench,
            sum: &mut self.rest,
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
        if have_moments(cases) {
            self.envelope_of::<true, false>(cases, plane, out);
        } else {
            self.envelope_of::<false, false>(cases, plane, out);
        }
    }

    /// The envelope; with the parts and the offsets of links that shares need if `DETAILS`.
    fn envelope_of<const MOMENTS: bool, const DETAILS: bool>(
        &mut self,
        cases: &[Wrench],
        plane: &[Vector3<f64>; 3],
        out: &mut WholeAnswers,
    ) {
        if DETAILS || !self.gaps.is_empty() {
            self.respond::<MOMENTS, true>();
        } else {
            self.respond::<MOMENTS, false>();
        }
        for (case, (wrench, deviation)) in cases.iter().zip(&mut out.deviations).enumerate() {
            self.load_all::<MOMENTS>(wrench);
            let of_case = CaseOnPlane { case, wrench, plane };
            self.take::<MOMENTS, DETAILS>(of_case, cases.len(), deviation, &mut out.worst);
        }
    }

    /// The deviation under one of `count` load cases, taken into the worst so far.
    fn take<const MOMENTS: bool, const DETAILS: bool>(
        &mut self,
        of_case: CaseOnPlane<'_>,
        count: usize,
        deviation: &mut Planes<f64, 3>,
        worst: &mut Worst<f64>,
    ) {
        let CaseOnPlane { case, wrench, plane } = of_case;
        let (response, rest) = self.response();
        if self.gaps.is_empty() {
            self.backend.run(OneCase::<f64, MOMENTS> {
                response,
                rest,
                cases: case..count,
                wrench,
                plane,
                deviation,
                worst,
            });
            return;
        }
        self.backend.run(OneWrench::<f64, MOMENTS> {
            response,
            rest,
            wrench,
            deviation,
        });
        let WholeModel {
            model,
            backend,
            frames,
            parts,
            gaps,
            ..
        } = self;
        let arm = Worn {
            model,
            frames,
            parts,
            gaps,
        };
        settle::<DETAILS>(*backend, arm, of_case, deviation);
        backend.run(TakeCase {
            cases: case..count,
            force: wrench.force,
            moment: wrench.moment,
            plane,
            deviation,
            worst,
        });
        if DETAILS {
            backend.run(KeepOffsets {
                model,
                case,
                worst,
                gaps,
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
        if have_moments(cases) {
            self.answer_of::<true>(cases, plane, inputs, out);
        } else {
            self.answer_of::<false>(cases, plane, inputs, out);
        }
    }

    fn answer_of<const MOMENTS: bool>(
        &mut self,
        cases: &[Wrench],
        plane: &[Vector3<f64>; 3],
        inputs: &InputUncertainty,
        out: &mut WholeAnswers,
    ) {
        self.envelope_of::<MOMENTS, true>(cases, plane, out);
        if !self.shares {
            return;
        }
        let WholeModel {
            model,
            backend,
            frames,
            parts,
            gaps,
            curves,
            compensated,
            response,
            still,
            along,
            by_unit,
            ..
        } = self;
        let WholeAnswers {
            worst,
            shares,
            uncertainty: variance,
            ..
        } = out;
        let curved = Curved {
            model,
            frames,
            parts,
            curves,
        };
        let both = model.compensator.as_ref().zip(compensated.as_deref());
        let compensated = both.map(|(constants, compensated)| Compensated {
            model,
            constants,
            compensated,
            frames,
            parts,
            worst,
        });
        backend.run(FindShares::<f64, MOMENTS> {
            model,
            frames,
            parts,
            curved,
            compensated,
            still,
            plane,
            worst,
            along,
            by_unit,
            shares,
            variance,
        });
        backend.run(ShareBacklash {
            model,
            parts,
            gaps,
            along,
            shares,
            variance,
        });
        if !inputs.is_none() {
            backend.run(AddInputs::<f64, MOMENTS> {
                model,
                inputs,
                frames,
                parts,
                curved,
                compensated,
                response,
                worst,
                along,
                variance,
            });
        }
        backend.run(TakeRoot { of: variance });
    }
}

fn have_moments(cases: &[Wrench]) -> bool {
    cases.iter().any(|wrench| wrench.moment != Vector3::zeros())
}

#[cfg(test)]
mod tests;
