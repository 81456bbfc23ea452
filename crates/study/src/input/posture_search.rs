//! `posture.search`: spins of the tool and branches to search along a path, and the objective.

use armill_core::optimize::{Component, Objective, PostureSearch, Steps};
use armill_core::robot::{BranchPattern, Robot};
use armill_core::units::{from_deg, from_per_mm};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::input::freedoms::{self, AxisTable, LeanTable, ToolEnd};
use crate::input::problem_log::ProblemLog;

/// The search for the best spin of the tool and branch along a path.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SearchTable {
    /// First and last spin of the tool about its axis, relative to its present one; -180 to 180 if left out.
    #[schemars(inner(range(min = -720.0, max = 720.0)))]
    pub turns_deg: Option<[f64; 2]>,
    /// Step between spins; 5 if left out.
    #[schemars(range(min = 0.1, max = 180.0))]
    pub step_deg: Option<f64>,
    /// Component of the deviation that is evaluated; `in-plane` if left out.
    pub component: Option<ComponentName>,
    /// The objective; `worst` if left out.
    pub objective: Option<ObjectiveName>,
    /// Largest change of spin along the path; 1 if left out.
    #[schemars(range(min = 1e-6, max = 1e3))]
    pub turn_deg_per_mm: Option<f64>,
    /// Least angle by which the wrist is bent; 3 if left out.
    #[schemars(range(min = 0.0, max = 80.0))]
    pub least_wrist_deg: Option<f64>,
    /// Least distance of every joint from its limits; 0 if left out.
    #[schemars(range(min = 0.0, max = 90.0))]
    pub margin_deg: Option<f64>,
    /// Penalty for the reversal of a joint: as much as this additional deviation over 1 mm of the path; 0 if left out.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub reversal_um_mm: Option<f64>,
    /// Lean of the tool about the programmed axis; none if left out.
    pub lean: Option<LeanTable>,
    /// External axes that move along the path; if left out, they stay at `home_deg`.
    #[serde(default)]
    pub axes: Vec<AxisTable>,
}

/// Component of the deviation that is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ComponentName {
    /// Across the tool.
    InPlane,
    /// Across tool and feed: relevant for walls.
    CrossTrack,
    /// Along the tool: relevant for floors.
    Axial,
}

/// The objective: the quantity to minimise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ObjectiveName {
    /// The largest deviation along the path.
    Worst,
    /// The mean of its points.
    Mean,
    /// The excess over the tolerance.
    AboveTolerance,
}

impl ObjectiveName {
    /// As the core knows it; `tolerance` in m.
    pub fn objective(self, tolerance: f64) -> Objective {
        match self {
            ObjectiveName::Worst => Objective::Worst,
            ObjectiveName::Mean => Objective::Mean,
            ObjectiveName::AboveTolerance => Objective::Above(tolerance),
        }
    }
}

impl ComponentName {
    /// As the core knows it.
    pub fn component(self) -> Component {
        match self {
            ComponentName::InPlane => Component::InPlane,
            ComponentName::CrossTrack => Component::CrossTrack,
            ComponentName::Axial => Component::Axial,
        }
    }
}

/// A change of spin must reduce the deviation by this fraction of the tolerance for each step.
const TURN_PRICE: f64 = 1e-3;

/// Turns of a full circle that miss it by less than this (deg) are one.
const FULL: f64 = 1e-9;

impl SearchTable {
    /// Whether no key is given.
    pub fn is_empty(&self) -> bool {
        self.turns_deg.is_none()
            && self.step_deg.is_none()
            && self.component.is_none()
            && self.objective.is_none()
            && self.turn_deg_per_mm.is_none()
            && self.least_wrist_deg.is_none()
            && self.margin_deg.is_none()
            && self.reversal_um_mm.is_none()
            && self.lean.is_none()
            && self.axes.is_empty()
    }

    /// As the core searches, for a path whose tolerance is `tolerance` (m), in branches that match `branches`; `None` where
    /// it has problems, reported at their keys.
    pub fn resolve(
        &self,
        log: &mut ProblemLog<'_>,
        tolerance: f64,
        branches: BranchPattern,
    ) -> Option<PostureSearch> {
        let report = |(message, hint): (String, &str)| log.problem("posture.search.turns_deg", message, hint);
        self.search(tolerance, branches).map_err(report).ok()
    }

    /// [`SearchTable::resolve`] with the freedoms of an arm along a path.
    pub fn resolve_along(
        &self,
        log: &mut ProblemLog<'_>,
        tolerance: f64,
        branches: BranchPattern,
        (robot, tool): (Option<&Robot>, ToolEnd),
    ) -> Option<PostureSearch> {
        let search = self.resolve(log, tolerance, branches);
        let lean = self.lean.as_ref().map(|table| freedoms::lean(log, table, tool));
        let axes = robot.map(|robot| freedoms::axes(log, &self.axes, robot));
        Some(PostureSearch {
            lean: match lean {
                Some(found) => Some(found?),
                None => None,
            },
            axes: axes.unwrap_or_default()?,
            ..search?
        })
    }

    /// The same, or what is wrong with the turns, and a hint.
    pub fn search(
        &self,
        tolerance: f64,
        branches: BranchPattern,
    ) -> Result<PostureSearch, (String, &'static str)> {
        let [first, last] = self.turns_deg.unwrap_or([-180.0, 180.0]);
        let step = self.step_deg.unwrap_or(5.0);
        if !(first <= last && last - first <= 360.0 + FULL) {
            let message = format!("turns range from {first} to {last} deg");
            return Err((
                message,
                "the first, then the last, at most 360 deg apart, such as -90 and 90",
            ));
        }
        let steps = ((last - first) / step + FULL).floor();
        // The last turn of a full circle is its first.
        let full = last - first > 360.0 - FULL && (steps * step - 360.0).abs() < FULL;
        let count = steps as usize + usize::from(!full);
        Ok(PostureSearch {
            spins: Steps {
                first: from_deg(first),
                step: from_deg(step),
                count,
            },
            lean: None,
            axes: Vec::new(),
            component: self.component.unwrap_or(ComponentName::InPlane).component(),
            objective: self
                .objective
                .unwrap_or(ObjectiveName::Worst)
                .objective(tolerance),
            branches,
            turn_rate: from_per_mm(from_deg(self.turn_deg_per_mm.unwrap_or(1.0))),
            turn_price: TURN_PRICE * tolerance,
            back_price: self.reversal_um_mm.unwrap_or(0.0) * 1e-9,
            wrist: from_deg(self.least_wrist_deg.unwrap_or(3.0)),
            margin: from_deg(self.margin_deg.unwrap_or(0.0)),
        })
    }
}
