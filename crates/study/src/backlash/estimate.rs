//! The gaps of the joints from what was measured on circles of the study.

use armill_core::measure::ballbar::joints::{Asked, Followed, Gaps, Observed, gaps};
use armill_core::watch::Watch;

use super::answer::{BacklashAnswer, answer};
use super::circles::{CircleAnalysis, circles, followed};
use crate::error::StudyError;
use crate::file::circles::MeasuredCircle;
use crate::file::resolve::Study;

/// How it is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Lobes of a circle that are no backlash.
    pub most_lobes: usize,
    /// Standard deviation of a sample, m; from the residuals where it is not known.
    pub noise: Option<f64>,
}

/// What circles show. SI.
#[derive(Clone, Debug)]
pub struct Estimated<'a> {
    /// Each circle that was measured, with the arm along it.
    pub circles: Vec<(&'a MeasuredCircle, CircleAnalysis<'a>, Followed)>,
    /// What they tell together.
    pub gaps: Gaps,
}

/// The points that the progress of [`estimate`] ends at.
///
/// # Errors
/// A study in which no circle was measured.
pub fn point_count(study: &Study) -> Result<usize, StudyError> {
    let circles = measured(study)?;
    Ok(circles.iter().map(|(_, circle)| circle.path.track.len()).sum())
}

/// What was measured, each with its circle.
fn measured(study: &Study) -> Result<Vec<(&MeasuredCircle, CircleAnalysis<'_>)>, StudyError> {
    if study.circles.is_empty() {
        return Err(StudyError::value(
            "the study names no circular test",
            "[[ballbar]] with ask = \"xy\" and files = [\"xy.csv\"]; or --circles N, or --simulate FOLDER",
        ));
    }
    let names: Vec<String> = study.circles.iter().map(|of| of.analysis.clone()).collect();
    Ok(study.circles.iter().zip(circles(study, &names)?).collect())
}

/// The gaps of all joints, from all circles that were measured.
///
/// # Errors
/// A study in which no circle was measured; a circle that the arm does not follow; too few samples.
pub fn estimate<'a>(
    study: &'a Study,
    expected: &Wanted,
    watch: Watch<'_>,
) -> Result<(Estimated<'a>, BacklashAnswer), StudyError> {
    let circles = (measured(study)?.into_iter())
        .map(|(measured, circle)| Ok((measured, circle, followed(study, &circle, watch)?)))
        .collect::<Result<Vec<_>, StudyError>>()?;
    let observed: Vec<Observed<'_>> = (circles.iter())
        .map(|(measured, _, followed)| Observed {
            followed,
            test: &measured.test,
        })
        .collect();
    let requested = Asked {
        most_lobes: expected.most_lobes,
        noise: expected.noise,
        ..Asked::of_all(study.robot.robot.joints().len())
    };
    let found = gaps(&observed, &requested).map_err(|error| {
        StudyError::value(
            error.to_string(),
            "is the arm of the study the one that was measured, and the unit of the radii right?",
        )
    })?;
    let gaps = found.ok_or_else(|| {
        StudyError::value(
            "the circles have fewer samples than there are unknowns",
            "runs of a sample a degree or more, or fewer --lobes",
        )
    })?;
    let estimated = Estimated { circles, gaps };
    let given = answer(study, &estimated);
    Ok((estimated, given))
}
