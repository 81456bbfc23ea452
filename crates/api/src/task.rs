//! The kinds of jobs, each equal to a command.
//!
//! | kind | as the command | results in |
//! |---|---|---|
//! | `run` | `armill run` | `out` |
//! | `posture` | `armill posture` | `posture` |
//! | `place` | `armill place`; continues where it was stopped | `place` |
//! | `advise` | `armill advise`; continues where it was stopped | `advice` and `advised` |
//! | `compensate` | `armill compensate` | `compensated`, its program in `programs` |
//! | `identify` | `armill identify` | `identify` |

use armill_study::file::placement::PlaceTable;
use armill_study::input::posture_search::SearchTable;
use schemars::JsonSchema;
use serde::Deserialize;

/// The task of a job.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Task {
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
    /// Measures that bring a path within its tolerance.
    Advise {
        /// The text of the study.
        text: String,
        /// Options of its search for a place.
        #[serde(default)]
        options: Box<PlaceOptions>,
    },
    /// The paths to command, and a robot program along one.
    Compensate {
        /// The text of the study.
        text: String,
        /// Options of the compensation.
        #[serde(default)]
        options: CompensateOptions,
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
pub struct RunOptions {
    /// Only this analysis.
    pub analysis: Option<String>,
    /// Tables only: no pictures, no report.
    #[serde(default)]
    pub no_pictures: bool,
}

/// Options of a placement.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaceOptions {
    /// As `[place]` of a study, whose values are used for what is left out.
    #[serde(default)]
    pub place: PlaceTable,
    /// Seed of the search; 1 if left out.
    pub seed: Option<u32>,
}

/// Options of a compensation.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CompensateOptions {
    /// Only this path, or set of holes.
    pub analysis: Option<String>,
    /// The nominal path is commanded, not the compensated one.
    #[serde(default)]
    pub nominal: bool,
    /// Whether a robot program is also written.
    #[serde(default)]
    pub program: bool,
    /// The language of the program, by the extension of its files; that of the robot's controllers if left out.
    pub extension: Option<String>,
    /// Feed of the program, if the path does not specify one.
    pub feed_mm_per_min: Option<f64>,
}

/// Options of an identification.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IdentifyOptions {
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
pub enum PointsName {
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
    pub fn kind(&self) -> &'static str {
        match self {
            Task::Run { .. } => "run",
            Task::Posture { .. } => "posture",
            Task::Place { .. } => "place",
            Task::Advise { .. } => "advise",
            Task::Compensate { .. } => "compensate",
            Task::Identify { .. } => "identify",
        }
    }

    /// The analysis that it was requested for, if it was for one.
    pub fn analysis(&self) -> Option<&str> {
        match self {
            Task::Run { options, .. } => options.analysis.as_deref(),
            Task::Place { options, .. } | Task::Advise { options, .. } => options.place.analysis.as_deref(),
            Task::Compensate { options, .. } => options.analysis.as_deref(),
            Task::Posture { .. } | Task::Identify { .. } => None,
        }
    }

    /// The text of its study.
    pub fn text(&self) -> &str {
        match self {
            Task::Run { text, .. }
            | Task::Posture { text, .. }
            | Task::Place { text, .. }
            | Task::Advise { text, .. }
            | Task::Compensate { text, .. }
            | Task::Identify { text, .. } => text,
        }
    }
}
