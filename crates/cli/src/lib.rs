//! The command `armill`, for the terminal ([`command`]) and for programs ([`call`]).
//!
//! Results go to stdout, progress and messages to stderr. Exit code 0: success; 1: the tolerance is not met and
//! `--strict` was given, or `robots check` finds a disagreement; 2: invalid input; 3: internal error of armill; 130:
//! interrupted.
//!
//! | step | where |
//! |---|---|
//! | arguments | `arguments`: one type per command, parsed by clap, with the help texts |
//! | work | `command`: converts options to a call of `armill_study` and its result to text or JSON |
//! | output | `terminal` for data, messages and errors, `progress` for a progress bar |
//! | calls by a program | `call`: options by name; `listener` receives the output in place of the terminal |
//!
//! The command is thin: no mechanics, no formats, no own JSON except for errors. Clap prints errors in the arguments
//! (an unknown option, a missing value) on stderr, with exit code 2 as for any invalid input.

mod arguments;
mod call;
mod command;
mod listener;
mod outcome;
mod progress;
mod terminal;

use std::ffi::OsString;
use std::path::Path;

use armill_formats::input::Inputs;
use armill_formats::visible::visible;
use clap::Parser;

use arguments::{Arguments, Command, with_present_name};
use armill_study::{ErrorKind, StudyError};
use outcome::Outcome;

pub use call::{Answer, Call, OptionOf, OptionValue, Refused, call, options_of};
pub use listener::Listener;
pub use terminal::problems_json;

/// Runs the command given by these arguments, the first of which is the program name; returns the exit code.
pub fn command(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    let inputs = inputs_of(&words);
    let arguments = match Arguments::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(refused) => {
            // The error message quotes arguments: control characters are escaped.
            let shown = words
                .iter()
                .map(|word| visible(&word.to_string_lossy()).into_owned());
            let refused = Arguments::try_parse_from(shown).err().unwrap_or(refused);
            let refused = with_present_name(refused);
            // If this cannot be printed, there is no other place to report it.
            let _ = refused.print();
            return u8::try_from(refused.exit_code()).unwrap_or(2);
        }
    };
    match inputs.during(|| run(&arguments.command)) {
        Ok(Outcome::Fine) => 0,
        Ok(Outcome::ToleranceNotMet | Outcome::Disagreement) => 1,
        Err(error) => {
            terminal::show_error(&error, arguments.command.wants_json());
            exit_code(&error)
        }
    }
}

/// The files named in the arguments: operands, and values of options after `=`.
fn inputs_of(words: &[OsString]) -> Inputs {
    let values = words
        .iter()
        .filter_map(|word| word.to_str()?.split_once('=').map(|(_, value)| value.as_ref()));
    Inputs::naming(words.iter().map(Path::new).chain(values))
}

/// Runs a command.
fn run(command: &Command) -> Result<Outcome, StudyError> {
    match command {
        Command::Run(run) => command::run::run(run),
        Command::Check(check) => command::check::run(check),
        Command::Compare(compare) => command::compare::run(compare),
        Command::New(new) => command::new::run(new),
        Command::Robots(robots) => command::robots::run(robots),
        Command::Export(export) => command::export::run(export),
        Command::Materials(materials) => command::materials::run(materials),
        Command::Pose(pose) => command::pose::run(pose),
        Command::Modes(modes) => command::modes::run(modes),
        Command::Posture(posture) => command::posture::run(posture),
        Command::Place(place) => command::place::run(place),
        Command::Advise(advise) => command::advise::run(advise),
        Command::Compensate(compensate) => command::compensate::run(compensate),
        Command::Identify(identify) => command::identify::run(identify),
        Command::Calibrate(calibrate) => command::calibrate::run(calibrate),
        Command::Learn(learn) => command::learn::run(learn),
        Command::Journal(journal) => command::journal::run(journal),
        Command::Tracker(tracker) => command::tracker::run(tracker),
        Command::Forces(forces) => command::forces::run(forces),
        Command::Roundness(roundness) => command::roundness::run(roundness),
        Command::Ballbar(ballbar) => command::ballbar::run(ballbar),
        Command::PoseAccuracy(pose_accuracy) => command::pose_accuracy::run(pose_accuracy),
        Command::Backlash(backlash) => command::backlash::run(backlash),
        Command::PathAccuracy(path_accuracy) => command::path_accuracy::run(path_accuracy),
        Command::Motion(motion) => command::motion::run(motion),
        Command::Drives(drives) => command::drives::run(drives),
        Command::Frf(frf) => command::frf::run(frf),
        Command::Receptance(receptance) => command::receptance::run(receptance),
        Command::Stability(stability) => command::stability::run(stability),
        Command::Budget(budget) => command::budget::run(budget),
        Command::Serve(serve) => command::serve::run(serve),
        Command::Completions(completions) => command::completions::run(completions),
        Command::Man(man) => command::man::run(man),
    }
}

/// The exit code depends only on the kind of the error.
fn exit_code(error: &StudyError) -> u8 {
    match error.kind() {
        ErrorKind::InvalidInput => 2,
        // As a shell reports an interrupted command.
        ErrorKind::Cancelled => 130,
        ErrorKind::Internal => 3,
    }
}
