//! Validation: our numbers next to published ones, written to `validation/TABLE.md`.
//!
//! The program is `armill-validation` in `validation/`; its tests have the same checks, so that a changed number
//! fails there too. Exit code 1: a check fails, or the table cannot be written.

use crate::command::{cargo, run_in_place};
use std::process::ExitCode;

/// Description in the list of tasks.
pub const ABOUT: &str = "Compares predictions with published numbers and writes validation/TABLE.md.";

/// Runs the validation program in release mode; `arguments` go to it.
pub fn run(arguments: &[String]) -> ExitCode {
    let mut command = cargo(&["run", "--release", "--package", "armill-validation", "--"]);
    command.args(arguments);
    run_in_place(command)
}
