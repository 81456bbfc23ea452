//! The objective of a search for placements: what the study and its table `place` specify.

use armill_core::optimize::{PlacementObjective, PostureSearch, PostureSelection, RankBy};
use armill_core::robot::{BranchPattern, Robot};
use armill_core::units::from_deg;
use armill_study::analysis::path::PathAnalysis;
use armill_study::error::StudyError;
use armill_study::file::placement::{ANY, PlaceTable, RankByName};
use armill_study::input::posture_search::{ComponentName, ObjectiveName};

use super::answer::rank_by_name;

/// Default least angle of the wrist from straight, deg.
const USUAL_WRIST_DEG: f64 = 3.0;

/// The objective for a path, or for holes with their search.
///
/// # Errors
/// Words that are no branch; a ranking by an uncertainty that is not known.
pub(super) fn objective(
    table: &PlaceTable,
    analysis: &PathAnalysis,
    holes: Option<&PostureSearch>,
    robot: &Robot,
) -> Result<PlacementObjective, StudyError> {
    let setting = &analysis.setting;
    let branches = match table.branch.as_deref() {
        None => holes.map_or(setting.open, |search| search.branches),
        Some(ANY) => BranchPattern::default(),
        Some(words) => words.parse().map_err(|error| {
            let message = format!("place.branch: {error}");
            StudyError::value(message, "words of a branch, or `any`")
        })?,
    };
    Ok(PlacementObjective {
        component: match (table.component, holes) {
            (Some(component), _) => component.component(),
            (None, Some(search)) => search.component,
            (None, None) => ComponentName::InPlane.component(),
        },
        objective: table
            .objective
            .unwrap_or(ObjectiveName::Worst)
            .objective(setting.tolerance),
        branches,
        margin: from_deg(table.margin_deg.unwrap_or(0.0)),
        selection: match holes {
            Some(search) => PostureSelection::PerPoint(search.spins),
            None => PostureSelection::ForPath,
        },
        rank_by: rank_by(table, analysis, robot)?,
        wrist: match (table.least_wrist_deg, holes) {
            (Some(least), _) => from_deg(least),
            (None, Some(search)) => search.wrist,
            (None, None) => from_deg(USUAL_WRIST_DEG),
        },
    })
}

/// What placements are ranked by; not an uncertainty that is not known.
fn rank_by(table: &PlaceTable, analysis: &PathAnalysis, robot: &Robot) -> Result<RankBy, StudyError> {
    let setting = &analysis.setting;
    let name = table.rank_by.unwrap_or(RankByName::Nominal);
    let rank_by = name.rank_by(setting.tolerance);
    if rank_by != RankBy::Nominal && !setting.arm(robot).has_known_uncertainty() {
        let message = format!(
            "place.rank_by = \"{}\" requires the uncertainty of the compliances, which is not known",
            rank_by_name(rank_by)
        );
        return Err(StudyError::value(
            message,
            "give `u_rad_per_n_m` in [compliance], or rank by `nominal`",
        ));
    }
    Ok(rank_by)
}
