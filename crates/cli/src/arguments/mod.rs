//! What can be typed behind `armill`: a file here for each command of the same name in `command`.
//!
//! `run`, `check`, `compare`, `new`, `robots`, `materials`, `pose`, `posture`, `place`, `advise`, `compensate`,
//! `identify`, `calibrate`, `forces`, `roundness`, `ballbar`, `backlash`, `budget`, `pose_accuracy`, `path_accuracy`, `serve`, `completions`, `man`; `poses` and `program` are for two of them each, `writing` for all that write files.
//!
//! Doc comments of fields and variants are the text of `--help`: one line without a full stop, the unit in the
//! option's name. What a developer should know stands in `//` comments and in these heads. Names of options are
//! names of fields with hyphens; `--json` is an option of every command that has an answer.
//!
//! Clap checks that options go together and that numbers are numbers; how many there are, and whether they can
//! be, is checked in `command`, so that all refusals sound alike.

mod advise;
mod backlash;
mod ballbar;
mod budget;
mod calibrate;
mod check;
mod compare;
mod compensate;
mod completions;
mod forces;
mod identify;
mod man;
mod materials;
mod new;
mod path_accuracy;
mod place;
mod pose;
mod pose_accuracy;
mod poses;
mod posture;
mod program;
mod robots;
mod roundness;
mod run;
mod serve;
mod writing;

pub(crate) use advise::AdviseArguments;
pub(crate) use backlash::BacklashArguments;
pub(crate) use ballbar::{BallbarArguments, CentreChoice};
pub(crate) use budget::BudgetArguments;
pub(crate) use calibrate::{CalibrateArguments, UnknownsArgument};
pub(crate) use check::CheckArguments;
pub(crate) use compare::CompareArguments;
pub(crate) use compensate::CompensateArguments;
pub(crate) use completions::CompletionsArguments;
pub(crate) use forces::ForcesArguments;
pub(crate) use identify::{IdentifyArguments, PointsArgument, PriorArgument};
pub(crate) use man::ManArguments;
pub(crate) use materials::MaterialsArguments;
pub(crate) use new::NewArguments;
pub(crate) use path_accuracy::PathAccuracyArguments;
pub(crate) use place::{PlaceArguments, PlaceOptions};
pub(crate) use pose::PoseArguments;
pub(crate) use pose_accuracy::PoseAccuracyArguments;
pub(crate) use poses::{PosesOptions, TurnArgument};
pub(crate) use posture::PostureArguments;
pub(crate) use program::ProgramOptions;
pub(crate) use robots::{ImportArguments, RobotsAction, RobotsArguments, RobotsCheckArguments};
pub(crate) use roundness::RoundnessArguments;
pub(crate) use run::{RunArguments, RunOptions};
pub(crate) use serve::ServeArguments;

use clap::{Parser, Subcommand};

/// What every option says that takes a robot.
const ROBOT_HELP: &str = "Library name, or a robot file (.toml, .urdf, .xacro, .yaml, .dh, .chain)";

/// How far from the drawing will this robot cut, why, and what can be done about it?
#[derive(Debug, Parser)]
#[command(name = "armill", version, propagate_version = true, arg_required_else_help = true, after_help = EXAMPLES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

const EXAMPLES: &str = "\
Examples:
  armill run studies/mh12-groove            the paper's study, with pictures and a report in its folder out/
  armill new cell && armill run cell        your own, from a commented study file
  armill pose yaskawa/mh12 --at-mm 1000,0,800 --wrench-n 3,5,5
Lengths in mm, angles in degrees, forces in N, moments in N m; deviations come back in micrometres.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a study: numbers, tables, pictures and a report
    Run(RunArguments),
    /// Check a study file without running it
    Check(CheckArguments),
    /// The same path in several cells: robots or set-ups side by side
    Compare(CompareArguments),
    /// Make a folder with a commented study that runs
    New(NewArguments),
    /// List the robot library, show one robot, or import one
    Robots(RobotsArguments),
    /// List the material library, or show one material
    Materials(MaterialsArguments),
    /// Every posture of one pose: joints, compliance, deviation
    Pose(Box<PoseArguments>),
    /// The best turn of the tool and branch along the paths of a study
    Posture(PostureArguments),
    /// Where the part should lie so that a path deviates least
    Place(Box<PlaceArguments>),
    /// What to do so that a path holds its tolerance: place, turn, compensation, cut
    Advise(Box<AdviseArguments>),
    /// The paths to command so that the tool goes where it is drawn
    Compensate(CompensateArguments),
    /// Joint compliances from load tests, and which tests to do
    Identify(IdentifyArguments),
    /// Lengths, angles and zeros of this very arm from measured poses
    Calibrate(Box<CalibrateArguments>),
    /// What is in a record of a dynamometer, without drift and teeth
    Forces(ForcesArguments),
    /// How round a measured profile is: the four reference circles, filter, harmonics
    Roundness(RoundnessArguments),
    /// How round the tool goes, and why not rounder, from a ball-bar
    Ballbar(Box<BallbarArguments>),
    /// How much play each joint has, from a ball-bar; which circles tell; made-up tests
    Backlash(Box<BacklashArguments>),
    /// How near the arm comes to its poses, and how alike, from a laser tracker
    PoseAccuracy(Box<PoseAccuracyArguments>),
    /// How near the tip keeps to a path, and how alike, from a laser tracker
    PathAccuracy(PathAccuracyArguments),
    /// What the error of a measured circle is made of, and how much of it is predicted
    Budget(BudgetArguments),
    /// The live page of a study in the browser, on this machine alone
    Serve(ServeArguments),
    /// Print shell completions
    Completions(CompletionsArguments),
    /// Write the manual pages into a folder
    Man(ManArguments),
}

impl Command {
    /// Whether stdout is to hold JSON, also of problems.
    pub(crate) fn wants_json(&self) -> bool {
        match self {
            Command::Run(a) => a.run.json,
            Command::Check(a) => a.json,
            Command::Compare(a) => a.json,
            Command::New(a) => a.json,
            Command::Robots(a) => match &a.action {
                Some(RobotsAction::Import(import)) => import.json,
                Some(RobotsAction::Check(check)) => check.json,
                None => a.json,
            },
            Command::Materials(a) => a.json,
            Command::Pose(a) => a.json,
            Command::Posture(a) => a.run.json,
            Command::Place(a) => a.run.json,
            Command::Advise(a) => a.run.json,
            Command::Compensate(a) => a.json,
            Command::Identify(a) => a.json,
            Command::Calibrate(a) => a.json,
            Command::Forces(a) => a.json,
            Command::Roundness(a) => a.json,
            Command::Ballbar(a) => a.json,
            Command::Backlash(a) => a.json,
            Command::PoseAccuracy(a) => a.json,
            Command::PathAccuracy(a) => a.json,
            Command::Budget(a) => a.json,
            Command::Serve(_) | Command::Completions(_) | Command::Man(_) => false,
        }
    }
}
