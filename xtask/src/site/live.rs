//! The live page with its program, in `target/site/live`.

use crate::command::cargo;
use crate::node;
use std::fs;
use std::process::{Command, Stdio};

/// WebAssembly with files, clock and random numbers of its host: WASI, version 1.
const TARGET: &str = "wasm32-wasip1";
/// The program, as cargo names it; seen from the folder of the page.
const PROGRAM: &str = "../target/wasm32-wasip1/browser/armill_browser.wasm";
/// Where it goes; seen from the folder of the page.
const FOLDER: &str = "../target/site/live";

/// The commands that make it, each with its name; the packages of the page are installed before.
///
/// # Errors
/// In a line: the standard library for WebAssembly is missing and cannot be installed.
pub fn live_page() -> Result<Vec<(&'static str, Command)>, String> {
    add_target()?;
    fs::create_dir_all("target/site").map_err(|error| format!("target/site: {error}"))?;
    let program = cargo(&[
        "build",
        "--profile",
        "browser",
        "--target",
        TARGET,
        "--package",
        "armill-browser",
    ]);
    let mut compressed = node::node(&["dev/program.mjs", PROGRAM, FOLDER]);
    compressed.current_dir("web");
    Ok(vec![
        ("the page without a server: program", program),
        (
            "the page without a server: bundle",
            node::npm(&["run", "build:site", "--", "--outDir", FOLDER]),
        ),
        ("the page without a server: program compressed", compressed),
    ])
}

/// Installs what is missing with rustup.
fn add_target() -> Result<(), String> {
    let added = Command::new("rustup")
        .args(["target", "add", TARGET])
        .stderr(Stdio::null())
        .status();
    match added.is_ok_and(|status| status.success()) {
        true => Ok(()),
        false => Err(format!(
            "the program of the browser needs the standard library for {TARGET}: install rustup, https://rustup.rs"
        )),
    }
}
