//! The table of residuals, their drawing, and the calibrated robot file.
//!
//! ```text
//! set, line, before_x_mm .. before_mm, after_x_mm .. after_mm       training and validation; axes of the tracker
//! ```

use std::fmt::Write;

use armill_core::calibrate::PoseErrors;
use armill_core::robot::Robot;
use armill_core::units::to_mm;
use armill_formats::robot::armill::{Geometry, GeometryCovarianceTable, with_geometry};
use armill_report::{ErrorDistribution, ErrorSet, ModelErrors};
use armill_study::StudyError;

use super::answer::CalibrateAnswer;
use super::calibration::{Calibration, PoseSet};

/// Measured less predicted position of every pose, as CSV.
pub fn residuals(calibration: &Calibration) -> String {
    let mut text =
        "set,line,before_x_mm,before_y_mm,before_z_mm,before_mm,after_x_mm,after_y_mm,after_z_mm,after_mm\n"
            .to_owned();
    let mut add = |name: &str, set: &PoseSet| {
        for (place, line) in set.lines.iter().enumerate() {
            let _ = write!(text, "{name},{line}");
            for errors in [&set.before, &set.after] {
                let error = to_mm(errors.position[place]);
                let _ = write!(
                    text,
                    ",{:.4},{:.4},{:.4},{:.4}",
                    error.x,
                    error.y,
                    error.z,
                    error.norm()
                );
            }
            text.push('\n');
        }
    };
    add("training", &calibration.training);
    if let Some(set) = &calibration.validation {
        add("validation", set);
    }
    text
}

/// Errors of position before and after, as SVG.
pub fn drawing(given: &CalibrateAnswer, calibration: &Calibration) -> String {
    let lengths = |errors: &PoseErrors| errors.position.iter().map(|e| to_mm(e.norm())).collect();
    let of = |name: &str, set: &PoseSet| ErrorSet {
        name: name.to_owned(),
        models: [("before", &set.before), ("after", &set.after)]
            .map(|(name, errors)| ModelErrors {
                name: name.to_owned(),
                errors_mm: lengths(errors),
            })
            .to_vec(),
    };
    let mut sets = vec![of("training", &calibration.training)];
    sets.extend(calibration.validation.as_ref().map(|set| of("validation", set)));
    let validation = match &given.validation {
        Some(set) => format!(", {} validation poses", set.poses),
        None => String::new(),
    };
    ErrorDistribution {
        title: format!("{}: errors of position", given.robot),
        subtitle: format!("{} training poses{validation}", given.training.poses),
        quantity: "distance of measured from predicted (mm)".to_owned(),
        sets,
    }
    .to_svg()
}

/// The robot file `text` (at `path`) with the identified corrections.
///
/// # Errors
/// A robot file that is not TOML, or that no longer reads with these motions in it.
pub fn robot_file(
    robot: &Robot,
    [path, text]: [&str; 2],
    calibration: &Calibration,
) -> Result<String, StudyError> {
    let after = (0..robot.joints().len())
        .map(|joint| {
            (
                robot.joints()[joint].name.clone(),
                calibration.after.motions_after(joint),
            )
        })
        .filter(|(_, motions)| !motions.is_empty())
        .collect();
    let rms = |set: &PoseSet| set.after.of_position().map_or(0.0, |spread| to_mm(spread.rms));
    let validation = calibration.validation.as_ref().map_or(String::new(), |set| {
        format!("; {} validation poses: {:.3} mm rms", set.lines.len(), rms(set))
    });
    let what = format!(
        "corrections identified by armill from {} measured poses, {:.3} mm rms{validation}",
        calibration.training.lines.len(),
        rms(&calibration.training)
    );
    let geometry = Geometry {
        after,
        what,
        place: calibration.training.file.clone(),
        covariance: (calibration.after.uncertainty())
            .map(|geometry| GeometryCovarianceTable::of(robot, &geometry)),
    };
    Ok(with_geometry(path, text, &geometry)?)
}
