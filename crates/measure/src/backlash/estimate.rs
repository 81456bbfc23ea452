//! The backlash of the joints from measurements on circles of the study.

use armill_core::measure::ballbar::joints::{BacklashOptions, Observed, fit_backlash};
use armill_core::watch::Watch;
use armill_study::error::StudyError;
use armill_study::file::circles::MeasuredCircle;
use armill_study::file::resolve::Study;

use super::answer::{BacklashAnswer, answer};
use crate::data_check::circles::{NamedTest, slip};

use super::circles::{BacklashEstimate, CircleAnalysis, FollowedCircle, circles, followed};

/// Options of the estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimateOptions {
    /// Lobes of a circle that are no backlash.
    pub most_lobes: usize,
    /// Standard deviation of a sample, m; from the residuals if not given.
    pub noise: Option<f64>,
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
            "[[ballbar]] with analysis = \"xy\" and files = [\"xy.csv\"]; or --circles N, or --simulate FOLDER",
        ));
    }
    let names: Vec<String> = study.circles.iter().map(|of| of.analysis.clone()).collect();
    Ok(study.circles.iter().zip(circles(study, &names)?).collect())
}

/// The backlash of all joints, from all measured circles.
///
/// # Errors
/// A study without measured circles; a circle that the robot cannot follow; too few samples.
pub fn estimate<'a>(
    study: &'a Study,
    expected: &EstimateOptions,
    watch: Watch<'_>,
) -> Result<(BacklashEstimate<'a>, BacklashAnswer), StudyError> {
    let circles = (measured(study)?.into_iter())
        .map(|(measured, circle)| {
            Ok(FollowedCircle {
                measured,
                circle,
                followed: followed(study, &circle, watch)?,
            })
        })
        .collect::<Result<Vec<_>, StudyError>>()?;
    let observed: Vec<Observed<'_>> = (circles.iter())
        .map(|of| Observed {
            followed: &of.followed,
            test: &of.measured.test,
        })
        .collect();
    let requested = BacklashOptions {
        most_lobes: expected.most_lobes,
        noise: expected.noise,
        ..BacklashOptions::of_all(study.robot.robot.joints().len())
    };
    let found = fit_backlash(&observed, &requested).map_err(|error| {
        StudyError::value(
            error.to_string(),
            "check that the robot of the study is the measured one, and the unit of the radii",
        )
    })?;
    let gaps = found.ok_or_else(|| {
        StudyError::value(
            "the circles have fewer samples than there are unknowns",
            "runs of a sample a degree or more, or fewer --lobes",
        )
    })?;
    let estimated = BacklashEstimate { circles, gaps };
    let observed: Vec<NamedTest<'_>> = (estimated.circles.iter())
        .map(|of| NamedTest {
            name: of.circle.name,
            followed: &of.followed,
            test: &of.measured.test,
        })
        .collect();
    let given = BacklashAnswer {
        slip: slip(&observed, &requested, estimated.gaps.rms_after),
        ..answer(study, &estimated)
    };
    Ok((estimated, given))
}
