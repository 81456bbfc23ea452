//! The live page from this checkout: builds page and program, and serves.

use crate::command::{cargo, run_in_place};
use crate::web;
use std::process::ExitCode;

/// Description in the list of tasks.
pub const ABOUT: &str = "Builds the page, then serves: arguments as of `armill serve`.";

/// Builds the page and serves it; arguments go to `armill serve`.
pub fn run(arguments: &[String]) -> ExitCode {
    let built = web::build();
    if built != ExitCode::SUCCESS {
        return built;
    }
    let mut serve = cargo(&["run", "--release", "--", "serve"]);
    serve.args(arguments);
    run_in_place(serve)
}
