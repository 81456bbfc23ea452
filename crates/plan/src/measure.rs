//! A recommended change of a study that can be applied by itself.

use armill_study::live::ChangedValue;
use schemars::JsonSchema;
use serde::Serialize;

/// What a result recommends: in words, and as values of the study.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Measure {
    /// `placement`, `spin`, `spindle`, `axial_depth`, `radial_depth`, `feed`, `compensation` or `robot`.
    pub measure: &'static str,
    /// A sentence with its gain.
    pub sentence: String,
    /// The analysis that values not of the whole study belong to; `null` if all are of the study.
    pub analysis: Option<String>,
    /// The changed values; none of a compensation, which is a program.
    pub changes: Vec<ChangedValue>,
}
