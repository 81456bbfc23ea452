//! Speed: every benchmark of the workspace.

use crate::command::{cargo, run_in_place};
use std::process::ExitCode;

/// What `--help` says.
pub const ABOUT: &str = "Runs the benchmarks; arguments go to Criterion (a name filter, --save-baseline).";

/// Runs the benchmark targets alone: the test harness of a library would refuse Criterion's arguments.
pub fn run(arguments: &[String]) -> ExitCode {
    let mut command = cargo(&["bench", "--workspace", "--bench", "*", "--"]);
    command.args(arguments);
    run_in_place(command)
}
