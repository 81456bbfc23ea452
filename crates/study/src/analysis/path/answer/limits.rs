//! The process limits of a path, in the answer: the least over its points, each with its line.
//!
//! A force is permitted alone, in place of the load of the study; a depth or feed with everything else as the study
//! cuts. Lengths are in mm, forces in N, as given next to each value.

use armill_core::map::{CutLimits, Permitted, PermittedForces, PointLimits};
use armill_core::units::to_mm;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::number::without_rounding;

/// The process limits that meet the tolerance on a whole program: the least of its points.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LimitsAnswer {
    /// Points that were evaluated: spread over the path, the worst among them.
    pub points: usize,
    /// Force permitted in every direction.
    pub any_direction: Option<LimitAnswer>,
    /// Force along the feed.
    pub along: Option<LimitAnswer>,
    /// Force across it.
    pub cross: Option<LimitAnswer>,
    /// Force along the tool.
    pub axial: Option<LimitAnswer>,
    /// Axial depth of the cut, everything else as in the study.
    pub axial_depth: Option<LimitAnswer>,
    /// Radial depth; none of a slot.
    pub radial_depth: Option<LimitAnswer>,
    /// Feed per tooth.
    pub feed_per_tooth: Option<LimitAnswer>,
}

/// A limit, and the line that determines it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LimitAnswer {
    /// Its value.
    // unit: the one in the field `unit`
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// `up to`, `at least` (larger values were not evaluated), or `nothing`.
    pub verdict: &'static str,
    /// Line of the program that permits no more.
    pub line: u32,
}

impl LimitsAnswer {
    /// `None` if it was not requested, or cannot be computed: of a model that changes with the load.
    pub fn of(analysis: &PathAnalysis, found: &PathResult) -> Option<LimitsAnswer> {
        let limits = found.limits.as_ref()?;
        let line = |point: &PointLimits| analysis.track.path.points[point.index].line;
        let force = |of: fn(&PermittedForces) -> f64| {
            let points = limits.points.iter();
            let least = points.min_by(|a, b| of(&a.forces).total_cmp(&of(&b.forces)))?;
            Some(LimitAnswer {
                value: without_rounding(of(&least.forces)),
                unit: "N",
                verdict: "up to",
                line: line(least),
            })
        };
        let cut = |part: fn(&CutLimits) -> Option<Permitted>| {
            limits.least(part).map(|(point, permitted)| LimitAnswer {
                value: to_mm(permitted.value()),
                unit: "mm",
                verdict: verdict(permitted),
                line: line(point),
            })
        };
        Some(LimitsAnswer {
            points: limits.points.len(),
            any_direction: force(|forces| forces.weakest),
            along: force(|forces| forces.along),
            cross: force(|forces| forces.across),
            axial: force(|forces| forces.normal),
            axial_depth: cut(|cut| Some(cut.depth)),
            radial_depth: cut(|cut| cut.width),
            feed_per_tooth: cut(|cut| Some(cut.feed_per_tooth)),
        })
    }
}

/// In one word.
pub(crate) fn verdict(permitted: Permitted) -> &'static str {
    match permitted {
        Permitted::UpTo(_) => "up to",
        Permitted::AtLeast(_) => "at least",
        Permitted::Nothing => "nothing",
    }
}
