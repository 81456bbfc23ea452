//! Roundness: points of a profile, from their file to the four circles of the standard.
//!
//! ```text
//! file -> Measured -> evaluate: plane, circles, filter, harmonics, outliers -> RoundnessAnswer, table, picture
//! ```
//!
//! [`evaluate`](mod@evaluate): the circles of a profile, and its other quantities. [`answer`](mod@answer): the values
//! of the
//! numbers. [`output`]: table and picture of it.

pub mod answer;
pub mod evaluate;
pub mod output;

pub use answer::{CircleAnswer, RoundnessAnswer, ZoneAnswer, answer};
pub use evaluate::{Question, RoundnessEvaluation, evaluate};

use std::io::BufReader;
use std::path::Path;

use armill_formats::input;
use armill_formats::measurement::profile::{self, MeasuredProfile, ProfileReadOptions};

use crate::StudyError;

/// Reads the profile in `path`; `shown` is its name in problems.
///
/// # Errors
/// The file cannot be read; its problems.
pub fn read(
    (shown, path): (&str, &Path),
    requested: &ProfileReadOptions,
) -> Result<MeasuredProfile, StudyError> {
    let file = input::open(path).map_err(|error| {
        StudyError::value(
            format!("cannot read {shown}: {error}"),
            "a table with `x_mm,y_mm` or `angle_deg,radius_mm`, or rows of numbers with --unit",
        )
    })?;
    Ok(profile::read(shown, BufReader::new(file), requested)?)
}
