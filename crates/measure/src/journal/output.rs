//! The robot file after the measurements of a journal.

use armill_core::update::{Parameter, Posterior};
use armill_formats::robot::armill::{
    Geometry, GeometryCovarianceTable, Identified, IdentifiedSpring, JointBacklash, MeasuredBacklash,
    with_backlash, with_geometry, with_springs,
};
use armill_formats::robot::spring_tables::SpringKind;
use armill_study::StudyError;

use super::learning::Learning;
use super::measurements::Measurements;

/// Least part of what is known that must come from measurements, for a value that the robot file does not give.
pub(super) const DETERMINED: f64 = 0.5;

/// The robot file `text` (at `path`) with geometry, compliances and backlash after all measurements.
///
/// Compliances and backlash that the file does not give are written only where the measurements determine them.
///
/// # Errors
/// A robot file that is not TOML, or that no longer reads with these numbers.
pub fn robot_file(
    [path, text]: [&str; 2],
    measurements: &Measurements,
    learning: &Learning,
) -> Result<String, StudyError> {
    let robot = &measurements.robot.robot;
    let posterior = &learning.posterior;
    let what = |of: &str| {
        let count = measurements.campaigns.len();
        let last = measurements
            .journal
            .measurements
            .last()
            .map_or("", |entry| &entry.date);
        format!("{of} found by armill from {count} measurements, the last of {last}")
    };
    let name = |joint: usize| robot.joints()[joint].name.clone();
    let after: Vec<_> = (0..robot.joints().len())
        .map(|joint| (name(joint), posterior.motions_after(joint)))
        .filter(|(_, motions)| !motions.is_empty())
        .collect();
    let geometry = Geometry {
        after,
        what: what("geometry"),
        place: measurements.file.clone(),
        covariance: (posterior.geometry()).map(|geometry| GeometryCovarianceTable::of(robot, &geometry)),
    };
    let mut written = with_geometry(path, text, &geometry)?;
    if let Some(identified) = drives(measurements, posterior, what("compliances of the drives")) {
        written = with_springs(path, &written, &identified)?;
    }
    let joints: Vec<JointBacklash> = (posterior.knowledge.iter().enumerate())
        .filter_map(|(k, known)| {
            let Parameter::Backlash(joint) = known.parameter else {
                return None;
            };
            let stated = robot
                .structure()
                .joints_with_backlash()
                .any(|(of, _)| of == joint);
            (stated || posterior.from_measurements(k) >= DETERMINED).then(|| JointBacklash {
                joint: name(joint),
                turns: !robot.slides(joint),
                gap: known.value(),
                standard_uncertainty: known.standard_uncertainty(),
            })
        })
        .collect();
    if joints.is_empty() {
        return Ok(written);
    }
    let measured = MeasuredBacklash {
        joints,
        what: what("backlash"),
        place: measurements.file.clone(),
    };
    Ok(with_backlash(path, &written, &measured)?)
}

/// The drives; none where the robot file has no compliances and the measurements do not determine all of them.
fn drives(measurements: &Measurements, posterior: &Posterior, what: String) -> Option<Identified> {
    let robot = &measurements.robot.robot;
    let all: Vec<(usize, usize)> = (posterior.knowledge.iter().enumerate())
        .filter_map(|(k, known)| match known.parameter {
            Parameter::Drive(joint) => Some((k, joint)),
            Parameter::Geometry(_) | Parameter::Backlash(_) => None,
        })
        .collect();
    let determined = |(k, _): &(usize, usize)| posterior.from_measurements(*k) >= DETERMINED;
    let is_written = match robot.compliance() {
        Some(_) => !all.is_empty(),
        None => all.iter().all(determined),
    };
    let springs = all.iter().map(|(k, joint)| IdentifiedSpring {
        at: robot.joints()[*joint].name.clone(),
        kind: match robot.slides(*joint) {
            true => SpringKind::PrismaticDrive,
            false => SpringKind::Drive,
        },
        compliance: posterior.knowledge[*k].value(),
        standard_uncertainty: posterior.knowledge[*k].standard_uncertainty(),
    });
    let turning: Vec<usize> = (all.iter())
        .filter(|(_, joint)| !robot.slides(*joint))
        .map(|(k, _)| *k)
        .collect();
    // Of the compliances: that of their logarithms times both.
    let entry = |a: usize, b: usize| {
        posterior.covariance[(a, b)] * posterior.knowledge[a].value() * posterior.knowledge[b].value()
    };
    let covariance = turning
        .iter()
        .map(|a| turning.iter().map(|b| entry(*a, *b)).collect());
    is_written.then(|| Identified {
        springs: springs.collect(),
        covariance: covariance.collect(),
        model_error: None,
        what,
        place: measurements.file.clone(),
    })
}
