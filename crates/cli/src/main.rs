//! The command `armill`.
//!
//! Results go to stdout, progress and talk to stderr. Exit code 0: fine; 1: the tolerance is not held and `--strict`
//! was given; 2: bad input; 3: a fault of armill; 130: interrupted.
//!
//! | step | where |
//! |---|---|
//! | what was typed | `arguments`: a type a command, by clap, with the text of its help |
//! | the work | `command`: options into a question of `armill_study`, its answer into words or JSON |
//! | what is said | `terminal` for data, talk and problems, `progress` for a bar |
//!
//! The command is thin: no mechanics, no format, no JSON of its own but that of problems. What clap refuses (an
//! unknown option, a missing value) it tells itself on stderr, with exit code 2 like any bad input.

mod arguments;
mod command;
mod progress;
mod terminal;

use std::process::ExitCode;

use armill_study::{ErrorKind, StudyError};
use clap::Parser;

use arguments::{Arguments, Command};

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match &arguments.command {
        Command::Run(run) => command::run::run(run),
        Command::Check(check) => command::check::run(check),
        Command::Compare(compare) => command::compare::run(compare),
        Command::New(new) => command::new::run(new),
        Command::Robots(robots) => command::robots::run(robots),
        Command::Materials(materials) => command::materials::run(materials),
        Command::Pose(pose) => command::pose::run(pose),
        Command::Posture(posture) => command::posture::run(posture),
        Command::Place(place) => command::place::run(place),
        Command::Advise(advise) => command::advise::run(advise),
        Command::Compensate(compensate) => command::compensate::run(compensate),
        Command::Identify(identify) => command::identify::run(identify),
        Command::Calibrate(calibrate) => command::calibrate::run(calibrate),
        Command::Forces(forces) => command::forces::run(forces),
        Command::Roundness(roundness) => command::roundness::run(roundness),
        Command::Ballbar(ballbar) => command::ballbar::run(ballbar),
        Command::PoseAccuracy(pose_accuracy) => command::pose_accuracy::run(pose_accuracy),
        Command::Backlash(backlash) => command::backlash::run(backlash),
        Command::PathAccuracy(path_accuracy) => command::path_accuracy::run(path_accuracy),
        Command::Budget(budget) => command::budget::run(budget),
        Command::Serve(serve) => command::serve::run(serve),
        Command::Completions(completions) => command::completions::run(completions),
    };
    match outcome {
        Ok(Outcome::Fine) => ExitCode::SUCCESS,
        Ok(Outcome::ToleranceNotHeld) => ExitCode::from(1),
        Err(error) => {
            terminal::show_error(&error, arguments.command.wants_json());
            exit_code(&error)
        }
    }
}

/// How a command ended that did its work; what stopped it before is a `StudyError`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Nothing to complain of.
    Fine,
    /// `--strict` was given and the tolerance is not held everywhere.
    ToleranceNotHeld,
}

/// The kind of an error alone decides how the process ends.
fn exit_code(error: &StudyError) -> ExitCode {
    match error.kind() {
        ErrorKind::InvalidInput => ExitCode::from(2),
        // As a shell tells an interrupted command.
        ErrorKind::Cancelled => ExitCode::from(130),
        ErrorKind::Internal => ExitCode::from(3),
    }
}
