//! Dependencies: licences, banned crates and origins, by the rules in `deny.toml`.
//!
//! By `deny.toml`; nothing is downloaded but what cargo-deny itself fetches. The program must be installed: it
//! is not built here.

use crate::COULD_NOT_RUN;
use crate::command::{cargo, expect_no_arguments, has_cargo_tool, run_in_place};
use std::process::ExitCode;

/// What `--help` says.
pub const ABOUT: &str = "Checks licences and origins of all dependencies with cargo-deny.";

/// Checks what `deny.toml` says, or says how to get the program that can.
pub fn run(arguments: &[String]) -> ExitCode {
    if let Err(code) = expect_no_arguments("audit", arguments) {
        return code;
    }
    if !has_cargo_tool("deny") {
        eprintln!("cargo-deny is not installed: cargo install --locked cargo-deny@^0.20");
        return ExitCode::from(COULD_NOT_RUN);
    }
    run_in_place(cargo(&["deny", "check", "licenses", "bans", "sources"]))
}
