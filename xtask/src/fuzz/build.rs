//! The fuzzing program: built with counters at every branch; lists its targets.
//!
//! `fuzz/` is a workspace of its own with its own lock file; it is built into `target/fuzz/build`, so that
//! neither its flags nor its products touch those of the workspace.

use super::{FOLDER, built};
use crate::command::{cargo, printed};
use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::process::Command;

/// Insert the counters that libFuzzer reads. All are options of the stable compiler; no sanitizer is linked,
/// since safe Rust needs none to see a fault.
const FLAGS: &[&str] = &[
    "-Cpasses=sancov-module",
    // Edges, calls and counters.
    "-Cllvm-args=-sanitizer-coverage-level=4",
    "-Cllvm-args=-sanitizer-coverage-inline-8bit-counters",
    "-Cllvm-args=-sanitizer-coverage-pc-table",
    // Both sides of comparisons, so that words and numbers are guessed.
    "-Cllvm-args=-sanitizer-coverage-trace-compares",
    // Branches that were folded together could not be distinguished.
    "-Cllvm-args=-simplifycfg-branch-fold-threshold=0",
    // The pass requires a single codegen unit.
    "-Ccodegen-units=1",
    "--cfg=fuzzing",
];

/// Between flags in the variable that cargo reads.
const BETWEEN: &str = "\x1f";

/// Builds the program and gives its path.
///
/// # Errors
/// The compiler reports on stderr; here, only that it failed.
pub fn program() -> Result<OsString, String> {
    let host = host()?;
    let folder = Path::new(FOLDER).join("build");
    let mut command = cargo(&["build", "--release", "--manifest-path", "fuzz/Cargo.toml"]);
    // With a target named, the flags are for our code alone, not for build scripts.
    command.args(["--target", &host]);
    command.env("CARGO_TARGET_DIR", &folder);
    command.env("CARGO_ENCODED_RUSTFLAGS", FLAGS.join(BETWEEN));
    eprintln!("building fuzz/ with coverage counters; the first time takes minutes");
    let status = command.status();
    let status = status.map_err(|problem| format!("cargo does not start: {problem}"))?;
    if !status.success() {
        return Err("fuzz/ does not build; libFuzzer needs a C++ compiler".to_owned());
    }
    Ok(built(&folder, &host))
}

/// The names of all targets, as the program lists them.
///
/// # Errors
/// The program does not run.
pub fn targets(program: &OsStr) -> Result<Vec<String>, String> {
    let mut command = Command::new(program);
    let given = printed(command.env_remove("ARMILL_FUZZ_TARGET"))?;
    Ok(given.lines().map(str::to_owned).collect())
}

/// The target that rustc builds for by default, such as `x86_64-unknown-linux-gnu`.
///
/// # Errors
/// Rustc does not start, or names none.
fn host() -> Result<String, String> {
    let given = printed(Command::new("rustc").arg("-vV"))?;
    let host = given.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned)
        .ok_or_else(|| "rustc -vV names no host".to_owned())
}
