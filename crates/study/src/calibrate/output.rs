//! The table of residuals, and the robot file with what was found.
//!
//! ```text
//! set, line, before_x_mm .. before_mm, after_x_mm .. after_mm       training and held out; axes of the tracker
//! ```

use std::fmt::Write;

use armill_core::robot::Robot;
use armill_formats::robot::armill::{Geometry, with_geometry};

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
