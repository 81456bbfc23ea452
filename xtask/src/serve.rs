//! The live page from this checkout: builds page and program, and serves.

use crate::command::{cargo, run_in_place};
use crate::web;
use std::process::ExitCode;

/// What `--help` says.
pub const ABOUT: &str = "Builds the page, then serves: arguments as of `armill serve`.";

/// Serves with the page built anew; arguments go to `armill serve`.
pub fn run(arguments: &[String]) -> ExitCode {
    let built = web::build();
    if built != ExitCode::SUCCESS {
        return built;
    }
    let mut serve = cargo(&["run", "--release", "--", "serve"]);
    serve.args(arguments);
    run_in_place(serve)
}
