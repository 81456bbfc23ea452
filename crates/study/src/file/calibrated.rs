//! `calibrated_robot`: the arm as it was measured, in addition to the nominal model that its controller uses.
//!
//! | of the study | taken from |
//! |---|---|
//! | where the controller takes the tool, limits, speeds, bodies | `robot` |
//! | where the tool is | `calibrated_robot` |
//! | compliances, springs, masses, backlash, repeatability | `calibrated_robot` if it has compliances, otherwise `robot` |
//! | learnt residual, uncertainty of the geometry | `calibrated_robot` |

use std::path::Path;
use std::sync::Arc;

use armill_core::frame::Isometry;
use armill_core::robot::{Joint, Robot, RobotError, Structure};
use armill_core::source::geometric::displacement;
use armill_core::units::to_mm;
use armill_formats::robot::{JointNote, RobotDescription};
use armill_formats::sources::Source;

use crate::error::StudyError;
use crate::file::format::StudyFile;
use crate::input::problem_log::ProblemLog;
use crate::number::decimals;
use crate::robots;

/// The calibrated robot.
pub(super) struct CalibratedArm {
    pub robot: Arc<Robot>,
    /// Key of the source of each compliance.
    compliance_sources: Vec<JointNote>,
    /// Source of the values.
    pub sources: Vec<Source>,
}

/// If the calibrated flange is farther than this from the nominal one, it is a different arm or other conventions, m:
/// five times the typical error of uncalibrated arms, far below the effect of another zero or base frame.
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
        let (most, allowed) = (decimals(to_mm(most), 1), decimals(to_mm(ANOTHER_ARM), 0));
        format!("has its flange up to {most} mm (allowed: {allowed} mm) from that of")
    })
}

/// The calibrated robot; `None` if the study names none, or one that does not fit, reported at its key.
///
/// # Errors
/// The problems of its file.
pub(super) fn find_calibrated(
    log: &mut ProblemLog<'_>,
    file: &StudyFile,
    believed: &RobotDescription,
    folder: &Path,
) -> Result<Option<CalibratedArm>, StudyError> {
    let Some(name) = &file.calibrated_robot else {
        return Ok(None);
    };
    let found = match robots::find(name, folder) {
        Ok(found) => found,
        Err(StudyError::Value { message, hint }) => {
            log.problem("calibrated_robot", message, &hint);
            return Ok(None);
        }
        Err(problems) => return Err(problems),
    };
    if let Some(message) = other_arm(&found.robot, &believed.robot) {
        let message = format!("`{name}` {message} `{}`", file.robot);
        let hint = "the same arm as `robot`, with the lengths and angles that were measured: joints, senses, zeros and base \
                    frame as there";
        log.problem("calibrated_robot", message, hint);
        return Ok(None);
    }
    let sources = found.sources.into_iter().map(|source| Source {
        key: of_actual(&source.key),
        ..source
    });
    Ok(Some(CalibratedArm {
        robot: Arc::new(found.robot),
        compliance_sources: found.joint_notes,
        sources: sources.collect(),
    }))
}

/// Key of a source of the calibrated arm in the list of all sources.
fn of_actual(key: &str) -> String {
    format!("actual:{key}")
}

impl CalibratedArm {
    /// `believed` with what was measured of this arm besides its geometry.
    ///
    /// # Errors
    /// Never for arms with the same joints, as was checked.
    pub(super) fn measured_on(&self, mut believed: RobotDescription) -> Result<RobotDescription, StudyError> {
        let refused = |error: RobotError| StudyError::value(error.to_string(), "calibrate this arm again");
        let Some(compliance) = self.robot.compliance() else {
            let structure = Structure {
                learnt: self.robot.structure().learnt.clone(),
                geometry: self.robot.structure().geometry.clone(),
                ..believed.robot.structure().clone()
            };
            believed.robot = believed.robot.with_structure(structure).map_err(refused)?;
            return Ok(believed);
        };
        let with = believed.robot.with_structure(self.robot.structure().clone());
        let with = with.map_err(refused)?;
        believed.robot = with.with_compliance(compliance.to_vec()).map_err(refused)?;
        let key = |key: &Option<String>| key.as_deref().map(of_actual);
        for (note, of) in believed.joint_notes.iter_mut().zip(&self.compliance_sources) {
            note.compliance_source = key(&of.compliance_source);
            note.compliance_u_source = key(&of.compliance_u_source);
        }
        Ok(believed)
    }
}
