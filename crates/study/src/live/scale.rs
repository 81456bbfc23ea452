//! The colour scale of an analysis: round levels that contain its deviations.
//!
//! Colours reach from the first level to the last; ticks and lines of equal deviation are at each of them.
//!
//! ```text
//! deviations 109.2 ... 158.8 um      levels 100 110 120 130 140 150 160
//! ```
//!
//! The scale is extended to the tolerance if that is nearer to the deviations than they are to each other.

use armill_core::kernel::Answers;
use armill_core::units::to_um;

use crate::analysis::{AnalysisData, AnalysisResult};
use crate::error::StudyError;
use crate::number::without_rounding;

/// Steps of a scale, or a few more or less.
const STEPS: f64 = 8.0;

/// Most levels of a requested scale: each has its lines.
const MOST_LEVELS: usize = 100;

/// The levels of this result, um, rising; `None` if no point has a deviation.
pub(super) fn levels_of(done: &AnalysisResult<'_>, tolerance_um: f64) -> Option<Vec<f64>> {
    let answers = match &done.found {
        AnalysisData::Map(_, map) => vec![&map.answers],
        AnalysisData::Sections(sections) => sections.iter().map(|section| &section.map.answers).collect(),
        AnalysisData::Volume(_, volume) => vec![&volume.answers],
        AnalysisData::Path(_, found) => vec![&found.along.answers],
        AnalysisData::Holes(_, found) => vec![&found.answers],
    };
    let points = answers.into_iter().flat_map(Answers::evaluations);
    let deviations = points.map(|(_, evaluation)| to_um(evaluation.in_plane));
    let [least, largest] = deviations
        .map(|um| [um, um])
        .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
    Some(levels_around([least, largest], Some(tolerance_um)))
}

/// The levels of a scale that is requested.
///
/// # Errors
/// They do not rise, or are too few or too many.
pub(super) fn checked(levels_um: &[f64]) -> Result<Vec<f64>, StudyError> {
    let rise = levels_um.windows(2).all(|pair| pair[0] < pair[1]);
    if !rise || !(2..=MOST_LEVELS).contains(&levels_um.len()) {
        return Err(StudyError::value(
            "`levels_um` has no scale",
            format!("2 to {MOST_LEVELS} levels, rising"),
        ));
    }
    Ok(levels_um.to_vec())
}

/// The levels that contain these values, extended to a tolerance that is near.
pub(super) fn levels_around([least, largest]: [f64; 2], tolerance: Option<f64>) -> Vec<f64> {
    // Equal deviations have a scale too.
    let (mut low, mut high) = (least, largest.max(least + 1e-9 * least.abs().max(1.0)));
    let span = high - low;
    if let Some(tolerance) = tolerance {
        if tolerance < low && low - tolerance < span {
            low = tolerance;
        }
        if tolerance > high && tolerance - high < span {
            high = tolerance;
        }
    }
    let step = round_step((high - low) / STEPS);
    // A limit that is a level within rounding is that level.
    let first = (low / step + 1e-9).floor();
    let steps = ((high / step - 1e-9).ceil() - first).max(1.0);
    (0..=steps as usize)
        .map(|k| without_rounding((first + k as f64) * step))
        .collect()
}

/// The least of 1, 2 and 5 times a power of ten that is not below this.
fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    let times = [1.0, 2.0, 5.0].into_iter().find(|times| least <= times * power);
    times.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_contains_all_deviations_with_round_limits() {
        let levels = levels_around([109.2, 158.8], Some(50.0));
        assert_eq!(levels, [100.0, 110.0, 120.0, 130.0, 140.0, 150.0, 160.0]);
        assert_eq!(levels_around([0.1, 0.52], Some(9.0))[..3], [0.1, 0.2, 0.3]);
        assert_eq!(
            levels_around([100.0, 180.0], Some(1.0)).len(),
            9,
            "limits that are levels"
        );
    }

    #[test]
    fn a_tolerance_that_is_near_is_on_the_scale_and_one_far_away_is_not() {
        assert!(levels_around([60.0, 100.0], Some(50.0))[0] <= 50.0);
        assert_eq!(levels_around([109.0, 159.0], Some(50.0))[0], 100.0);
        assert!(levels_around([10.0, 40.0], Some(50.0)).last() >= Some(&50.0));
    }

    #[test]
    fn equal_deviations_have_a_scale_too() {
        for value in [0.0, 1e-7, 20.0, 123_456.7] {
            let levels = levels_around([value, value], Some(value));
            assert_eq!(checked(&levels).ok(), Some(levels), "{value}");
        }
    }

    #[test]
    fn a_requested_scale_rises_and_has_a_limited_number_of_levels() {
        assert!(checked(&[10.0, 30.0, 40.0]).is_ok());
        let many: Vec<f64> = (0..=MOST_LEVELS).map(|k| k as f64).collect();
        for refused in [&[][..], &[10.0], &[10.0, 10.0], &[20.0, 10.0], &many] {
            assert!(checked(refused).is_err(), "{refused:?}");
        }
    }
}
