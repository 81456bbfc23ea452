//! `calibrated_robot`: the arm as it was measured, beside the one that its controller reckons with.

use std::path::Path;
use std::sync::Arc;

use armill_core::frame::Isometry;
use armill_core::robot::{Joint, Robot};
use armill_core::source::geometric::displacement;
use armill_formats::robot::RobotDescription;
use armill_formats::sources::Source;

use super::format::StudyFile;
use super::places::Places;
use crate::error::StudyError;
use crate::number::decimals;
use crate::robots;

/// The robot as it was measured.
pub(super) struct Actual {
    pub robot: Arc<Robot>,
    /// Where its numbers come from.
    pub sources: Vec<Source>,
}

/// An arm whose flange is farther than this from where its controller believes it is another arm, or told otherwise, m: five
/// times what uncalibrated arms are off, far below what another zero or base frame moves.
const ANOTHER_ARM: f64 = 0.02;

/// Why `actual` cannot be `believed` as it was measured, as the words between their names; `None` if it can.
fn other_arm(actual: &Robot, believed: &Robot) -> Option<String> {
    let [joints, of_controller] = [actual, believed].map(|robot| robot.joints().len());
    if joints != of_controller {
        return Some(format!(
            "has another number of joints ({joints}, not {of_controller}) than"
        ));
    }
    let kind = |robot: &Robot, joint| if robot.slides(joint) { "slides" } else { "turns" };
    if let Some(joint) = (0..joints).find(|joint| actual.slides(*joint) != believed.slides(*joint)) {
        let name = &actual.joints()[joint].name;
        return Some(format!("has a joint {name} that {}, unlike", kind(actual, joint)));
    }
    let middle = |joint: &Joint| joint.limits.map_or(0.0, |limits| limits.middle());
    // Every joint moved on its own from the middle of all ranges shows each zero and sense.
    let home: Vec<f64> = believed.joints().iter().map(middle).collect();
    let moved = (0..joints).map(|joint| {
        let mut q = home.clone();
        q[joint] += if believed.slides(joint) { 0.1 } else { 0.5 };
        q
    });
    let off = std::iter::once(home.clone()).chain(moved).map(|q| {
        displacement(believed, actual, &Isometry::identity(), &q)
            .linear
            .norm()
    });
    let most = off.fold(0.0, f64::max);
    (most > ANOTHER_ARM).then(|| {
        let (most, allowed) = (decimals(most * 1e3, 1), decimals(ANOTHER_ARM * 1e3, 0));
        format!("has its flange up to {most} mm (allowed: {allowed} mm) from that of")
    })
}

/// The robot as it was measured; `None` where the study names none, or one that does not fit,
/// told at its place.
///
/// # Errors
/// The problems of its file.
pub(super) fn find_calibrated(
    places: &mut Places<'_>,
    file: &StudyFile,
    (believed, folder): (&RobotDescription, &Path),
) -> Result<Option<Actual>, StudyError> {
    let Some(name) = &file.calibrated_robot else {
        return Ok(None);
    };
    let found = match robots::find(name, folder) {
        Ok(found) => found,
        Err(StudyError::Value { message, hint }) => {
            places.problem("calibrated_robot", message, &hint);
            return Ok(None);
        }
        Err(problems) => return Err(problems),
    };
    if let Some(message) = other_arm(&found.robot, &believed.robot) {
        let message = format!("`{name}` {message} `{}`", file.robot);
        let hint = "the same arm as `robot`, with the lengths and angles that were measured: joints, senses, zeros and base \
                    frame as there";
        places.problem("calibrated_robot", message, hint);
        return Ok(None);
    }
    let sources = found.sources.into_iter().map(|source| Source {
        key: format!("actual:{}", source.key),
        ..source
    });
    Ok(Some(Actual {
        robot: Arc::new(found.robot),
        sources: sources.collect(),
    }))
}
