//! Gain of a change: how much less an objective is with it, and the standard uncertainty of this difference.
//!
//! ```text
//! G = J_0 - J_1        u^2(G) = sum over k of (G(x + l_k) - G(x))^2 + m^2 (J_0^2 + J_1^2)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `J_0`, `J_1` | objective before and after the change | m |
//! | `x`, `l_k` | inputs that both predictions share, and the change of the independent input k by its standard uncertainty ([`UncertainInput`]) | |
//! | `m` | model error: what no parameter explains differs from posture to posture | 1 |
//!
//! Two predictions for one arm are correlated: an arm that is softer than expected deviates more in both. The
//! uncertainty of their difference is therefore often much smaller, and sometimes larger, than that of each. The scatter
//! of repetitions is the same before and after and is not included.

use nalgebra::Vector3;

use super::posture_search::{Component, Objective};
use crate::kernel::{Answers, BranchChoice, Question};
use crate::map::along_postures;
use crate::path::{LoadedTrack, Track};
use crate::source::UncertainInput;
use crate::watch::{Cancelled, Watch};

/// Gain of a change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gain {
    /// Objective before, m.
    pub before: f64,
    /// Objective after, m.
    pub after: f64,
    /// Standard uncertainty of the difference, m; `None` where that of the compliances is not known.
    pub uncertainty: Option<f64>,
}

/// The smallest gain that justifies a change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastGain {
    /// Coverage factor: multiple of the standard uncertainty that the gain must exceed.
    pub coverage_factor: f64,
    /// Amount that it must exceed in any case, m.
    pub amount: f64,
    /// Amount that it must exceed where its uncertainty is not known, m.
    pub amount_if_unknown: f64,
}

impl LeastGain {
    /// Any gain at all.
    pub const ANY: LeastGain = LeastGain {
        coverage_factor: 0.0,
        amount: 0.0,
        amount_if_unknown: 0.0,
    };
}

impl Gain {
    /// The decrease of the objective, m.
    pub fn by(&self) -> f64 {
        self.before - self.after
    }

    /// The smallest gain that would be significant, m.
    pub fn required(&self, least: &LeastGain) -> f64 {
        let by_uncertainty = match self.uncertainty {
            Some(u) => least.coverage_factor * u,
            None => least.amount_if_unknown,
        };
        by_uncertainty.max(least.amount)
    }

    /// Whether the gain justifies the change.
    pub fn is_significant(&self, least: &LeastGain) -> bool {
        self.by() > self.required(least)
    }
}

/// The gain between two predictions for the arm of `question`: `predict` gives the objective (m) before and after, for
/// that arm and load, or with one input changed.
///
/// # Errors
/// Those of `predict`.
pub fn gain(
    question: &Question<'_>,
    mut predict: impl FnMut(&Question<'_>, Option<&UncertainInput>) -> Result<[f64; 2], Cancelled>,
) -> Result<Gain, Cancelled> {
    let [before, after] = predict(question, None)?;
    let inputs = UncertainInput::all(&question.arm, &question.uncertainty);
    let known = question.arm.has_known_uncertainty();
    if !known || !(before - after).is_finite() {
        return Ok(Gain {
            before,
            after,
            uncertainty: known.then_some(0.0),
        });
    }
    let model_error = question.arm.model.structure.model_error;
    let mut variance = (model_error * before).powi(2) + (model_error * after).powi(2);
    for input in &inputs {
        let changed = input.changed(&question.arm);
        let requested = Question {
            arm: changed.arm(question.arm.robot),
            ..*question
        };
        let [before_changed, after_changed] = predict(&requested, Some(input))?;
        let by = (before_changed - after_changed) - (before - after);
        // A change that makes a point unreachable has no derivative.
        if by.is_finite() {
            variance += by * by;
        }
    }
    Ok(Gain {
        before,
        after,
        uncertainty: Some(variance.sqrt()),
    })
}

/// A path as it is followed.
#[derive(Clone, Copy, Debug)]
pub struct FollowedTrack<'a> {
    /// The path under its load.
    pub path: LoadedTrack<'a>,
    /// The branches, each from the point with that index on.
    pub choices: &'a [(usize, BranchChoice)],
    /// Home positions of the redundant joints; `None`: those of the question.
    pub home: Option<&'a [f64]>,
}

impl FollowedTrack<'_> {
    /// The objective along it, m.
    pub(super) fn objective(
        &self,
        question: &Question<'_>,
        (component, objective): (Component, Objective),
        input: Option<&UncertainInput>,
        watch: Watch<'_>,
    ) -> Result<f64, Cancelled> {
        let LoadedTrack { track, load } = self.path;
        let load = match input {
            Some(UncertainInput::LoadSize(by)) => load.scaled(1.0 + by),
            Some(UncertainInput::Force(by)) => load.with_force(*by, &track.base_from_part),
            _ => load.clone(),
        };
        let question = &Question {
            home: self.home.or(question.home),
            ..*question
        };
        let along = along_postures(question, track, load, self.choices.to_vec(), watch)?;
        Ok(objective.along(component, track, &along.answers))
    }
}

/// The gain between two ways to follow a path, over the points that both reach.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// Those of [`along_postures`].
pub fn gain_along(
    question: &Question<'_>,
    [before, after]: [FollowedTrack<'_>; 2],
    measure: (Component, Objective),
    watch: Watch<'_>,
) -> Result<Gain, Cancelled> {
    let quiet = Watch {
        finished: &|_| (),
        ..watch
    };
    gain(question, |question, input| {
        Ok([
            before.objective(question, measure, input, quiet)?,
            after.objective(question, measure, input, quiet)?,
        ])
    })
}

impl Component {
    /// The largest of these deviations (m, base) at point `index` of `track`, in this component.
    pub(super) fn largest(self, track: &Track, index: usize, deviations: &[Vector3<f64>]) -> f64 {
        let [first, second] = self.along(track, index, track.stop(index).normal);
        let size = |deviation: &Vector3<f64>| deviation.dot(&first).hypot(deviation.dot(&second));
        deviations.iter().map(size).fold(0.0, f64::max)
    }
}

impl Objective {
    /// Its value along `track` with these answers, m: over the points that are reached.
    pub fn along(self, component: Component, track: &Track, answers: &Answers) -> f64 {
        let (mut worst, mut sum, mut above, mut count) = (0.0f64, 0.0, 0.0, 0);
        for (index, _) in answers.evaluations() {
            let largest = component.largest(track, index, answers.deviations_at(index));
            worst = worst.max(largest);
            sum += largest;
            if let Objective::Above(tolerance) = self {
                above += (largest - tolerance).max(0.0);
            }
            count += 1;
        }
        let count = f64::from(count.max(1));
        match self {
            Objective::Worst => worst,
            Objective::Mean => sum / count,
            Objective::Above(_) => above / count,
        }
    }
}

#[cfg(test)]
mod tests;
