//! The predicted deviation of a circle in its parts: the effect of the load, the path without it, and the uncertainty
//! of the effect of the load.

use armill_core::map::{WithoutLoad, radial_motion, radial_uncertainties, radial_without_load};
use armill_core::nalgebra::Point2;
use armill_core::path::{Shape, Track};
use armill_core::watch::Watch;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::analysis::runner::Runner;
use crate::error::StudyError;
use crate::file::resolve::Study;

/// Outward deviations at the points of the circle, m.
#[derive(Clone, Debug, Default)]
pub struct DeviationParts {
    /// The effect of the load alone, for each load case.
    pub load: Vec<Vec<f64>>,
    /// The path without load; none if nothing else moves the tool.
    pub without: Option<WithoutLoad>,
    /// Rounded corners, and joints that follow late; none if no motion was requested.
    pub motion: Option<[Vec<f64>; 2]>,
    /// Change of the mean of the cases of the bias by each independent unknown.
    pub uncertainties: Vec<Vec<f64>>,
}

/// The parts of `found`; the bias is the mean of the first `biased` cases.
///
/// # Errors
/// Those of a run.
pub fn parts(
    study: &Study,
    path: &PathAnalysis,
    found: &PathResult,
    biased: usize,
    watch: Watch<'_>,
) -> Result<DeviationParts, StudyError> {
    let centre = match path.shape() {
        Some(Shape::Circle { centre, .. }) => *centre,
        _ => Point2::origin(),
    };
    let runner = Runner::new(&study.robot.robot, watch)?;
    let question = runner.question(&path.setting);
    let turned: Option<Track> = found
        .searched
        .as_ref()
        .map(|searched| searched.posture.turned(&path.track));
    let track = turned.as_ref().unwrap_or(&path.track);
    let without = radial_without_load(&question, track, &found.along, centre, watch)?;
    let motion = (found.motion.as_ref()).map(|motion| radial_motion(track, motion, centre));
    let others: Vec<&Vec<f64>> = (without.iter().map(|without| &without.outward))
        .chain(motion.iter().flatten())
        .collect();
    let of_load = |outward: &Vec<f64>| -> Vec<f64> {
        let at = |index: usize| others.iter().map(|other| other[index]).sum::<f64>();
        outward
            .iter()
            .enumerate()
            .map(|(index, all)| all - at(index))
            .collect()
    };
    Ok(DeviationParts {
        load: found.radial.iter().map(|case| of_load(&case.outward)).collect(),
        uncertainties: radial_uncertainties(&question, track, &found.along, centre, biased),
        without,
        motion,
    })
}
