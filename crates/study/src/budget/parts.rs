//! The predicted deviation of a circle in its parts: what the load does, what there is without it, and how sure the load's
//! part is.

use armill_core::map::{WithoutLoad, radial_doubts, radial_without_load};
use armill_core::nalgebra::Point2;
use armill_core::path::{Shape, Track};
use armill_core::watch::Watch;

use crate::error::StudyError;
use crate::file::path::PathAnalysis;
use crate::file::resolve::Study;
use crate::run::{PathFound, runner};

/// Outward deviations at the points of the circle, m.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// Of each load case, what the load alone does.
    pub load: Vec<Vec<f64>>,
    /// What the same path does without it; none where nothing else moves the tool.
    pub without: Option<WithoutLoad>,
    /// Change of the mean of the cases that make the bias by each independent unknown.
    pub uncertainties: Vec<Vec<f64>>,
}

/// The parts of `found`, of whose cases the first `biased` make the bias.
///
/// # Errors
/// Those of a run.
pub fn parts(
    study: &Study,
    (path, found): (&PathAnalysis, &PathFound),
    biased: usize,
    watch: Watch<'_>,
) -> Result<Parts, StudyError> {
    let centre = match path.shape() {
        Some(Shape::Circle { centre, .. }) => *centre,
        _ => Point2::origin(),
    };
    let runner = runner(study, watch)?;
    let question = runner.question(&path.setting);
    let turned: Option<Track> = found
        .searched
        .as_ref()
        .map(|searched| searched.posture.turned(&path.track));
    let track = turned.as_ref().unwrap_or(&path.track);
    let followed = (track, &found.along);
    let without = radial_without_load(&question, followed, centre, watch)?;
    let of_load = |outward: &Vec<f64>| match &without {
        None => outward.clone(),
        Some(without) => outward
            .iter()
            .zip(&without.outward)
            .map(|(all, own)| all - own)
            .collect(),
    };
    Ok(Parts {
        load: found.radial.iter().map(|case| of_load(&case.outward)).collect(),
        uncertainties: radial_doubts(&question, followed, centre, biased),
        without,
    })
}
