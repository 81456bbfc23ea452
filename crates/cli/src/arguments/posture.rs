//! `armill posture STUDY`: the best spin of the tool and branch along the paths of a study.

use armill_study::input::posture_search::{ComponentName, ObjectiveName};
use clap::{Args, ValueEnum};

use super::run::RunOptions;

// Without any of these options `posture.search` of the study is used; with one or more they replace all of it.
#[derive(Debug, Args)]
#[command(after_help = POSTURE_EXAMPLES)]
pub(crate) struct PostureArguments {
    #[command(flatten)]
    pub run: RunOptions,

    /// Objective to minimise
    #[arg(long)]
    pub objective: Option<ObjectiveArgument>,

    /// Component of the deviation to minimise
    #[arg(long)]
    pub component: Option<ComponentArgument>,

    /// Range of the spin of the tool about its axis, relative to that of the study [default: -180,180]
    #[arg(
        long,
        value_name = "FIRST,LAST",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub turns_deg: Option<Vec<f64>>,

    /// Step of the spin [default: 5]
    #[arg(long, value_name = "DEG")]
    pub step_deg: Option<f64>,

    /// Maximum change of the spin per length of the path [default: 1]
    #[arg(long, value_name = "DEG/MM")]
    pub turn_deg_per_mm: Option<f64>,

    /// Minimum angle of the wrist from its straight position [default: 3]
    #[arg(long, value_name = "DEG")]
    pub least_wrist_deg: Option<f64>,

    /// Minimum distance of every joint from its limits [default: 0]
    #[arg(long, value_name = "DEG")]
    pub margin_deg: Option<f64>,

    /// Penalty for each reversal of a joint, as deviation times path length [default: 0]
    #[arg(long, value_name = "UM*MM")]
    pub reversal_um_mm: Option<f64>,
}

/// `--objective`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ObjectiveArgument {
    /// The largest deviation along the path
    Worst,
    /// The mean deviation along the path
    Mean,
    /// The deviation above the tolerance
    AboveTolerance,
}

/// `--component`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ComponentArgument {
    /// Perpendicular to the tool axis
    InPlane,
    /// Perpendicular to tool axis and feed: the error of walls
    CrossTrack,
    /// Along the tool axis: the error of floors
    Axial,
}

impl From<ObjectiveArgument> for ObjectiveName {
    fn from(objective: ObjectiveArgument) -> ObjectiveName {
        match objective {
            ObjectiveArgument::Worst => ObjectiveName::Worst,
            ObjectiveArgument::Mean => ObjectiveName::Mean,
            ObjectiveArgument::AboveTolerance => ObjectiveName::AboveTolerance,
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
  armill posture cell                              any spin of the tool, in all branches
  armill posture cell --turns-deg -30,30 --objective mean
  armill posture cell --component cross-track --step-deg 2 --out best
  armill posture cell --reversal-um-mm 200         fewer reversals: one weighs as much as 20 um over 10 mm
Spins and branches change only where that is an improvement beyond its uncertainty (`improvement` in the study).
The results are those of `armill run` with these spins, which are in the column turn_deg of the table of each path.
The picture NAME-turns.svg shows the deviation of every spin.";
