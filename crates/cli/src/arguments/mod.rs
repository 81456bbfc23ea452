//! Arguments of `armill`: one file per command, with the same name as in `command`.
//!
//! `run`, `check`, `compare`, `new`, `robots`, `export`, `materials`, `pose`, `posture`, `place`, `advise`, `compensate`,
//! `identify`, `calibrate`, `learn`, `journal`, `tracker`, `forces`, `roundness`, `ballbar`, `backlash`, `budget`, `pose_accuracy`, `path_accuracy`, `motion`, `drives`, `frf`, `modes`, `receptance`,
//! `stability`, `serve`, `completions`, `man`; `poses` and `program` are used by two of them each, `writing` by all that write
//! files; `renamed` has the options of earlier versions.
//!
//! Doc comments of fields and variants are the text of `--help`: one line without a full stop, the unit in the
//! option's name. Notes for developers are in `//` comments and in these module docs. Names of options are
//! names of fields with hyphens; every command that has a result has the option `--json`.
//!
//! Clap checks combinations of options and that numbers are numbers; how many there are, and their range,
//! is checked with `numbers`, so that all error messages have the same form.

mod advise;
mod backlash;
mod ballbar;
mod budget;
mod calibrate;
mod check;
mod compare;
mod compensate;
mod completions;
mod drives;
mod export;
mod forces;
mod frf;
mod identify;
mod journal;
mod learn;
mod man;
mod materials;
mod modes;
mod motion;
mod new;
pub(crate) mod numbers;
mod path_accuracy;
mod place;
mod pose;
mod pose_accuracy;
mod poses;
mod posture;
mod program;
mod receptance;
mod renamed;
mod robots;
mod roundness;
mod run;
mod serve;
mod stability;
mod tracker;
mod writing;

pub(crate) use advise::AdviseArguments;
pub(crate) use backlash::BacklashArguments;
pub(crate) use ballbar::BallbarArguments;
pub(crate) use budget::BudgetArguments;
pub(crate) use calibrate::{CalibrateArguments, UnknownsArgument};
pub(crate) use check::CheckArguments;
pub(crate) use compare::CompareArguments;
pub(crate) use compensate::CompensateArguments;
pub(crate) use completions::CompletionsArguments;
pub(crate) use drives::DrivesArguments;
pub(crate) use export::{CouplingArgument, ExportArguments, StiffnessArgument};
pub(crate) use forces::ForcesArguments;
pub(crate) use frf::FrfArguments;
pub(crate) use identify::{IdentifyArguments, PointsArgument, PriorArgument};
pub(crate) use journal::JournalArguments;
pub(crate) use learn::{LearnArguments, LearnUnknownsArgument};
pub(crate) use man::ManArguments;
pub(crate) use materials::MaterialsArguments;
pub(crate) use modes::ModesArguments;
pub(crate) use motion::MotionArguments;
pub(crate) use new::NewArguments;
pub(crate) use path_accuracy::PathAccuracyArguments;
pub(crate) use place::{PlaceArguments, PlaceOptions};
pub(crate) use pose::PoseArguments;
pub(crate) use pose_accuracy::PoseAccuracyArguments;
pub(crate) use poses::{PosesOptions, TurnArgument};
pub(crate) use posture::PostureArguments;
pub(crate) use program::ProgramOptions;
pub(crate) use receptance::ReceptanceArguments;
pub(crate) use renamed::with_present_name;
pub(crate) use robots::{
    BodiesArguments, ImportArguments, MassesArguments, RobotsAction, RobotsArguments, RobotsCheckArguments,
};
pub(crate) use roundness::RoundnessArguments;
pub(crate) use run::{RunArguments, RunOptions};
pub(crate) use serve::ServeArguments;
pub(crate) use stability::StabilityArguments;
pub(crate) use tracker::{JointUnitArgument, TrackerArguments};
pub(crate) use writing::WritingOptions;

use clap::{Parser, Subcommand};

/// Predict, explain and reduce the machining error of industrial robots.
#[derive(Debug, Parser)]
#[command(name = "armill", version, propagate_version = true, arg_required_else_help = true, after_help = EXAMPLES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

const EXAMPLES: &str = "\
Examples:
  armill run studies/mh12-groove            an example study; pictures and a report are in its folder out/
  armill new cell && armill run cell        your own study, from a commented study file
  armill pose yaskawa/mh12 --at-mm 1000,0,800 --wrench-n 3,5,5
Lengths in mm, angles in degrees, forces in N, moments in N m; deviations are reported in micrometres.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a study: numbers, tables, pictures and a report
    Run(RunArguments),
    /// Check a study file without running it
    Check(CheckArguments),
    /// Compare the same paths in several cells: different robots or set-ups
    Compare(CompareArguments),
    /// Create a folder with a commented study that is ready to run
    New(NewArguments),
    /// List the robot library, show one robot, or import one
    Robots(RobotsArguments),
    /// Write a robot for other programs: URDF, xacro, UR calibration, DH table, SDF, MJCF
    Export(ExportArguments),
    /// List the material library, or show one material
    Materials(MaterialsArguments),
    /// List all postures of one pose: joints, compliance, deviation
    Pose(Box<PoseArguments>),
    /// List the modes of vibration in one posture: frequencies, directions, joints
    Modes(ModesArguments),
    /// Optimise the spin of the tool and the branch along the paths of a study
    Posture(PostureArguments),
    /// Optimise the placement of the part for the least deviation along a path
    Place(Box<PlaceArguments>),
    /// Recommend measures to bring a path within its tolerance: placement, spin, compensation, cut
    Advise(Box<AdviseArguments>),
    /// Compensate the paths of a study for the predicted deviation
    Compensate(CompensateArguments),
    /// Identify joint compliances from load tests, or plan the tests
    Identify(IdentifyArguments),
    /// Calibrate the kinematics from measured poses
    Calibrate(Box<CalibrateArguments>),
    /// Learn from measured poses what the calibrated kinematics leaves, and try it on poses held out
    Learn(Box<LearnArguments>),
    /// Learn geometry, compliances and backlash from all measurements of an arm, and plan further ones
    Journal(Box<JournalArguments>),
    /// Combine files of a laser tracker and joint positions into a table of poses; find misread reflectors
    Tracker(TrackerArguments),
    /// Analyse a dynamometer record: remove drift, average over spindle revolutions
    Forces(ForcesArguments),
    /// Evaluate the roundness of a measured profile: four reference circles, filter, harmonics
    Roundness(RoundnessArguments),
    /// Analyse a ball-bar test: circularity and its causes
    Ballbar(Box<BallbarArguments>),
    /// Estimate joint backlash from ball-bar tests, plan circles, or simulate tests
    Backlash(Box<BacklashArguments>),
    /// Evaluate pose accuracy and repeatability from laser tracker data
    PoseAccuracy(Box<PoseAccuracyArguments>),
    /// Evaluate path accuracy and repeatability from laser tracker data
    PathAccuracy(PathAccuracyArguments),
    /// Learn from joint logs how a controller moves an arm: accelerations, smoothing, lag, zones
    Motion(MotionArguments),
    /// Determine friction, load, torsion and stiffness of drives from motor torques and encoders
    Drives(DrivesArguments),
    /// Determine the modes of a tool or an arm from measured frequency response functions
    Frf(FrfArguments),
    /// Predict the receptance at the tip of a tool: arm, holder and cutter coupled
    Receptance(Box<ReceptanceArguments>),
    /// Evaluate the stability of a cut against chatter: lobes, limits of the depth, vibration
    Stability(Box<StabilityArguments>),
    /// Compare the measured error of a circle with its predicted contributions
    Budget(BudgetArguments),
    /// Serve the live page of a study to the browser on this machine
    Serve(ServeArguments),
    /// Print shell completions
    Completions(CompletionsArguments),
    /// Write the manual pages into a folder
    Man(ManArguments),
}

impl Command {
    /// Whether stdout is JSON, also for errors.
    pub(crate) fn wants_json(&self) -> bool {
        match self {
            Command::Run(a) => a.run.json,
            Command::Check(a) => a.json,
            Command::Compare(a) => a.json,
            Command::New(a) => a.json,
            Command::Robots(a) => match &a.action {
                Some(RobotsAction::Import(import)) => import.json,
                Some(RobotsAction::Bodies(bodies)) => bodies.json,
                Some(RobotsAction::Masses(masses)) => masses.json,
                Some(RobotsAction::Check(check)) => check.json,
                None => a.json,
            },
            Command::Export(a) => a.json,
            Command::Materials(a) => a.json,
            Command::Pose(a) => a.json,
            Command::Modes(a) => a.json,
            Command::Posture(a) => a.run.json,
            Command::Place(a) => a.run.json,
            Command::Advise(a) => a.run.json,
            Command::Compensate(a) => a.json,
            Command::Identify(a) => a.json,
            Command::Calibrate(a) => a.json,
            Command::Learn(a) => a.json,
            Command::Journal(a) => a.json,
            Command::Tracker(a) => a.json,
            Command::Forces(a) => a.json,
            Command::Roundness(a) => a.json,
            Command::Ballbar(a) => a.json,
            Command::Backlash(a) => a.json,
            Command::PoseAccuracy(a) => a.json,
            Command::PathAccuracy(a) => a.json,
            Command::Motion(a) => a.json,
            Command::Drives(a) => a.json,
            Command::Frf(a) => a.json,
            Command::Receptance(a) => a.json,
            Command::Stability(a) => a.json,
            Command::Budget(a) => a.json,
            Command::Serve(_) | Command::Completions(_) | Command::Man(_) => false,
        }
    }
}
