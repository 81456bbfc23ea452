//! The cut of a series that is nearest to its limit, with the uncertainty of the limit and a second solution.
//!
//! The limit of mean directional factors is that of all points. Semi-discretisation is more accurate, and decides whether the programmed
//! cut is stable; the relative uncertainty is taken from the former.
//!
//! Units: m, rad/s. Theory: `docs/theory/stability.md`.

use armill_core::robot::Robot;
use armill_core::stability::named_mode::modes;
use armill_core::stability::{
    Boundary, BoundaryUncertainty, CutOfAnyDepth, NamedMode, PeriodSteps, discretisation,
};

use super::arm_modes::named_at_tip;
use crate::input::setting::Setting;
use crate::input::vibration::CutAtPoint;

/// The cut that is nearest to its limit.
#[derive(Clone, Debug)]
pub struct WorstCut {
    /// Index of its point.
    pub index: usize,
    /// The cut.
    pub cut: CutAtPoint,
    /// The modes there, feed frame.
    pub modes: Vec<NamedMode>,
    /// Limit by mean directional factors, with its uncertainty; none if it is deeper than what was sought.
    pub limit: Option<BoundaryUncertainty>,
    /// Limit by semi-discretisation; none if it is deeper than what was sought.
    pub exact: Option<Boundary>,
    /// Whether the programmed cut is stable by semi-discretisation.
    pub is_stable: bool,
}

impl WorstCut {
    /// Of the point with this index and cut, in the posture `q` (rad, m).
    pub(super) fn of(
        robot: &Robot,
        setting: &Setting,
        q: &[f64],
        index: usize,
        cut: CutAtPoint,
    ) -> Option<WorstCut> {
        let named = named_at_tip(robot, setting, q, &cut.base_from_feed)?;
        let any_depth = CutOfAnyDepth::new(&cut.milling);
        let deepest = cut.deepest_sought();
        let bare = modes(&named);
        let exact = discretisation::boundary(&bare, &any_depth, cut.spindle, deepest).ok()?;
        let programmed =
            discretisation::floquet(&bare, &cut.milling, cut.spindle, PeriodSteps::ByFastestMode);
        Some(WorstCut {
            index,
            limit: BoundaryUncertainty::at_speed(&named, &any_depth, cut.spindle, deepest).ok()?,
            modes: named,
            exact: exact.map(|(boundary, _)| boundary),
            is_stable: programmed.is_stable(),
            cut,
        })
    }

    /// Relative standard uncertainty of the limit; none if no input has one, or without a limit.
    pub fn relative_uncertainty(&self) -> Option<f64> {
        let of_depth = self.limit.as_ref()?.of_log_depth;
        (of_depth > 0.0).then_some(of_depth)
    }

    /// Probability that the programmed cut is stable, about the limit of semi-discretisation where there is one; none without an
    /// uncertainty.
    pub fn probability_stable(&self) -> Option<f64> {
        self.relative_uncertainty()?;
        let limit = self.limit.clone()?;
        let about = match self.exact {
            Some(exact) => limit.about(exact),
            None => limit,
        };
        Some(about.probability_stable(self.cut.milling.cut().depth))
    }

    /// The mode with the largest part in the limit, by name.
    pub fn cause(&self) -> Option<&str> {
        let limit = self.exact.or(self.limit.as_ref().map(|limit| limit.boundary))?;
        self.modes.get(limit.mode).map(|mode| mode.name.as_str())
    }
}
