//! `posture.search`: which turns of the tool and branches are tried along a path, and what of the deviation shall be least.

use armill_core::optimize::{Component, Objective, PostureSearch, Spins};
use armill_core::robot::BranchPattern;
use schemars::JsonSchema;
use serde::Deserialize;

use super::places::Places;
use super::resolve::{Study, Subject};
use crate::StudyError;

/// The best turn of the tool and branch along a path, in place of those of the study.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SearchTable {
    /// First and last turn of the tool about its axis, beside the one it has; -180 to 180 if left out.
    #[schemars(inner(range(min = -720.0, max = 720.0)))]
    pub turns_deg: Option<[f64; 2]>,
    /// From one turn to the next; 5 if left out.
    #[schemars(range(min = 0.1, max = 180.0))]
    pub step_deg: Option<f64>,
    /// Which part of the deviation counts; `in-plane` if left out.
    pub component: Option<ComponentName>,
    /// What shall be least; `worst` if left out.
    pub objective: Option<ObjectiveName>,
    /// How much the tool may turn along the path; 1 if left out.
    #[schemars(range(min = 1e-6, max = 1e3))]
    pub turn_deg_per_mm: Option<f64>,
    /// Least angle by which the wrist is bent; 3 if left out.
    #[schemars(range(min = 0.0, max = 80.0))]
    pub least_wrist_deg: Option<f64>,
    /// What a joint that turns back weighs: as much as so much more deviation over 1 mm of the path; 0 if left out.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub reversal_um_mm: Option<f64>,
}

/// Which part of the deviation counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ComponentName {
    /// Across the tool.
    InPlane,
    /// Across tool and feed: what walls get.
    CrossTrack,
    /// Along the tool: what floors get.
    Axial,
}

/// What shall be least.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ObjectiveName {
    /// The largest deviation along the path.
    Worst,
    /// The mean of its points.
    Mean,
    /// What is above the limit.
    AboveLimit,
}

impl ObjectiveName {
    /// As the core knows it; `limit` in m.
    pub fn objective(self, limit: f64) -> Objective {
        match self {
            ObjectiveName::Worst => Objective::Worst,
            ObjectiveName::Mean => Objective::Mean,
            ObjectiveName::AboveLimit => Objective::Above(limit),
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

/// A turn that gains less than this part of the tolerance a step is not worth it.
const TURN_PRICE: f64 = 1e-3;

/// Turns of a full circle that miss it by less than this (deg) are one.
const FULL: f64 = 1e-9;

impl SearchTable {
    /// Whether it says nothing.
    pub fn is_empty(&self) -> bool {
        self.turns_deg.is_none()
            && self.step_deg.is_none()
            && self.component.is_none()
            && self.objective.is_none()
            && self.turn_deg_per_mm.is_none()
            && self.least_wrist_deg.is_none()
            && self.reversal_um_mm.is_none()
    }

    /// As the core searches, for a path whose tolerance is `limit` (m), in branches that match `branches`; `None` where it
    /// has problems, told at their places.
    pub(super) fn resolve(
        &self,
        places: &mut Places<'_>,
        limit: f64,
        branches: BranchPattern,
    ) -> Option<PostureSearch> {
        let tell =
            |(message, hint): (String, &str)| places.problem("posture.search.turns_deg", message, hint);
        self.search(limit, branches).map_err(tell).ok()
    }

    /// The same, or what is wrong with the turns, and a hint.
    fn search(&self, limit: f64, branches: BranchPattern) -> Result<PostureSearch, (String, &'static str)> {
        let [first, last] = self.turns_deg.unwrap_or([-180.0, 180.0]);
        let step = self.step_deg.unwrap_or(5.0);
        if !(first <= last && last - first <= 360.0 + FULL) {
            let message = format!("turns from {first} to {last} deg");
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
            spins: Spins {
                first: first.to_radians(),
                step: step.to_radians(),
                count,
            },
            component: self.component.unwrap_or(ComponentName::InPlane).component(),
            objective: self.objective.unwrap_or(ObjectiveName::Worst).objective(limit),
            branches,
            turn_rate: self.turn_deg_per_mm.unwrap_or(1.0).to_radians() * 1e3,
            turn_price: TURN_PRICE * limit,
            back_price: self.reversal_um_mm.unwrap_or(0.0) * 1e-9,
            wrist: self.least_wrist_deg.unwrap_or(3.0).to_radians(),
        })
    }
}

impl Study {
    /// Lets turns of the tool and branches be searched for along every path: as `wanted` says, or without it as the study
    /// says, where it does, else with all that is usual; in the branches
    /// that the words of the study leave open.
    ///
    /// # Errors
    /// A study without paths; turns that are none.
    pub fn search_postures(&mut self, requested: Option<&SearchTable>) -> Result<(), StudyError> {
        let usual = SearchTable::default();
        let mut paths = 0;
        for analysis in &mut self.analyses {
            let Subject::Path(path) = &mut analysis.subject else {
                continue;
            };
            paths += 1;
            let setting = &mut path.setting;
            let table = requested.or(setting.search.is_none().then_some(&usual));
            if let Some(table) = table {
                let search = table.search(setting.limit, setting.open);
                let search = search.map_err(|(message, hint)| StudyError::value(message, hint))?;
                setting.search = Some(search);
            }
        }
        if paths == 0 {
            let message = "the study asks for no path, along which the tool could be turned";
            return Err(StudyError::value(
                message,
                "[[analysis]] kind = \"path\" with a program or a shape",
            ));
        }
        Ok(())
    }
}
