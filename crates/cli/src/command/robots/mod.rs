//! `armill robots`: information on robots.
//!
//! Without a name `list` prints the library, one line per robot; with a name `show` prints everything, with `structure`
//! for springs and masses apart from the drives; `tables` writes what `bodies` and `masses` make. `import` converts other formats, `bodies` encloses links by capsules, `masses` estimates their masses, `check` compares a robot with its
//! pendant.

mod bodies;
mod check;
mod import;
mod list;
mod masses;
mod show;
mod structure;
mod tables;

use armill_study::StudyError;

use crate::arguments::{RobotsAction, RobotsArguments};
use crate::outcome::Outcome;

/// Selects by the subcommand, otherwise by whether a name is given.
pub(crate) fn run(arguments: &RobotsArguments) -> Result<Outcome, StudyError> {
    match (&arguments.action, &arguments.name) {
        (Some(RobotsAction::Import(file)), _) => import::run(file),
        (Some(RobotsAction::Bodies(file)), _) => bodies::run(file),
        (Some(RobotsAction::Masses(arm)), _) => masses::run(arm),
        (Some(RobotsAction::Check(readings)), _) => check::run(readings),
        (None, Some(name)) => show::run(name, arguments),
        (None, None) => list::run(arguments),
    }
}
