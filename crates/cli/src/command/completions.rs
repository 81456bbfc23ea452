//! `armill completions`: the script that a shell sources, on stdout.

use armill_study::StudyError;
use clap::CommandFactory;

use crate::Outcome;
use crate::arguments::{Arguments, CompletionsArguments};

/// Prints the script, made from the same arguments that are parsed.
///
/// # Errors
/// Stdout takes no more.
pub(crate) fn run(arguments: &CompletionsArguments) -> Result<Outcome, StudyError> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "armill", &mut script);
    crate::terminal::print(String::from_utf8_lossy(&script).trim_end())?;
    Ok(Outcome::Fine)
}
