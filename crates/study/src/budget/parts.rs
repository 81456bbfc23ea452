//! The predicted deviation of a circle in its parts: the effect of the load, the path without it, and the uncertainty
//! of the effect of the load.

use armill_core::map::{WithoutLoad, radial_motion, radial_uncertainties, radial_without_load};
use armill_core::nalgebra::Point2;
use armill_core::path::{Shape, Track};
use armill_core::stability::WallSide;
use armill_core::watch::Watch;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::analysis::path::vibration::cuts;
use crate::analysis::runner::Runner;
use crate::analysis::vibration::wall::WallErrors;
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
    /// The wall by the vibration under the teeth, and its change by each uncertain parameter of the modes; none without `[vibration]` and a
    /// cut with one wall.
    pub vibration: Option<(Vec<f64>, Vec<Vec<f64>>)>,
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
    let cuts = cuts(path, track, &found.along.load);
    let walls =
        cuts.and_then(|cuts| WallErrors::of(&study.robot.robot, &path.setting, &found.along.answers, &cuts));
    let vibration = walls.map(|walls| {
        // The circle turns to the left: the part on the right of the feed is outside.
        let sign = match walls.side {
            WallSide::Right => 1.0,
            WallSide::Left => -1.0,
        };
        let outwards = |errors: Vec<f64>| errors.into_iter().map(|error| sign * error).collect();
        (
            outwards(walls.errors),
            walls.changes.into_iter().map(outwards).collect(),
        )
    });
    Ok(DeviationParts {
        vibration,
        load: found.radial.iter().map(|case| of_load(&case.outward)).collect(),
        uncertainties: radial_uncertainties(&question, track, &found.along, centre, biased),
        without,
        motion,
    })
}
