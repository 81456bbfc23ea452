//! One analysis in one cell, in numbers.
//!
//! `95 %`: the deviation that 95 of 100 reached points do not exceed (nearest rank). Points have equal weight,
//! independent apart.

use armill_core::kernel::{Answers, Evaluation};
use armill_core::map::Counts;
use armill_core::optimize::HolesFound;
use armill_core::units::to_um;
use armill_study::analysis::holes::answer::decisive;
use armill_study::analysis::path::PathAnalysis;
use armill_study::answer::{
    CountsAnswer, HolesAnswer, MapAnswer, PathAnswer, PointAnswer, SettingAnswer, VolumeAnswer,
};
use serde::Serialize;

/// One analysis in one cell.
#[derive(Clone, Debug, Serialize)]
pub struct CellNumbers {
    /// Which cell.
    pub cell: String,
    /// Its robot.
    pub robot: String,
    /// Whether the joint compliances of its robot are assumed, not measured.
    pub compliance_assumed: bool,
    /// Branch that was followed, or requested.
    pub branch: String,
    /// How many points.
    pub points: usize,
    /// Points with a posture.
    pub reached: usize,
    /// Points with a posture inside the joint limits.
    pub inside_joint_limits: usize,
    /// Points by reason; holes that are reached but cannot be drilled are left out.
    pub counts: CountsAnswer,
    /// The tolerance.
    pub tolerance_um: f64,
    /// Mean of the in-plane deviations.
    pub mean_in_plane_um: Option<f64>,
    /// The in-plane deviation that 95 of 100 points keep.
    pub p95_in_plane_um: Option<f64>,
    /// Largest in-plane deviation.
    pub max_in_plane_um: Option<f64>,
    /// Its standard uncertainty; none if not known.
    pub max_in_plane_u_um: Option<f64>,
    /// Largest deviation along the normal (along the tool, of a path), by size.
    pub max_normal_um: Option<f64>,
    /// Points within the tolerance over all points.
    pub fraction_within: f64,
    /// The same, of points inside the joint limits only.
    pub fraction_within_and_inside_joint_limits: f64,
    /// Largest contributor where the deviation is largest: a joint, or base, flange or tool.
    pub mostly_by: Option<String>,
    /// Its share there.
    pub mostly_by_percent: Option<f64>,
}

/// The result of one analysis in one cell.
pub(super) struct AnalysisNumbers {
    /// Its name; of a section with the label.
    pub name: String,
    /// `path`, `holes`, `map` or `volume`.
    pub kind: &'static str,
    /// Its numbers; cell and robot are still to be named.
    pub numbers: CellNumbers,
}

impl AnalysisNumbers {
    /// A path.
    pub(super) fn path(given: &PathAnswer, analysis: &PathAnalysis, answers: &Answers) -> AnalysisNumbers {
        let branch = given.followed_branch.as_ref().unwrap_or(&given.branch);
        AnalysisNumbers {
            name: given.name.clone(),
            kind: "path",
            numbers: numbers(
                branch,
                analysis.setting.tolerance,
                answers,
                given.worst.as_ref(),
                &given.setting,
            ),
        }
    }

    /// A set of holes and its tolerance, m; deviations are those of the holes that can be drilled.
    pub(super) fn holes(given: &HolesAnswer, limit: f64, found: &HolesFound) -> AnalysisNumbers {
        let worst = given.worst_holes.first().map(|worst| &worst.point);
        let numbers = numbers(&given.branch, limit, &found.answers, worst, &given.setting);
        let decisive = decisive(found).into_iter().map(|(_, evaluation)| evaluation);
        AnalysisNumbers {
            name: given.name.clone(),
            kind: "holes",
            numbers: CellNumbers {
                fraction_within: given.fraction_within,
                fraction_within_and_inside_joint_limits: given.fraction_within,
                counts: given.counts,
                ..numbers.with_deviations_of(decisive)
            },
        }
    }

    /// A plane and its tolerance, m.
    pub(super) fn map(given: &MapAnswer, limit: f64, answers: &Answers) -> AnalysisNumbers {
        AnalysisNumbers {
            name: given.name.clone(),
            kind: "map",
            numbers: numbers(
                &given.branch,
                limit,
                answers,
                given.worst.as_ref(),
                &given.setting,
            ),
        }
    }

    /// A box and its tolerance, m.
    pub(super) fn volume(given: &VolumeAnswer, limit: f64, answers: &Answers) -> AnalysisNumbers {
        AnalysisNumbers {
            name: given.name.clone(),
            kind: "volume",
            numbers: numbers(
                &given.branch,
                limit,
                answers,
                given.worst.as_ref(),
                &given.setting,
            ),
        }
    }
}

/// Points `answers` and their tolerance (m), worst at `worst`.
fn numbers(
    branch: &str,
    limit: f64,
    answers: &Answers,
    worst: Option<&PointAnswer>,
    setting: &SettingAnswer,
) -> CellNumbers {
    let counts = Counts::of(answers, limit);
    let reached = answers.evaluations().count();
    let share = worst.and_then(|worst| worst.mostly_by(&setting.contributors));
    let numbers = CellNumbers {
        cell: String::new(),
        robot: String::new(),
        compliance_assumed: false,
        branch: branch.to_owned(),
        points: answers.points.len(),
        reached,
        inside_joint_limits: reached - counts.outside_joint_limits,
        tolerance_um: setting.tolerance_um,
        mean_in_plane_um: None,
        p95_in_plane_um: None,
        max_in_plane_um: None,
        max_in_plane_u_um: worst.and_then(|worst| worst.in_plane_u_um),
        max_normal_um: None,
        fraction_within: counts.fraction_within(),
        fraction_within_and_inside_joint_limits: counts.fraction_within_and_inside_joint_limits(),
        counts: CountsAnswer::of(&counts),
        mostly_by: share.map(|(name, _)| name.to_owned()),
        mostly_by_percent: share.and_then(|(_, part)| part).map(|part| part * 100.0),
    };
    numbers.with_deviations_of(answers.evaluations().map(|(_, evaluation)| evaluation))
}

impl CellNumbers {
    /// The same with the deviations of these points.
    fn with_deviations_of<'a>(self, points: impl Iterator<Item = &'a Evaluation>) -> CellNumbers {
        let (mut across, along): (Vec<f64>, Vec<f64>) = points
            .map(|evaluation| (to_um(evaluation.in_plane), to_um(evaluation.normal.abs())))
            .unzip();
        across.sort_by(f64::total_cmp);
        let count = across.len();
        CellNumbers {
            mean_in_plane_um: (count > 0).then(|| across.iter().sum::<f64>() / count as f64),
            p95_in_plane_um: nearest_rank(&across, 0.95),
            max_in_plane_um: across.last().copied(),
            max_normal_um: along.into_iter().max_by(f64::total_cmp),
            ..self
        }
    }
}

/// The least of `sorted` that at least this part of them does not exceed.
fn nearest_rank(sorted: &[f64], part: f64) -> Option<f64> {
    let rank = (part * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.max(1) - 1).copied()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A cell with this fraction within 20 um and this largest deviation, known to 4 um.
    pub(in super::super) fn cell(name: &str, part: f64, largest: Option<f64>) -> CellNumbers {
        CellNumbers {
            cell: name.to_owned(),
            robot: "r".to_owned(),
            compliance_assumed: false,
            branch: "best".to_owned(),
            points: 10,
            reached: if largest.is_some() { 10 } else { 0 },
            inside_joint_limits: if largest.is_some() { 10 } else { 0 },
            counts: CountsAnswer::of(&Counts::default()),
            tolerance_um: 20.0,
            mean_in_plane_um: largest,
            p95_in_plane_um: largest,
            max_in_plane_um: largest,
            max_in_plane_u_um: Some(4.0),
            max_normal_um: largest,
            fraction_within: part,
            fraction_within_and_inside_joint_limits: part,
            mostly_by: None,
            mostly_by_percent: None,
        }
    }

    #[test]
    fn the_rank_of_95_percent_is_that_of_the_textbook() {
        let numbers: Vec<f64> = (1..=20).map(f64::from).collect();
        assert_eq!(nearest_rank(&numbers, 0.95), Some(19.0));
        assert_eq!(nearest_rank(&numbers[..3], 0.95), Some(3.0));
        assert_eq!(nearest_rank(&numbers[..1], 0.95), Some(1.0));
        assert_eq!(nearest_rank(&[], 0.95), None);
    }
}
