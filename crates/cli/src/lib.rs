//! The command `armill`, for its terminal ([`command`]) and for programs that ask the same ([`analysis`]).
//!
//! Results go to stdout, progress and talk to stderr. Exit code 0: fine; 1: the tolerance is not held and `--strict`
//! was given; 2: bad input; 3: a fault of armill; 130: interrupted.
//!
//! | step | where |
//! |---|---|
//! | what was typed | `arguments`: a type a command, by clap, with the text of its help |
//! | the work | `command`: options into a question of `armill_study`, its answer into words or JSON |
//! | what is said | `terminal` for data, talk and problems, `progress` for a bar |
//! | a program that asks | `call`: its options as those that are typed; `listener` hears in place of the terminal |
//!
//! The command is thin: no mechanics, no format, no JSON of its own but that of problems. What clap refuses (an
//! unknown option, a missing value) it tells itself on stderr, with exit code 2 like any bad input.

mod arguments;
mod call;
mod command;
mod listener;
mod progress;
mod terminal;

use std::ffi::OsString;
use std::path::Path;

use armill_formats::input::Inputs;
use armill_formats::visible::visible;
use armill_study::{ErrorKind, StudyError};
use clap::Parser;

use arguments::{Arguments, Command};

pub use call::{Answer, Call, OptionOf, Refused, Told, analysis, options_of};
pub use listener::Listener;
pub use terminal::problems_json;

/// Does what these words say, the first of which is the name of the program, on the terminal, and gives the exit code.
pub fn command(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    let inputs = inputs_of(&words);
    let arguments = match Arguments::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(refused) => {
            // The refusal quotes words: they are shown as all text is.
            let shown = words
                .iter()
                .map(|word| visible(&word.to_string_lossy()).into_owned());
            let refused = Arguments::try_parse_from(shown).err().unwrap_or(refused);
            // Nobody is left to tell where this cannot be printed.
            let _ = refused.print();
            return u8::try_from(refused.exit_code()).unwrap_or(2);
        }
    };
    match inputs.during(|| run(&arguments.command)) {
        Ok(Outcome::Fine) => 0,
        Ok(Outcome::ToleranceNotHeld) => 1,
        Err(error) => {
            terminal::show_error(&error, arguments.command.wants_json());
            exit_code(&error)
        }
    }
}

/// The files that these words name: operands, and values of options behind `=`.
fn inputs_of(words: &[OsString]) -> Inputs {
    let values = words
        .iter()
        .filter_map(|word| word.to_str()?.split_once('=').map(|(_, value)| value.as_ref()));
    Inputs::naming(words.iter().map(Path::new).chain(values))
}

/// Does what a command says.
fn run(command: &Command) -> Result<Outcome, StudyError> {
    match command {
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
        Command::Man(man) => command::man::run(man),
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
fn exit_code(error: &StudyError) -> u8 {
    match error.kind() {
        ErrorKind::InvalidInput => 2,
        // As a shell tells an interrupted command.
        ErrorKind::Cancelled => 130,
        ErrorKind::Internal => 3,
    }
}
