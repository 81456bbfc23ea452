//! The answer to the check of a study that can be run: no problems, and the values that are probably slips.

use armill_formats::document::Problem;
use schemars::JsonSchema;
use serde::Serialize;

use crate::file::resolve::Study;
use crate::file::slips;

/// What a check finds in a study file, as `armill check --json` prints it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct CheckAnswer {
    /// All problems; none of a study that can be run.
    pub problems: Vec<Problem>,
    /// Values that are probably slips, a sentence each, as in `warnings` of a result.
    pub warnings: Vec<String>,
}

impl CheckAnswer {
    /// That of a study without problems.
    pub fn of(study: &Study) -> CheckAnswer {
        CheckAnswer {
            problems: Vec::new(),
            warnings: slips::of_study(study),
        }
    }
}
