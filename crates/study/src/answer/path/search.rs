//! What the search for turns of the tool and branches has brought: the path before and after.
//!
//! `turn_range_deg` counts from the turn that the tool has without the search. Points that are lost have no posture inside
//! limits and away from singularities at any turn; the path is answered there as if they had.

use armill_core::kernel::{Answers, Stand};
use armill_core::optimize::{Component, Objective, reversals};
use armill_core::path::PathPoint;
use schemars::JsonSchema;
use serde::Serialize;

use super::super::sentence::micrometres;
use crate::file::path::PathAnalysis;
use crate::number::decimals;
use crate::run::PathFound;

/// Turns and branches that were searched for along a path.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SearchAnswer {
    /// Which part of the deviation counted: `in-plane`, `cross-track`, `axial`.
    pub component: &'static str,
    /// What was to be least: `worst`, `mean`, `above-tolerance`.
    pub objective: &'static str,
    /// Turns that were tried at each point.
    pub turns: usize,
    /// Least and greatest turn of the tool that was chosen, beside the one it has without.
    pub turn_range_deg: [f64; 2],
    /// The path without the search.
    pub without: StatisticsAnswer,
    /// The path with what was found.
    pub with: StatisticsAnswer,
    /// Stretches of the path where no turn and branch stands, and why.
    pub lost: Vec<LostAnswer>,
    /// Lines at which the arm has to stop and take another posture.
    pub breaks: Vec<u32>,
}

/// A path in some numbers.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct StatisticsAnswer {
    /// Largest in-plane deviation.
    pub max_in_plane_um: Option<f64>,
    /// Mean of the points.
    pub mean_in_plane_um: Option<f64>,
    /// Points within the limit over all points.
    pub fraction_within: f64,
    /// Points without posture.
    pub unreachable: usize,
    /// Points with a posture outside joint limits.
    pub outside_joint_limits: usize,
    /// Points near a singularity.
    pub near_singularity: usize,
    /// Times that each joint turns back.
    pub reversals: Vec<usize>,
}

/// Points that follow on each other without a posture that stands.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct LostAnswer {
    /// Line of the first.
    pub first_line: u32,
    /// Line of the last.
    pub last_line: u32,
    /// How many.
    pub points: usize,
    /// What stands in the way of most turns and branches of the first.
    pub reason: &'static str,
}

impl SearchAnswer {
    /// What was found along this path; `None` where nothing was searched for.
    pub(super) fn of(analysis: &PathAnalysis, found: &PathFound) -> Option<SearchAnswer> {
        let (search, searched) = (analysis.setting.search.as_ref()?, found.searched.as_ref()?);
        let spins = searched.posture.spins.iter().map(|spin| spin.to_degrees());
        let least = spins.clone().fold(f64::INFINITY, f64::min);
        let points = &analysis.track.path.points;
        Some(SearchAnswer {
            component: counts_word(search.component),
            objective: goal_word(search.objective),
            turns: search.spins.count,
            turn_range_deg: [least, spins.fold(f64::NEG_INFINITY, f64::max)],
            without: StatisticsAnswer::of(analysis, &searched.as_asked),
            with: StatisticsAnswer::of(analysis, &found.along.answers),
            lost: lost(points, &searched.posture.lost),
            breaks: searched
                .posture
                .breaks
                .iter()
                .map(|index| points[*index].line)
                .collect(),
        })
    }

    /// What it has brought, a sentence.
    pub fn sentence(&self) -> String {
        let worst = |of: &StatisticsAnswer| match of.max_in_plane_um {
            Some(um) => format!("{} µm", micrometres(um)),
            None => "nothing".to_owned(),
        };
        let turned = self.turn_range_deg.map(|deg| format!("{:.0}", decimals(deg, 0)));
        let [from, to] = &turned;
        let turn = if from == to {
            format!("turned by {from} deg")
        } else {
            format!("turned by {from} to {to} deg")
        };
        let share = |of: &StatisticsAnswer| format!("{:.1} %", 100.0 * of.fraction_within);
        let backs = |of: &StatisticsAnswer| of.reversals.iter().sum::<usize>();
        format!(
            "{turn}, the tool deviates by at most {} where it deviated by {}; {} of the points hold the limit, {} before; joints turn back {} times, {} before",
            worst(&self.with),
            worst(&self.without),
            share(&self.with),
            share(&self.without),
            backs(&self.with),
            backs(&self.without)
        )
    }
}

impl StatisticsAnswer {
    /// Of a path answered so.
    pub fn of(analysis: &PathAnalysis, answers: &Answers) -> StatisticsAnswer {
        let evaluation = || answers.evaluation().map(|(_, evaluation)| evaluation);
        let count = evaluation().count();
        let within = evaluation().filter(|evaluation| evaluation.in_plane <= analysis.setting.limit).count();
        StatisticsAnswer {
            max_in_plane_um: answers.worst().map(|(_, evaluation)| evaluation.in_plane * 1e6),
            mean_in_plane_um: (count > 0)
                .then(|| evaluation().map(|evaluation| evaluation.in_plane).sum::<f64>() / count as f64 * 1e6),
            fraction_within: within as f64 / answers.points.len().max(1) as f64,
            unreachable: answers.points.len() - count,
            outside_joint_limits: evaluation().filter(|evaluation| !evaluation.within_limits()).count(),
            near_singularity: evaluation().filter(|evaluation| evaluation.singularity.is_some()).count(),
            reversals: reversals(&analysis.track.path, answers),
        }
    }
}

/// Points next to each other as one stretch each.
fn lost(points: &[PathPoint], lost: &[(usize, Stand)]) -> Vec<LostAnswer> {
    let stretches = lost.chunk_by(|(a, _), (b, _)| a + 1 == *b);
    let given = |stretch: &[(usize, Stand)]| {
        let [(first, stand), ..] = stretch else {
            return None;
        };
        let last = first + stretch.len() - 1;
        Some(LostAnswer {
            first_line: points[*first].line,
            last_line: points[last].line,
            points: stretch.len(),
            reason: stand.word(),
        })
    };
    stretches.filter_map(given).collect()
}

/// As the study calls it.
pub(crate) fn counts_word(component: Component) -> &'static str {
    match component {
        Component::InPlane => "in-plane",
        Component::CrossTrack => "cross-track",
        Component::Axial => "axial",
    }
}

/// As the study calls it.
pub(crate) fn goal_word(objective: Objective) -> &'static str {
    match objective {
        Objective::Worst => "worst",
        Objective::Mean => "mean",
        Objective::Above(_) => "above-tolerance",
    }
}
