//! The part that comes out before and after the compensation, cut in the model.

use armill_core::map::AlongPath;
use armill_core::optimize::Compensated;
use armill_core::path::Track;
use armill_core::units::to_um;
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::path::machined_part::MachinedPart;
use armill_study::analysis::runner::Runner;
use armill_study::error::StudyError;
use serde::Serialize;

/// The surface of a part before and after, as predicted.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CompensatedSurface {
    /// Of the path as programmed.
    pub before: SurfaceNumbers,
    /// Of the commanded path.
    pub after: SurfaceNumbers,
}

/// Deviations of a surface, normal to the nominal one; by area.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SurfaceNumbers {
    /// Largest outwards: material that is left.
    pub most_left_um: f64,
    /// Largest inwards, negative: too much is removed.
    pub most_gouged_um: f64,
    /// Root mean square.
    pub rms_um: f64,
    /// Part of the area within the tolerance.
    pub fraction_within: f64,
}

/// The part that comes out of a path as programmed, if the study asks for it.
pub(super) fn uncompensated(
    runner: &Runner<'_>,
    analysis: &PathAnalysis,
    track: &Track,
    along: &AlongPath,
) -> Result<Option<MachinedPart>, StudyError> {
    runner.machined_part(analysis, track, (track, along), None)
}

/// A compensation for the surface without a part.
pub(super) fn no_part(name: &str) -> StudyError {
    StudyError::value(
        format!("{name}: the directions of its surface are not known: the path has no `machined_part`"),
        "add machined_part = { stock = .. } to the analysis, or leave out --surface",
    )
}

/// The surface before and after; none if the study does not ask for the part.
pub(super) fn answer(
    runner: &Runner<'_>,
    analysis: &PathAnalysis,
    (nominal, before): (&Track, Option<&MachinedPart>),
    found: &Compensated,
) -> Result<Option<CompensatedSurface>, StudyError> {
    let Some(before) = before else { return Ok(None) };
    let after = runner.machined_part(analysis, nominal, (&found.track, &found.along), None)?;
    let tolerance = analysis.setting.tolerance;
    Ok(after.map(|after| CompensatedSurface {
        before: numbers(before, tolerance),
        after: numbers(&after, tolerance),
    }))
}

fn numbers(part: &MachinedPart, tolerance: f64) -> SurfaceNumbers {
    let points = &part.surface.points;
    let area: f64 = points.iter().map(|point| point.area).sum();
    let mean = |of: &dyn Fn(f64) -> f64| {
        let sum: f64 = points.iter().map(|point| of(point.deviation) * point.area).sum();
        if area > 0.0 { sum / area } else { 0.0 }
    };
    let largest = |sign: f64| {
        points
            .iter()
            .map(|point| sign * point.deviation)
            .fold(0.0, f64::max)
    };
    SurfaceNumbers {
        most_left_um: to_um(largest(1.0)),
        most_gouged_um: 0.0 - to_um(largest(-1.0)),
        rms_um: to_um(mean(&|m| m * m).sqrt()),
        fraction_within: mean(&|m| f64::from(u8::from(m.abs() <= tolerance))),
    }
}
