//! `armill posture STUDY`: the best turn of the tool and branch along the paths of a study.

use armill_study::file::posture_search::{ComponentName, ObjectiveName};
use clap::{Args, ValueEnum};

use super::run::RunOptions;

// Without any of the numbers the study's own `posture.search` counts; with one they stand for all of it.
#[derive(Debug, Args)]
#[command(after_help = POSTURE_EXAMPLES)]
pub(crate) struct PostureArguments {
    #[command(flatten)]
    pub run: RunOptions,

    /// What shall be least
    #[arg(long)]
    pub objective: Option<ObjectiveArgument>,

    /// Which part of the deviation counts
    #[arg(long)]
    pub component: Option<ComponentArgument>,

    /// First and last turn of the tool about its axis, beside the one it has [default: -180,180]
    #[arg(
        long,
        value_name = "FIRST,LAST",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub turns_deg: Option<Vec<f64>>,

    /// From one turn to the next [default: 5]
    #[arg(long, value_name = "DEG")]
    pub step_deg: Option<f64>,

    /// How much the tool may turn along the path [default: 1]
    #[arg(long, value_name = "DEG/MM")]
    pub turn_deg_per_mm: Option<f64>,

    /// Least angle by which the wrist is bent [default: 3]
    #[arg(long, value_name = "DEG")]
    pub least_wrist_deg: Option<f64>,

    /// What a joint that turns back weighs: as much as so much more deviation over 1 mm of the path [default: 0]
    #[arg(long, value_name = "UM*MM")]
    pub reversal_um_mm: Option<f64>,
}

/// `--goal`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ObjectiveArgument {
    /// The largest deviation along the path
    Worst,
    /// The mean of its points
    Mean,
    /// What is above the limit
    AboveLimit,
}

/// `--counts`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ComponentArgument {
    /// Across the tool
    InPlane,
    /// Across tool and feed: what walls get
    CrossTrack,
    /// Along the tool: what floors get
    Axial,
}

impl From<ObjectiveArgument> for ObjectiveName {
    fn from(objective: ObjectiveArgument) -> ObjectiveName {
        match objective {
            ObjectiveArgument::Worst => ObjectiveName::Worst,
            ObjectiveArgument::Mean => ObjectiveName::Mean,
            ObjectiveArgument::AboveLimit => ObjectiveName::AboveLimit,
        }
    }
}

impl From<ComponentArgument> for ComponentName {
    fn from(component: ComponentArgument) -> ComponentName {
        match component {
            ComponentArgument::InPlane => ComponentName::InPlane,
            ComponentArgument::CrossTrack => ComponentName::CrossTrack,
            ComponentArgument::Axial => ComponentName::Axial,
        }
    }
}

const POSTURE_EXAMPLES: &str = "\
Examples:
  armill posture cell                              the tool free about its axis, in every branch
  armill posture cell --turns-deg -30,30 --goal mean
  armill posture cell --counts cross-track --step-deg 2 --out best
  armill posture cell --reversal-um-mm 200         fewer reversals: each is worth 20 um more over 10 mm
The result is that of `armill run` with the turns found; the table of a path has them as turn_deg, the picture
NAME-turns.svg shows what each turn would bring.";
