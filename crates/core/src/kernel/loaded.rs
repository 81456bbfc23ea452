//! Points with a load each: a tool path, where forces turn with the feed.
//!
//! Of a model with the deviation `C w + g`, a point is evaluated under unit loads. `C` and `g` then apply to any
//! wrench, also to one that depends on the deflection of the tip. A model in which the load changes the arm is
//! evaluated under each wrench.

use nalgebra::{Matrix3, Vector3};

use super::answer::{AnswerDetail, Answers, Slot, Slots};
use super::general::General;
use super::question::Question;
use super::solver::{BLOCK, Order, Solver};
use crate::load::{InputUncertainty, TipCompliance};
use crate::path::Stop;
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// Answers `question` at `count` points one after the other, each under separate wrenches.
///
/// `stop(i)` gives the pose of the tool. `load(i, tip, wrenches)` writes the wrenches on the tool at the TCP, base
/// axes, as many as `question.cases`; their values, `normal` and `uncertainty` of the question are not used. `tip` is
/// the compliance of the tip for a force at this point, base; `None` for a model in which it depends on the load.
/// `load` is called in order, and only at points that are reached. Shares and uncertainties are not computed: use
/// [`super::evaluate`] at the points of interest.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the question has no load case.
pub fn evaluate_loaded(
    question: &Question<'_>,
    count: usize,
    stop: impl Fn(usize) -> Stop,
    load: impl FnMut(usize, Option<&TipCompliance>, &mut [Wrench]),
    watch: Watch<'_>,
) -> Result<Answers, Cancelled> {
    let question = Question {
        uncertainty: InputUncertainty::NONE,
        ..*question
    };
    assert!(
        !question.cases.is_empty(),
        "a question needs at least one load case"
    );
    let mut answers = Answers::new(&question, count, AnswerDetail::DeviationsAlone);
    let rows = Rows {
        answers: &mut answers,
        wrenches: vec![Wrench::ZERO; question.cases.len()],
    };
    if question.arm.model.is_affine() {
        rows.by_unit_loads(&question, stop, load, watch)?;
    } else {
        rows.one_by_one(&question, stop, load, watch)?;
    }
    Ok(answers)
}

/// Answers to be filled, and a buffer for the wrenches of a point.
struct Rows<'a> {
    answers: &'a mut Answers,
    wrenches: Vec<Wrench>,
}

impl Rows<'_> {
    fn by_unit_loads(
        mut self,
        question: &Question<'_>,
        stop: impl Fn(usize) -> Stop,
        mut load: impl FnMut(usize, Option<&TipCompliance>, &mut [Wrench]),
        watch: Watch<'_>,
    ) -> Result<(), Cancelled> {
        let units = unit_loads();
        let requested = Question {
            cases: &units,
            ..*question
        };
        let mut solver = Solver::new(&requested, Order::AlongPath, AnswerDetail::DeviationsAlone);
        let mut under_units = vec![Vector3::zeros(); BLOCK * units.len()];
        for (block, mut slots) in self.answers.blocks(BLOCK).into_iter().enumerate() {
            let first = block * BLOCK;
            let count = slots.points.len();
            let requested = Slots {
                points: &mut *slots.points,
                joints: &mut *slots.joints,
                deviations: &mut under_units[..count * units.len()],
                shares: &mut *slots.shares,
            };
            solver.answer(|i| stop(first + i).base_from_tool, requested, watch)?;
            for (i, under_units) in under_units.chunks(units.len()).take(count).enumerate() {
                let Slot {
                    point, deviations, ..
                } = slots.at(i);
                let Ok(evaluation) = point else { continue };
                let response = AffineResponse::of(under_units);
                load(first + i, Some(&response.tip), &mut self.wrenches);
                for (deviation, wrench) in deviations.iter_mut().zip(&self.wrenches) {
                    *deviation = response.under(wrench);
                }
                evaluation.take_envelope(deviations, stop(first + i).normal);
                evaluation.in_plane_uncertainty = None;
            }
        }
        Ok(())
    }

    fn one_by_one(
        mut self,
        question: &Question<'_>,
        stop: impl Fn(usize) -> Stop,
        mut load: impl FnMut(usize, Option<&TipCompliance>, &mut [Wrench]),
        watch: Watch<'_>,
    ) -> Result<(), Cancelled> {
        let mut general = General::new(question, AnswerDetail::DeviationsAlone);
        let mut before: Option<Vec<f64>> = None;
        let slots = self.answers.blocks(1).into_iter();
        for (index, mut slots) in slots.enumerate() {
            if watch.is_cancelled() {
                return Err(Cancelled);
            }
            load(index, None, &mut self.wrenches);
            let stop = stop(index);
            let requested = Question {
                cases: &self.wrenches,
                normal: stop.normal,
                home: question.home_at(index),
                ..*question
            };
            let Slot {
                point,
                joints,
                deviations,
                shares,
            } = slots.at(0);
            *point = general
                .answer(&requested, &stop.base_from_tool, before.as_deref())
                .inspect(|_| general.write(joints, deviations, shares))
                .inspect(|_| before = Some(joints.to_vec()));
            (watch.finished)(1);
        }
        Ok(())
    }
}

/// No load, then one newton along each base axis, then one newton metre about each.
fn unit_loads() -> [Wrench; 7] {
    let none = Wrench::ZERO;
    let force = |axis| Wrench::from_force(axis);
    let moment = |axis| Wrench { moment: axis, ..none };
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    [
        none,
        force(x),
        force(y),
        force(z),
        moment(x),
        moment(y),
        moment(z),
    ]
}

/// `delta = C_f f + C_m m + g`.
struct AffineResponse {
    /// `C_f` and `g`.
    tip: TipCompliance,
    by_moment: Matrix3<f64>,
}

impl AffineResponse {
    /// From the deviations under [`unit_loads`].
    fn of(deviations: &[Vector3<f64>]) -> AffineResponse {
        let unloaded = deviations[0];
        let columns =
            |first: usize| Matrix3::from_fn(|row, column| (deviations[first + column] - unloaded)[row]);
        AffineResponse {
            tip: TipCompliance {
                by_force: columns(1),
                unloaded,
            },
            by_moment: columns(4),
        }
    }

    fn under(&self, wrench: &Wrench) -> Vector3<f64> {
        self.tip.under(wrench.force) + self.by_moment * wrench.moment
    }
}

#[cfg(test)]
mod tests;
