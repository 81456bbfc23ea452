//! The page of `armill serve`: built into `web/dist`, from where the next build of armill takes it.
//!
//! ```text
//! npm ci -> types from the server's own description -> type check -> bundle
//! ```
//!
//! Node and npm are needed; without them armill builds as well, and serves its answers without a page.

use crate::COULD_NOT_RUN;
use crate::command::{cargo, expect_no_arguments, printed, run_in_place};
use crate::node;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

/// What `--help` says.
pub const ABOUT: &str = "Builds the page of `armill serve` into web/dist; needs Node and npm.";

/// Where the description of the server represents the page.
const DESCRIPTION: &str = "web/openapi.json";

/// Builds the page, or says what is missing.
pub fn run(arguments: &[String]) -> ExitCode {
    match expect_no_arguments("web", arguments) {
        Ok(()) => build(),
        Err(code) => code,
    }
}

/// Builds the page.
pub fn build() -> ExitCode {
    if !Path::new("web/package.json").is_file() {
        eprintln!("there is no web/package.json: this checkout has no page");
        return ExitCode::from(COULD_NOT_RUN);
    }
    if let Some(problem) = node::missing() {
        eprintln!("{problem}");
        return ExitCode::from(COULD_NOT_RUN);
    }
    let described = printed(&mut cargo(&[
        "run",
        "--quiet",
        "-p",
        "armill-web",
        "--example",
        "openapi",
    ]));
    let written = described
        .and_then(|text| fs::write(DESCRIPTION, text).map_err(|error| format!("{DESCRIPTION}: {error}")));
    if let Err(problem) = written {
        eprintln!("{problem}");
        return ExitCode::from(COULD_NOT_RUN);
    }
    let steps: [&[&str]; 3] = [
        &["ci", "--no-audit", "--no-fund"],
        // What the page knows of the server.
        &["run", "types"],
        // Its types are checked first.
        &["run", "build"],
    ];
    for step in steps {
        let code = run_in_place(node::npm(step));
        if code != ExitCode::SUCCESS {
            return code;
        }
    }
    ExitCode::SUCCESS
}
