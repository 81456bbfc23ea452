//! The page of `armill serve`: built into `web/dist`, from where the next build of armill embeds it.
//!
//! ```text
//! npm ci -> types from web/openapi.json -> type check -> bundle
//! ```
//!
//! Needs Node and npm; without them armill builds as well and serves its answers without a page. `web/openapi.json` and
//! the types are in the repository, and a test of the server fails when they are out of date: only `--describe` builds
//! the server to write them again.

use crate::COULD_NOT_RUN;
use crate::command::{cargo, expect_no_arguments, printed, run_in_place};
use crate::node;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

/// Description in the list of tasks.
pub const ABOUT: &str = "Builds the page of `armill serve` into web/dist; needs Node and npm.";

/// The description of the server, from which the types of the page are made.
const DESCRIPTION: &str = "web/openapi.json";

/// Builds the page, or reports what is missing; with `--describe` it writes the description of the server first.
pub fn run(arguments: &[String]) -> ExitCode {
    match arguments {
        [option] if option == "--describe" => match describe() {
            Ok(()) => build(),
            Err(problem) => could_not(&problem),
        },
        others => match expect_no_arguments("web", others) {
            Ok(()) => build(),
            Err(code) => code,
        },
    }
}

/// Writes the description that the server gives of itself.
fn describe() -> Result<(), String> {
    let example = ["run", "--quiet", "-p", "armill-web", "--example", "openapi"];
    let text = printed(&mut cargo(&example))?;
    fs::write(DESCRIPTION, text).map_err(|error| format!("{DESCRIPTION}: {error}"))
}

fn could_not(problem: &str) -> ExitCode {
    eprintln!("{problem}");
    ExitCode::from(COULD_NOT_RUN)
}

/// Builds the page.
pub fn build() -> ExitCode {
    if !Path::new("web/package.json").is_file() {
        return could_not("web/package.json is missing: this checkout has no page");
    }
    if let Some(problem) = node::missing() {
        return could_not(&problem);
    }
    let steps: [&[&str]; 3] = [
        &["ci", "--no-audit", "--no-fund"],
        &["run", "types"],
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
