//! Sensitivity of an objective along a path to each uncertain input, and the gain between two paths that share only
//! some of these inputs: two robots for one part, two tools of one robot.
//!
//! ```text
//! G = J_a - J_b       u^2(G) = sum over shared k of (d_ak - d_bk)^2 + sum over others of (d_ak^2 + d_bk^2) + m_a^2 J_a^2 + m_b^2 J_b^2
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `J_a`, `J_b` | objectives | m |
//! | `d_k` | change of an objective where input k changes by its standard uncertainty | m |
//! | `m` | model error, see [`super::gain`](fn@super::gain) | 1 |
//!
//! Load and length of the tool are shared by all cells that cut the same part with the same tool. Compliances, backlash
//! and growth are shared by cells of one robot only.

use super::gain::{FollowedTrack, Gain};
use super::posture_search::{Component, Objective};
use crate::kernel::Question;
use crate::source::UncertainInput;
use crate::watch::{Cancelled, Watch};

/// An input, by its place among those of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputKind {
    /// Compliances that are known with one common uncertainty.
    Compliance(usize),
    /// Backlash of a joint.
    Backlash(usize),
    /// The mass of this index.
    Mass(usize),
    /// Growth of the links.
    Thermal,
    /// The learnt residual along one of its axes.
    Learnt(usize),
    /// An independent input of the geometry.
    Geometry(usize),
    /// Position of the TCP along the tool axis.
    ToolLength,
    /// Size of the load.
    LoadSize,
    /// A force added to every load case.
    Force(usize),
}

/// Which inputs two predictions share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SharedInputs {
    /// All: one robot.
    OneRobot,
    /// Those of load and tool: two robots.
    LoadAndTool,
}

/// An objective and its change by each input.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The objective, m.
    pub value: f64,
    /// Its changes, m.
    pub changes: Vec<(InputKind, f64)>,
    /// Its standard uncertainty from inputs that no other prediction shares, m.
    pub by_itself: f64,
    /// Whether uncertainties of compliances are known.
    pub is_known: bool,
}

/// The sensitivity of an objective along a path.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// Those of [`crate::map::along_postures`].
pub fn sensitivity(
    question: &Question<'_>,
    followed: &FollowedTrack<'_>,
    measure: (Component, Objective),
    watch: Watch<'_>,
) -> Result<Sensitivity, Cancelled> {
    let quiet = Watch {
        finished: &|_| (),
        ..watch
    };
    let value = followed.objective(question, measure, None, quiet)?;
    let mut found = Sensitivity {
        value,
        changes: Vec::new(),
        by_itself: question.arm.model.structure.model_error * value,
        is_known: false,
    };
    let (mut compliances, mut forces) = (0, 0);
    for input in &UncertainInput::all(&question.arm, &question.uncertainty) {
        let kind = match input {
            UncertainInput::Compliances(_) => {
                compliances += 1;
                InputKind::Compliance(compliances)
            }
            UncertainInput::Backlash(joint, _) => InputKind::Backlash(*joint),
            UncertainInput::Mass(mass, _) => InputKind::Mass(*mass),
            UncertainInput::Thermal(_) => InputKind::Thermal,
            UncertainInput::Learnt(component) => InputKind::Learnt(*component),
            UncertainInput::Geometry(input) => InputKind::Geometry(*input),
            UncertainInput::ToolLength(_) => InputKind::ToolLength,
            UncertainInput::LoadSize(_) => InputKind::LoadSize,
            UncertainInput::Force(_) => {
                forces += 1;
                InputKind::Force(forces)
            }
        };
        let changed = input.changed(&question.arm);
        let requested = Question {
            arm: changed.arm(question.arm.robot),
            ..*question
        };
        let by = followed.objective(&requested, measure, Some(input), quiet)? - value;
        if by.is_finite() {
            found.changes.push((kind, by));
        }
    }
    found.is_known = compliances > 0;
    Ok(found)
}

impl Sensitivity {
    /// The gain from `other` to this: how much less this objective is.
    pub fn gain_over(&self, other: &Sensitivity, shared: SharedInputs) -> Gain {
        let is_shared = |kind: InputKind| match kind {
            InputKind::ToolLength | InputKind::LoadSize | InputKind::Force(_) => true,
            InputKind::Compliance(_)
            | InputKind::Backlash(_)
            | InputKind::Mass(_)
            | InputKind::Thermal
            | InputKind::Learnt(_)
            | InputKind::Geometry(_) => shared == SharedInputs::OneRobot,
        };
        let in_other = |kind: InputKind| {
            let found = other.changes.iter().find(|(there, _)| *there == kind);
            found.filter(|_| is_shared(kind)).map_or(0.0, |(_, by)| *by)
        };
        let mine = self.changes.iter().map(|(kind, by)| by - in_other(*kind));
        let is_in_both =
            |kind: InputKind| is_shared(kind) && self.changes.iter().any(|(here, _)| *here == kind);
        let others = other.changes.iter().filter(|(kind, _)| !is_in_both(*kind));
        let all = mine.chain(others.map(|(_, by)| *by));
        let alone = self.by_itself.hypot(other.by_itself);
        Gain {
            before: other.value,
            after: self.value,
            uncertainty: (self.is_known && other.is_known).then(|| all.fold(alone, f64::hypot)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(value: f64, compliance: f64, load: f64) -> Sensitivity {
        Sensitivity {
            value,
            changes: vec![
                (InputKind::Compliance(1), compliance),
                (InputKind::LoadSize, load),
            ],
            by_itself: 0.0,
            is_known: true,
        }
    }

    #[test]
    fn robots_share_the_load_and_not_their_compliances() {
        let (a, b) = (of(10.0, 3.0, 2.0), of(14.0, 4.0, 2.0));
        let two = a.gain_over(&b, SharedInputs::LoadAndTool);
        assert!((two.by() - 4.0).abs() < 1e-12);
        // 3 and 4 are independent, 2 and 2 cancel.
        assert!((two.uncertainty.unwrap() - 5.0).abs() < 1e-12);
        let one = a.gain_over(&b, SharedInputs::OneRobot);
        assert!((one.uncertainty.unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn an_input_of_one_prediction_alone_is_included() {
        let mut a = of(10.0, 3.0, 2.0);
        a.changes.pop();
        let b = of(14.0, 4.0, 12.0);
        let u = |a: &Sensitivity, b: &Sensitivity| a.gain_over(b, SharedInputs::LoadAndTool).uncertainty;
        assert!((u(&a, &b).unwrap() - 13.0).abs() < 1e-12);
        assert!((u(&b, &a).unwrap() - 13.0).abs() < 1e-12);
        a.is_known = false;
        assert_eq!(u(&a, &b), None);
    }
}
