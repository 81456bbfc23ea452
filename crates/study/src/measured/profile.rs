//! The points of a round profile, from their file.

use std::io::BufReader;
use std::path::Path;

use armill_formats::input;
use armill_formats::measurement::profile::{self, MeasuredProfile, ProfileReadOptions};

use crate::error::StudyError;

/// Reads the profile in `path`; `shown` is its name in problems.
///
/// # Errors
/// The file cannot be read; its problems.
pub fn read(shown: &str, path: &Path, requested: &ProfileReadOptions) -> Result<MeasuredProfile, StudyError> {
    let file = input::open(path).map_err(|error| {
        StudyError::value(
            format!("cannot read {shown}: {error}"),
            "a table with `x_mm,y_mm` or `angle_deg,radius_mm`, or rows of numbers with --unit",
        )
    })?;
    Ok(profile::read(shown, BufReader::new(file), requested)?)
}
