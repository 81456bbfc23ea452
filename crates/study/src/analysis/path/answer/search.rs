//! The result of the search for spins of the tool and branches: the path before and after.
//!
//! `turn_range_deg` is relative to the spin that the tool has without the search. Unreachable points have no posture
//! inside limits and away from singularities at any spin; the path is evaluated there regardless.

use armill_core::kernel::{Answers, PostureStatus};
use armill_core::motion::Motion;
use armill_core::optimize::{Component, Objective, PostureFound, reversals};
use armill_core::path::{Lean, PathPoint, scallop};
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::analysis::words::micrometres;
use crate::joint_unit::JointUnit;
use crate::number::{decimals, without_rounding};
use crate::uncertainty_words::u_in_words;

/// The search for spins and branches along a path.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SearchAnswer {
    /// Component of the deviation that was minimised: `in-plane`, `cross-track`, `axial`.
    pub component: &'static str,
    /// The objective: `worst`, `mean`, `above-tolerance`.
    pub objective: &'static str,
    /// Spins that were tried at each point.
    pub turns: usize,
    /// Least and greatest chosen spin of the tool, relative to the one it has without the search.
    pub turn_range_deg: [f64; 2],
    /// Least and greatest chosen lean towards the feed; null if the tool may not lean.
    pub lead_range_deg: Option<[f64; 2]>,
    /// Least and greatest chosen lean to the left of the feed; null if the tool may not lean.
    pub tilt_range_deg: Option<[f64; 2]>,
    /// Greatest height of the scallops between passes; null if the tool may not lean, or its stepover is not given.
    pub scallop_um: Option<f64>,
    /// The external axes that may move, and how far they do.
    pub axes: Vec<MovedAxisAnswer>,
    /// Whether the path is followed with this result: where it has fewer obstacles, or the same number and a gain that
    /// exceeds `least_gain_um`.
    pub applied: bool,
    /// Points whose cut is not stable, without and with this result; none unless it must be stable (`must_be_stable`).
    pub unstable_points: Option<[usize; 2]>,
    /// Decrease of the objective by this result.
    pub gain_um: f64,
    /// Standard uncertainty of the gain, from the inputs that both predictions share; null if not known.
    pub gain_u_um: Option<f64>,
    /// The gain that would be significant.
    pub least_gain_um: f64,
    /// The path without the search.
    pub without: StatisticsAnswer,
    /// The path with the result of the search.
    pub with: StatisticsAnswer,
    /// Stretches of the path without a usable spin and branch, and why.
    pub unreachable_stretches: Vec<UnreachableStretch>,
    /// Lines at which the arm has to stop and change its posture.
    pub breaks: Vec<u32>,
}

/// An external axis that a search moves along a path.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MovedAxisAnswer {
    /// Name of its joint.
    pub joint: String,
    /// Least and greatest chosen position.
    // unit: that of `unit`
    pub range: [f64; 2],
    /// `mm` or `deg`.
    pub unit: &'static str,
}

/// Statistics of a path.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct StatisticsAnswer {
    /// Largest in-plane deviation.
    pub max_in_plane_um: Option<f64>,
    /// Mean of the points.
    pub mean_in_plane_um: Option<f64>,
    /// Points within the tolerance over all points.
    pub fraction_within: f64,
    /// Points without posture.
    pub unreachable: usize,
    /// Points with a posture outside joint limits.
    pub outside_joint_limits: usize,
    /// Points near a singularity.
    pub near_singularity: usize,
    /// Number of reversals of each joint.
    pub reversals: Vec<usize>,
    /// Duration of the program; none without `[motion]`.
    pub cycle_time_s: Option<f64>,
}

/// Consecutive points without a usable posture.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct UnreachableStretch {
    /// Line of the first.
    pub first_line: u32,
    /// Line of the last.
    pub last_line: u32,
    /// How many.
    pub points: usize,
    /// Why most spins and branches of the first are not usable.
    pub reason: &'static str,
}

impl SearchAnswer {
    /// The result along this path; `None` without a search.
    pub fn of(robot: &Robot, analysis: &PathAnalysis, found: &PathResult) -> Option<SearchAnswer> {
        let (search, searched) = (analysis.setting.search.as_ref()?, found.searched.as_ref()?);
        let posture = &searched.posture;
        let leans = posture.leans.as_ref().map(|(leans, _)| leans);
        let lean = |of: fn(&Lean) -> f64| {
            leans.map(|leans| range(leans.iter().map(of)).map(|angle| without_rounding(to_deg(angle))))
        };
        let points = &analysis.track.path.points;
        let followed = StatisticsAnswer::of(analysis, &found.along.answers, found.motion.as_ref());
        let other = StatisticsAnswer::of(analysis, &searched.other.answers, searched.other_motion.as_ref());
        let (without, with) = match searched.applied {
            true => (other, followed),
            false => (followed, other),
        };
        let gain = &searched.gain;
        Some(SearchAnswer {
            component: component_name(search.component),
            objective: objective_name(search.objective),
            turns: search.spins.count,
            turn_range_deg: range(posture.spins.iter().copied()).map(to_deg),
            lead_range_deg: lean(|lean| lean.lead),
            tilt_range_deg: lean(|lean| lean.tilt),
            scallop_um: posture.leans.as_ref().and_then(|(leans, end)| {
                let stepover = search.lean?.stepover?;
                let heights = leans.iter().filter_map(|lean| scallop(*end, *lean, stepover));
                heights.reduce(f64::max).map(to_um)
            }),
            axes: search
                .axes
                .iter()
                .map(|axis| MovedAxisAnswer::of(robot, axis.joint, posture))
                .collect(),
            applied: searched.applied,
            unstable_points: searched.unstable,
            gain_um: to_um(gain.by()),
            gain_u_um: gain.uncertainty.map(to_um),
            least_gain_um: to_um(gain.required(&analysis.setting.least_gain)),
            without,
            with,
            unreachable_stretches: unreachable_stretches(points, &searched.posture.unreachable),
            breaks: searched
                .posture
                .breaks
                .iter()
                .map(|index| points[*index].line)
                .collect(),
        })
    }

    /// The result, a sentence.
    pub fn sentence(&self) -> String {
        let worst = |of: &StatisticsAnswer| match of.max_in_plane_um {
            Some(um) => format!("{} µm", micrometres(um)),
            None => "not known".to_owned(),
        };
        let share = |of: &StatisticsAnswer| format!("{:.1} %", 100.0 * of.fraction_within);
        let backs = |of: &StatisticsAnswer| of.reversals.iter().sum::<usize>();
        let cycle_time = match (self.with.cycle_time_s, self.without.cycle_time_s) {
            (Some(with), Some(without)) => format!(", {with:.1} s instead of {without:.1} s"),
            _ => String::new(),
        };
        if !self.applied {
            return format!(
                "spin and branch are kept; the best ones found would give {}; largest deviation {} instead of {}, {} reversals of joints instead of {}{cycle_time}",
                self.gain_in_words(),
                worst(&self.with),
                worst(&self.without),
                backs(&self.with),
                backs(&self.without)
            );
        }
        format!(
            "tool spin of {}{}: {}; largest deviation {} instead of {}; {} of the points are within the tolerance, {} before; {} reversals of joints, {} before{cycle_time}",
            self.turn_in_words(),
            self.freedoms_in_words(),
            self.gain_in_words(),
            worst(&self.with),
            worst(&self.without),
            share(&self.with),
            share(&self.without),
            backs(&self.with),
            backs(&self.without)
        )
    }

    /// The spin of the tool, such as `-27 to 123 deg`.
    pub fn turn_in_words(&self) -> String {
        let [from, to] = self.turn_range_deg.map(|deg| format!("{:.0}", decimals(deg, 0)));
        match from == to {
            true => format!("{from} deg"),
            false => format!("{from} to {to} deg"),
        }
    }

    /// Lean and external axes, such as `, lead of 5 to 12 deg, rail at 120 to 900 mm`; empty without.
    pub fn freedoms_in_words(&self) -> String {
        let lean = [("lead", self.lead_range_deg), ("tilt", self.tilt_range_deg)];
        let leans = lean.into_iter().filter_map(|(name, range)| {
            let [from, to] = range.filter(|range| *range != [0.0; 2])?;
            Some(format!(", {name} of {from:.1} to {to:.1} deg"))
        });
        let axes = self.axes.iter().map(|axis| format!(", {}", axis.in_words()));
        leans.chain(axes).collect()
    }

    /// The gain, its uncertainty, and what would be significant.
    pub fn gain_in_words(&self) -> String {
        let of = match self.objective {
            "worst" => "the largest deviation",
            "mean" => "the mean deviation",
            _ => "the mean excess over the tolerance",
        };
        let by = micrometres(self.gain_um.abs());
        let change = match self.gain_um < 0.0 {
            true => format!("{by} µm more"),
            false => format!("a reduction by {by} µm"),
        };
        let u = u_in_words(self.gain_u_um);
        format!(
            "{change} in {of} ({u}; significant from {} µm)",
            micrometres(self.least_gain_um)
        )
    }
}

impl MovedAxisAnswer {
    fn of(robot: &Robot, joint: usize, posture: &PostureFound) -> MovedAxisAnswer {
        let homes = posture.homes.as_deref().unwrap_or_default();
        let positions = homes.chunks(robot.joints().len()).map(|home| home[joint]);
        let unit = JointUnit::of(robot, joint);
        MovedAxisAnswer {
            joint: robot.joints()[joint].name.clone(),
            range: range(positions).map(|at| without_rounding(at * unit.scale)),
            unit: unit.name,
        }
    }

    /// How far it moves, such as `rail at 120 to 900 mm`.
    fn in_words(&self) -> String {
        let [from, to] = self.range.map(|at| format!("{:.0}", decimals(at, 0)));
        let unit = self.unit;
        match from == to {
            true => format!("{} at {from} {unit}", self.joint),
            false => format!("{} at {from} to {to} {unit}", self.joint),
        }
    }
}

/// Least and greatest of these; zeros without any.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let [mut least, mut greatest] = [f64::INFINITY, f64::NEG_INFINITY];
    for value in values {
        least = least.min(value);
        greatest = greatest.max(value);
    }
    if least > greatest {
        [0.0; 2]
    } else {
        [least, greatest]
    }
}

impl StatisticsAnswer {
    /// The statistics of these answers along this path, with its motion if it was requested.
    pub fn of(analysis: &PathAnalysis, answers: &Answers, motion: Option<&Motion>) -> StatisticsAnswer {
        let evaluation = || answers.evaluations().map(|(_, evaluation)| evaluation);
        let count = evaluation().count();
        let within = evaluation()
            .filter(|evaluation| evaluation.in_plane <= analysis.setting.tolerance)
            .count();
        StatisticsAnswer {
            max_in_plane_um: answers.worst().map(|(_, evaluation)| to_um(evaluation.in_plane)),
            mean_in_plane_um: (count > 0).then(|| {
                to_um(evaluation().map(|evaluation| evaluation.in_plane).sum::<f64>() / count as f64)
            }),
            fraction_within: within as f64 / answers.points.len().max(1) as f64,
            unreachable: answers.points.len() - count,
            outside_joint_limits: evaluation()
                .filter(|evaluation| !evaluation.within_limits())
                .count(),
            near_singularity: evaluation()
                .filter(|evaluation| evaluation.singularity.is_some())
                .count(),
            reversals: reversals(&analysis.track.path, answers),
            cycle_time_s: motion.map(Motion::duration),
        }
    }
}

/// Consecutive points as one stretch each.
fn unreachable_stretches(points: &[PathPoint], lost: &[(usize, PostureStatus)]) -> Vec<UnreachableStretch> {
    let stretches = lost.chunk_by(|(a, _), (b, _)| a + 1 == *b);
    let given = |stretch: &[(usize, PostureStatus)]| {
        let [(first, status), ..] = stretch else {
            return None;
        };
        let last = first + stretch.len() - 1;
        Some(UnreachableStretch {
            first_line: points[*first].line,
            last_line: points[last].line,
            points: stretch.len(),
            reason: status.word(),
        })
    };
    stretches.filter_map(given).collect()
}

/// Its name in the study.
pub fn component_name(component: Component) -> &'static str {
    match component {
        Component::InPlane => "in-plane",
        Component::CrossTrack => "cross-track",
        Component::Axial => "axial",
    }
}

/// Its name in the study.
pub fn objective_name(objective: Objective) -> &'static str {
    match objective {
        Objective::Worst => "worst",
        Objective::Mean => "mean",
        Objective::Above(_) => "above-tolerance",
    }
}
