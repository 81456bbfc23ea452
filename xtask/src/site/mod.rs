//! The page without a server, and the documentation: a folder that any web server or file share serves, or that is opened
//! from a disk.
//!
//! ```text
//! crates/browser -> WebAssembly -> compressed \
//! web/src -> page of one script ------------- target/site/live
//! docs, python, robots, ... -> mkdocs -------- target/site
//! ```
//!
//! | file | content |
//! |---|---|
//! | `live` | the page with its program |
//! | `docs` | the documentation |

mod docs;
mod live;

pub use docs::{VENV, documentation};
pub use live::{TARGET, live_page};

use crate::COULD_NOT_RUN;
use crate::command::succeeded;
use crate::node;
use std::process::ExitCode;

/// Description in the list of tasks.
pub const ABOUT: &str = "Builds the site into target/site: documentation, and the live page without a server; needs Python, Node, npm and rustup. `--docs`: the documentation alone.";

/// Builds it, or reports what is missing.
pub fn run(arguments: &[String]) -> ExitCode {
    let built = match arguments {
        [] => build(&[], None),
        [only] if only == "--docs" => docs(None),
        _ => Err(format!(
            "cargo xtask site takes --docs or nothing, got: {}",
            arguments.join(" ")
        )),
    };
    match built {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}

/// Builds the live page, with `rustflags` for the compiler, and the documentation, with the time `dated_s` in s since 1970.
///
/// # Errors
/// In a line: what is missing, or what failed.
pub fn build(rustflags: &[String], dated_s: Option<&str>) -> Result<(), String> {
    live(rustflags)?;
    docs(dated_s)
}

/// Builds the live page.
fn live(rustflags: &[String]) -> Result<(), String> {
    if let Some(problem) = node::missing() {
        return Err(problem);
    }
    succeeded(&mut node::npm(&["ci", "--no-audit", "--no-fund"]))?;
    for (_, mut command) in live_page(rustflags)? {
        succeeded(&mut command)?;
    }
    println!("target/site/live/index.html: open it, or serve the folder target/site");
    Ok(())
}

/// Builds the documentation.
fn docs(dated_s: Option<&str>) -> Result<(), String> {
    for (_, mut command) in documentation()? {
        if let Some(dated_s) = dated_s {
            command.env("SOURCE_DATE_EPOCH", dated_s);
        }
        succeeded(&mut command)?;
    }
    println!("target/site/index.html: open it, or serve the folder target/site");
    Ok(())
}
