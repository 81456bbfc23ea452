//! The live page with its program, in `target/site/live`.

use crate::command::{cargo, printed};
use crate::{node, rustup};
use std::process::Command;
use std::{env, fs};

/// WebAssembly with files, clock, random numbers and threads of its host: WASI, version 1.
pub const TARGET: &str = "wasm32-wasip1-threads";
/// The program, as cargo names it; seen from the folder of the page.
const PROGRAM: &str = "../target/wasm32-wasip1-threads/browser/armill_browser.wasm";
/// Where it goes; seen from the folder of the page.
const FOLDER: &str = "../target/site/live";

/// How it is linked: the page calls its begin once, gives it memory of this size at first, and the stack is as large as that of
/// other programs.
const LINK_OPTIONS: &[&str] = &[
    "link-arg=--export=_initialize",
    "link-arg=--initial-memory=67108864",
    "link-arg=--max-memory=4294967296",
    "link-arg=-zstack-size=8388608",
];

/// The begin of a library, which rustc links to programs alone: it makes the first thread known.
fn begin_of_library() -> Result<String, String> {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let root = printed(Command::new(rustc).args(["--print", "sysroot"]))?;
    Ok(format!(
        "{}/lib/rustlib/{TARGET}/lib/self-contained/crt1-reactor.o",
        root.trim()
    ))
}

/// The commands that make it, each with its name; the packages of the page are installed before. `rustflags`: for the compiler, in
/// addition to those of the workspace.
///
/// # Errors
/// In a line: the standard library for WebAssembly is missing and cannot be installed.
pub fn live_page(rustflags: &[String]) -> Result<Vec<(&'static str, Command)>, String> {
    rustup::add_target(TARGET)?;
    let begin = format!("link-arg={}", begin_of_library()?);
    fs::create_dir_all("target/site").map_err(|error| format!("target/site: {error}"))?;
    let mut program = cargo(&["rustc", "--profile", "browser", "--target", TARGET]);
    if !rustflags.is_empty() {
        program.args(["--config", &format!("target.{TARGET}.rustflags={rustflags:?}")]);
    }
    program.args(["--package", "armill-browser", "--crate-type", "cdylib", "--"]);
    for option in [begin.as_str()].iter().chain(LINK_OPTIONS) {
        program.args(["-C", option]);
    }
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
