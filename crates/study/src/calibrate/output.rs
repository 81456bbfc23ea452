//! The table of residuals, their drawing, and the robot file with what was found.
//!
//! ```text
//! set, line, before_x_mm .. before_mm, after_x_mm .. after_mm       training and held out; axes of the tracker
//! ```

use std::fmt::Write;

use armill_core::calibrate::PoseErrors;
use armill_core::robot::Robot;
use armill_formats::robot::armill::{Geometry, with_geometry};
use armill_report::{ErrorDistribution, ErrorSet};

use super::answer::CalibrateAnswer;
use super::calibration::{Calibration, Set};
use crate::StudyError;

/// Measured less predicted position of every pose, as CSV.
pub fn residuals(calibration: &Calibration) -> String {
    let mut text =
        "set,line,before_x_mm,before_y_mm,before_z_mm,before_mm,after_x_mm,after_y_mm,after_z_mm,after_mm\n"
            .to_owned();
    let mut add = |name: &str, set: &Set| {
        for (place, line) in set.lines.iter().enumerate() {
            let _ = write!(text, "{name},{line}");
            for errors in [&set.before, &set.after] {
                let error = errors.position[place] * 1e3;
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
    if let Some(set) = &calibration.held_out {
        add("held out", set);
    }
    text
}

/// Errors of position before and after, as SVG.
pub fn drawing(given: &CalibrateAnswer, calibration: &Calibration) -> String {
    let lengths = |errors: &PoseErrors| errors.position.iter().map(|e| e.norm() * 1e3).collect();
    let of = |name: &str, set: &Set| ErrorSet {
        name: name.to_owned(),
        before_mm: lengths(&set.before),
        after_mm: lengths(&set.after),
    };
    let mut sets = vec![of("found from", &calibration.training)];
    sets.extend(calibration.held_out.as_ref().map(|set| of("held out", set)));
    let held_out = match &given.held_out {
        Some(set) => format!(", {} held out", set.poses),
        None => String::new(),
    };
    ErrorDistribution {
        title: format!("{}: errors of position", given.robot),
        subtitle: format!("{} poses found from{held_out}", given.training.poses),
        quantity: "distance of measured from predicted (mm)".to_owned(),
        sets,
    }
    .to_svg()
}

/// The robot file `text` (at `path`) with the small motions that were found.
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
    let rms = |set: &Set| set.after.of_position().map_or(0.0, |spread| spread.rms * 1e3);
    let held_out = calibration.held_out.as_ref().map_or(String::new(), |set| {
        format!(
            "; {} poses held out are met within {:.3} mm rms",
            set.lines.len(),
            rms(set)
        )
    });
    let what = format!(
        "small motions calibrated by armill from {} measured poses, met within {:.3} mm rms{held_out}",
        calibration.training.lines.len(),
        rms(&calibration.training)
    );
    let geometry = Geometry {
        after,
        what,
        place: calibration.training.file.clone(),
    };
    Ok(with_geometry(path, text, &geometry)?)
}
