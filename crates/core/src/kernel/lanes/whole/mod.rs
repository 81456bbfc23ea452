//! The whole model in lanes: any chain at known joint positions, springs, torque curves, masses, compensator, geometry,
//! thermal growth, backlash.
//!
//! The same sum as `predict.rs`, a block of points at a time. Loops over parts are outside, loops over points inside:
//! only the latter become vectors.
//!
//! In reading order: `chain` (frames of the links), `curve_angles` and `model` (constants of an arm and its parts),
//! `parts` (screws and torques of gravity), `compensator` (a spring against gravity), `sum` (the displacements),
//! `curves` (joints whose stiffness depends on their torque), `backlash` (sides of the links), `answer` (the worst case,
//! shares, uncertainty), `inputs` (uncertainty by load and tool, in `input_order`), `cases` (all load cases of a
//! question). [`WholeModel`] runs them.
//!
//! Not known: a load-dependent equilibrium, a torque curve on the joint of the compensator, curves of more than 34 pairs,
//! more than eight joints with backlash. Such arms are computed one point after the other.

mod answer;
mod backlash;
mod cases;
mod chain;
mod compensator;
mod curve_angles;
mod curves;
mod input_order;
mod inputs;
mod model;
mod parts;
mod sum;

use crate::kernel::lanes::load::Worst;
use crate::numbers::{BLOCK, Backend, Plane, Planes, planes};
use crate::source::Arm;
use crate::spatial::Wrench;
pub(in crate::kernel::lanes) use answer::TakeRoot;
use backlash::{GapPlanes, gaps_of};
use chain::FindTool;
pub(in crate::kernel::lanes) use chain::{ChainConstants, Displacement, FindFlange, FindFrames, FramePlanes};
use compensator::{AddCompensated, CompensatorPlanes, FindCompensation};
use curves::{AddTurns, CurvePlanes, Curved, FindSag, curves_of};
use model::ModelConstants;
pub(in crate::kernel::lanes) use parts::ResponsePlanes;
use parts::{FindParts, PartPlanes};
use sum::StillPlanes;
pub(in crate::kernel::lanes) use sum::under;
use sum::{AddStill, FindUnloaded};

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

#[cfg(test)]
mod tests;
