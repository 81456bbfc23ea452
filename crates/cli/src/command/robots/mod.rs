//! `armill robots`: what is known of robots.
//!
//! Without a name `list` prints the library, one line a robot; with one `show` prints everything, with `structure` for what
//! yields beside the drives. `import` makes a robot file of ours from another, `check` compares one with its pendant.

mod check;
mod import;
mod list;
mod show;
mod structure;

use armill_study::StudyError;

use crate::Outcome;
use crate::arguments::{RobotsAction, RobotsArguments};

/// Goes by the subcommand, else by whether a name is given.
pub(crate) fn run(arguments: &RobotsArguments) -> Result<Outcome, StudyError> {
    match (&arguments.action, &arguments.name) {
        (Some(RobotsAction::Import(file)), _) => import::run(file),
        (Some(RobotsAction::Check(readings)), _) => check::run(readings),
        (None, Some(name)) => show::run(name, arguments),
        (None, None) => list::run(arguments),
    }
}
