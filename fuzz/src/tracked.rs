//! Requirements on measured poses and paths of a tracker, on joint logs and on frequency response functions.

use std::sync::OnceLock;

use armill_core::calibrate;
use armill_core::frame::Isometry;
use armill_core::measure::path_accuracy::path_accuracy;
use armill_core::robot::Robot;
use armill_formats::measurement::{frf, joint_log, matlab, poses, trace};
use armill_study::library;

use crate::verdicts::refused;

/// Measured poses; what can be read is calibrated too.
pub fn poses(bytes: &[u8]) {
    static ROBOT: OnceLock<Robot> = OnceLock::new();
    let robot = ROBOT.get_or_init(|| {
        let found = library::robot("yaskawa/mh12").expect("it is in the library");
        found.expect("every robot of the library reads").robot
    });
    let found = match poses::read("poses.csv", bytes, robot, &poses::PoseReadOptions::default()) {
        Err(problems) => return refused(&problems),
        Ok(found) => found,
    };
    assert_eq!(found.poses.len(), found.lines.len());
    let question = calibrate::Question {
        requested: calibrate::ParameterSet::Geometry,
        flange_from_point: Isometry::identity(),
        turn_length: 0.25,
        prior: None,
    };
    if let Ok(found) = calibrate::fit(robot, &found.poses, &question) {
        assert!(found.standard_deviation.is_finite());
        assert!(found.errors.position.iter().all(|error| error.norm().is_finite()));
    }
}

/// Points along a path; the first run of what can be read is commanded to all of them.
pub fn trace(bytes: &[u8]) {
    let found = match trace::read("trace.csv", bytes) {
        Err(problems) => return refused(&problems),
        Ok(found) => found,
    };
    assert!(
        found
            .runs
            .iter()
            .all(|run| run.points.len() == run.lines.len() && !run.points.is_empty())
    );
    let runs: Vec<_> = found.runs.into_iter().map(|run| run.points).collect();
    if let Ok(found) = path_accuracy(&runs[0], &runs) {
        assert!(found.points.iter().all(|point| point.offset.norm().is_finite()));
        assert!(
            found
                .points
                .iter()
                .all(|point| point.repeatability.is_none_or(f64::is_finite))
        );
    }
}

/// Joint logs of an arm with two joints.
pub fn joint_log(bytes: &[u8]) {
    let found = match joint_log::read("log.csv", bytes, 2, joint_log::LogReadOptions::default()) {
        Err(problems) => return refused(&problems),
        Ok(found) => found,
    };
    assert!(found.times.is_sorted_by(|a, b| a < b));
    assert!(found.positions.len() == 2 * found.times.len() && found.lines.len() == found.times.len());
    assert!(found.positions.iter().chain(found.commanded.iter().flatten()).all(|q| q.is_finite()));
    assert!(found.commanded.is_none_or(|commanded| commanded.len() == found.positions.len()));
    assert!(found.moves.is_none_or(|moves| moves.len() == found.times.len()));
}

/// Frequency response functions.
pub fn frf(bytes: &[u8]) {
    let found = match frf::read("tap.csv", bytes) {
        Err(problems) => return refused(&problems),
        Ok(found) => found,
    };
    assert!(!found.frfs.is_empty());
    for own in &found.frfs {
        assert!(own.angular_frequencies.is_sorted_by(|a, b| a < b));
        assert!(own.receptance.len() == own.angular_frequencies.len() && own.weights.len() == own.angular_frequencies.len());
        assert!(own.receptance.iter().all(|h| h.re.is_finite() && h.im.is_finite()));
        assert!(own.weights.iter().all(|weight| weight.is_finite() && *weight > 0.0));
    }
}

/// Arrays of a MATLAB file, of level 5 or HDF5.
pub fn matlab(bytes: &[u8]) {
    let found = match matlab::read("log.mat", bytes.to_vec(), &["rec.a", "rec.more.flat"]) {
        Err(problems) => return refused(&problems),
        Ok(found) => found,
    };
    assert!(found.requested.len() == 2);
    for found in found.requested {
        let matlab::Requested::Array(array) = found else { continue };
        assert!(array.dimensions.iter().product::<usize>() == array.values.len());
    }
}
