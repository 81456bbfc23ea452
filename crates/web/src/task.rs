//! The kinds of jobs, each equal to a command.
//!
//! | kind | as the command | results in |
//! |---|---|---|
//! | `run` | `armill run` | `out` |
//! | `posture` | `armill posture` | `posture` |
//! | `place` | `armill place`; continues where it was stopped | `place` |
//! | `identify` | `armill identify` | `identify` |

use armill_study::file::placement::PlaceTable;
use armill_study::input::posture_search::SearchTable;
use schemars::JsonSchema;
use serde::Deserialize;

/// The task of a job.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Task {
    /// Every analysis of the study.
    Run {
        /// The text of the study.
        text: String,
        /// Options of the run.
        #[serde(default)]
        options: RunOptions,
    },
    /// The best spin of the tool and branch along its paths.
    Posture {
        /// The text of the study.
        text: String,
        /// The options of the search; those of the study if left out.
        options: Option<SearchTable>,
    },
    /// The best place of the part.
    Place {
        /// The text of the study.
        text: String,
        /// Options of the placement.
        #[serde(default)]
        options: Box<PlaceOptions>,
    },
    /// Identification of compliances from load tests.
    Identify {
        /// The text of the study, whose robot was loaded.
        text: String,
        /// Options of the identification.
        options: IdentifyOptions,
    },
}

/// Options of a run.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RunOptions {
    /// Only this analysis.
    pub analysis: Option<String>,
    /// Tables only: no pictures, no report.
    #[serde(default)]
    pub no_pictures: bool,
}

/// Options of a placement.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlaceOptions {
    /// As `[place]` of a study, whose values are used for what is left out.
    #[serde(default)]
    pub place: PlaceTable,
    /// Seed of the search; 1 if left out.
    pub seed: Option<u32>,
}

/// Options of an identification.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct IdentifyOptions {
    /// The table of tests, a file of the folder.
    pub tests: String,
    /// Groups of unknowns with `+` between; `drives+bending+base` if left out.
    pub unknowns: Option<String>,
    /// Model of the two points: `known`, `common` or `separate`; `known` if left out.
    #[serde(default)]
    pub points: PointsName,
    /// Standard uncertainty of points that are not known.
    pub point_u_mm: Option<f64>,
    /// Default point of force and displacement, flange frame.
    pub tool_mm: Option<[f64; 3]>,
}

/// Model of the two points.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum PointsName {
    /// Both, as given.
    #[default]
    Known,
    /// Both have the same offset.
    Common,
    /// Each has its own offset.
    Separate,
}

impl Task {
    /// Its name.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Task::Run { .. } => "run",
            Task::Posture { .. } => "posture",
            Task::Place { .. } => "place",
            Task::Identify { .. } => "identify",
        }
    }

    /// The text of its study.
    pub(crate) fn text(&self) -> &str {
        match self {
            Task::Run { text, .. }
            | Task::Posture { text, .. }
            | Task::Place { text, .. }
            | Task::Identify { text, .. } => text,
        }
    }
}
