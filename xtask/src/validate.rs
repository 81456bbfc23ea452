//! Validation: our numbers beside published ones, written to `validation/TABLE.md`.
//!
//! The program is `armill-validation` in `validation/`; its tests hold the same checks, so that a number that
//! drifts fails there too. Exit code 1: a check does not hold, or the table cannot be written.

use crate::command::{cargo, run_in_place};
use std::process::ExitCode;

/// What `--help` says.
pub const ABOUT: &str = "Compares predictions with published numbers and writes validation/TABLE.md.";

/// Runs the validation program in release mode; `arguments` go to it.
pub fn run(arguments: &[String]) -> ExitCode {
    let mut command = cargo(&["run", "--release", "--package", "armill-validation", "--"]);
    command.args(arguments);
    run_in_place(command)
}
