//! The robot file with the values that were learnt.

use std::fmt::Write;

use armill_core::units::{to_mm, to_ms};
use armill_formats::robot::armill::{LearnedMotion, with_motion};
use armill_study::StudyError;

use super::learned::Learned;

/// The robot file `text` (at `path`) with the values of `[motion]` that the log determines.
///
/// # Errors
/// A robot file that is not TOML, or that no longer reads with these values.
pub fn robot_file([path, text]: [&str; 2], learned: &Learned) -> Result<String, StudyError> {
    let [acceleration_u, smoothing_u, lag_u, settling_u] = learned.fitted.u;
    let table = &learned.table;
    let mut what = format!(
        "learnt by armill from a joint log of {} instants; standard uncertainties:",
        learned.log.times.len()
    );
    let mut named = Vec::new();
    if table.path_acceleration_mm_per_s2.is_some() {
        named.push(format!(
            "acceleration along the path {:.2} mm/s^2",
            to_mm(acceleration_u)
        ));
    }
    if table.smoothing_ms.is_some() {
        named.push(format!("window {:.2} ms", to_ms(smoothing_u)));
    }
    if table.lag_ms.is_some() {
        named.push(format!("lag {:.2} ms", to_ms(lag_u)));
    }
    if table.settling_ms.is_some() {
        named.push(format!("time to settle {:.2} ms", to_ms(settling_u)));
    }
    if named.is_empty() {
        named.push("no value is determined but the accelerations that were reached".to_owned());
    }
    let _ = write!(what, " {}", named.join(", "));
    let learned = LearnedMotion {
        table: table.clone(),
        what,
        place: learned.file.clone(),
    };
    Ok(with_motion(path, text, &learned)?)
}
