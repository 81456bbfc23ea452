//! `armill completions`: the completion script for a shell, on stdout.

use armill_study::StudyError;
use clap::CommandFactory;

use crate::arguments::{Arguments, CompletionsArguments};
use crate::outcome::Outcome;

/// Prints the script, generated from the definition of the arguments.
///
/// # Errors
/// Stdout cannot be written.
pub(crate) fn run(arguments: &CompletionsArguments) -> Result<Outcome, StudyError> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "armill", &mut script);
    crate::terminal::print(String::from_utf8_lossy(&script).trim_end())?;
    Ok(Outcome::Fine)
}
