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

pub use docs::documentation;
pub use live::live_page;

use crate::COULD_NOT_RUN;
use crate::command::succeeded;
use crate::node;
use std::process::ExitCode;

/// Description in the list of tasks.
pub const ABOUT: &str = "Builds the site into target/site: documentation, and the live page without a server; needs Python, Node, npm and rustup. `--docs`: the documentation alone.";

/// Builds it, or reports what is missing.
pub fn run(arguments: &[String]) -> ExitCode {
    let built = match arguments {
        [] => live().and_then(|()| docs()),
        [only] if only == "--docs" => docs(),
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

/// Builds the live page.
fn live() -> Result<(), String> {
    if let Some(problem) = node::missing() {
        return Err(problem);
    }
    succeeded(&mut node::npm(&["ci", "--no-audit", "--no-fund"]))?;
    for (_, mut command) in live_page()? {
        succeeded(&mut command)?;
    }
    println!("target/site/live/index.html: open it, or serve the folder target/site");
    Ok(())
}

/// Builds the documentation.
fn docs() -> Result<(), String> {
    for (_, mut command) in documentation()? {
        succeeded(&mut command)?;
    }
    println!("target/site/index.html: open it, or serve the folder target/site");
    Ok(())
}
