//! The quantity that colours show at every point, if it is not the in-plane deviation: its values, the levels of its
//! colour scale, and lines at these levels on maps.
//!
//! To add one: a variant of [`LayerKey`], its quantity and its value here, and its entry in `web/src/scene/layers.ts`.

use armill_core::kernel::{Answers, Evaluation};
use armill_core::map::probability_within;
use armill_core::marching_squares::ScalarField;
use armill_core::robot::Robot;
use armill_core::units::to_um;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::quantity::{self, Quantity};
use crate::analysis::{AnalysisData, AnalysisResult};
use crate::answer::StudyAnswer;
use crate::error::StudyError;
use crate::input::setting::Setting;
use crate::joint_order::in_joint_order;
use crate::joint_unit::JointUnit;
use crate::live::lines::short;
use crate::live::scale::{checked, levels_around};
use crate::number::decimals;

/// A quantity that colours can show: its key in tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LayerKey {
    /// In-plane deviation.
    InPlaneUm,
    /// Deviation along the normal.
    NormalUm,
    /// Length of the deviation.
    FullUm,
    /// Standard uncertainty of the in-plane deviation.
    InPlaneUUm,
    /// Probability to be within the tolerance.
    ProbabilityWithin,
    /// Distance to the joint limits.
    LimitMarginDeg,
    /// Contributor with the largest share of the in-plane deviation: its index among the contributors.
    LargestShare,
}

/// The requested quantity.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LayerRequest {
    /// Which.
    pub key: LayerKey,
    /// The levels of a fixed colour scale, rising; chosen for the values if left out.
    // unit: as the quantity
    pub levels: Option<Vec<f64>>,
}

/// The values of a quantity.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LayerAnswer {
    /// Which.
    pub key: LayerKey,
    /// Values of each map in the order of the answer, else one list for the points of the scene; `null` where it is not
    /// known.
    // unit: as the quantity
    pub values: Vec<Vec<Option<f64>>>,
    /// The levels of its colour scale, from end to end; `null` if no point has a value, and of names.
    // unit: as the quantity
    pub levels: Option<Vec<f64>>,
    /// What the values are indices of, for `largest_share`; empty otherwise.
    pub names: Vec<String>,
    /// Lines of equal value, one entry a map.
    pub lines: Vec<Vec<LayerLine>>,
}

/// Lines at one level.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LayerLine {
    /// The value along them.
    // unit: as the quantity
    pub level: f64,
    /// y', z' along each line; closed lines repeat their first point.
    pub lines_mm: Vec<Vec<[f64; 2]>>,
}

impl LayerKey {
    /// The quantity of the tables that it shows.
    pub fn quantity(self) -> &'static Quantity {
        match self {
            LayerKey::InPlaneUm => &quantity::IN_PLANE,
            LayerKey::NormalUm => &quantity::NORMAL,
            LayerKey::FullUm => &quantity::FULL,
            LayerKey::InPlaneUUm => &quantity::IN_PLANE_U,
            LayerKey::ProbabilityWithin => &quantity::PROBABILITY_WITHIN,
            LayerKey::LimitMarginDeg => &quantity::LIMIT_MARGIN,
            LayerKey::LargestShare => &quantity::SHARE,
        }
    }

    /// Its value at a point that is reached, in the unit of the quantity; none where it is not known.
    pub(super) fn value(
        self,
        (robot, setting, answers): (&Robot, &Setting, &Answers),
        (index, evaluation): (usize, &Evaluation),
    ) -> Option<f64> {
        let value = match self {
            LayerKey::InPlaneUm => Some(to_um(evaluation.in_plane)),
            LayerKey::NormalUm => Some(to_um(evaluation.normal)),
            LayerKey::FullUm => Some(to_um(evaluation.full)),
            LayerKey::InPlaneUUm => evaluation.in_plane_uncertainty.map(to_um),
            LayerKey::ProbabilityWithin => probability_within(evaluation, setting.tolerance),
            LayerKey::LimitMarginDeg => {
                Some(evaluation.limit_margin * JointUnit::of(robot, evaluation.limit_joint).scale)
            }
            LayerKey::LargestShare => (answers.share_count > 0).then(|| {
                let shares = in_joint_order(robot, answers.shares_at(index));
                let largest = shares.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
                largest.map_or(0.0, |(contributor, _)| contributor as f64)
            }),
        };
        let value = value.filter(|value| value.is_finite())?;
        Some(decimals(value, i32::from(self.quantity().decimals)))
    }

    /// The levels of its colour scale.
    fn levels(self, values: &[Vec<Option<f64>>], tolerance_um: f64) -> Option<Vec<f64>> {
        let known = || values.iter().flatten().flatten().copied();
        let [least, largest] = known()
            .map(|value| [value, value])
            .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
        match self {
            LayerKey::LargestShare => None,
            LayerKey::ProbabilityWithin => Some((0..=10).map(|tenth| f64::from(tenth) / 10.0).collect()),
            LayerKey::InPlaneUm => Some(levels_around([least, largest], Some(tolerance_um))),
            _ => Some(levels_around([least, largest], None)),
        }
    }
}

/// The requested quantity of this result.
///
/// # Errors
/// Levels that are no scale.
pub(super) fn layer_of(
    robot: &Robot,
    request: &LayerRequest,
    done: &AnalysisResult<'_>,
    answer: &StudyAnswer,
    lines: bool,
) -> Result<LayerAnswer, StudyError> {
    let key = request.key;
    let fixed = request.levels.as_deref().map(checked).transpose()?;
    let series: Vec<(&Setting, &Answers)> = match &done.found {
        AnalysisData::Map(sheet, map) => vec![(&sheet.setting, &map.answers)],
        AnalysisData::Sections(sections) => sections
            .iter()
            .map(|section| (&section.sheet.setting, &section.map.answers))
            .collect(),
        AnalysisData::Volume(setting, volume) => vec![(*setting, &volume.answers)],
        AnalysisData::Path(analysis, found) => vec![(&analysis.setting, &found.along.answers)],
        AnalysisData::Holes(analysis, found) => vec![(&analysis.path.setting, &found.answers)],
    };
    let values_of = |(setting, answers): &(&Setting, &Answers)| -> Vec<Option<f64>> {
        let points = answers.points.iter().enumerate();
        points
            .map(|(index, point)| key.value((robot, setting, answers), (index, point.as_ref().ok()?)))
            .collect()
    };
    let values: Vec<Vec<Option<f64>>> = series.iter().map(values_of).collect();
    let setting = series.first().map(|(setting, _)| *setting);
    let tolerance_um = setting.map_or(0.0, |setting| to_um(setting.tolerance));
    let levels = fixed.or_else(|| key.levels(&values, tolerance_um));
    let drawn = levels.as_deref().filter(|_| lines).unwrap_or_default();
    let lines_of = |(map, values): (&crate::analysis::map::answer::MapAnswer, &Vec<Option<f64>>)| {
        let field = ScalarField {
            x: &map.grid.y_mm,
            y: &map.grid.z_mm,
            values,
        };
        let at = |level: &f64| LayerLine {
            level: *level,
            lines_mm: field
                .lines_at(*level)
                .into_iter()
                .map(|line| line.into_iter().map(short).collect())
                .collect(),
        };
        let lines = drawn.par_iter().map(at);
        lines.filter(|line| !line.lines_mm.is_empty()).collect()
    };
    Ok(LayerAnswer {
        key,
        names: match (key, setting) {
            (LayerKey::LargestShare, Some(setting)) => setting.contributor_names(robot),
            _ => Vec::new(),
        },
        lines: answer.maps.iter().zip(&values).map(lines_of).collect(),
        values,
        levels,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_key_of_a_layer_is_the_key_of_its_column() {
        for key in [
            LayerKey::InPlaneUm,
            LayerKey::NormalUm,
            LayerKey::FullUm,
            LayerKey::InPlaneUUm,
            LayerKey::ProbabilityWithin,
            LayerKey::LimitMarginDeg,
        ] {
            assert_eq!(serde_json::to_value(key).unwrap(), key.quantity().key);
        }
    }
}
