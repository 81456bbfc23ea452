//! The page without a server, and the documentation: a folder that any web server or file share serves, or that is opened
//! from a disk.
//!
//! ```text
//! crates/browser -> WebAssembly -> compressed \
//! web/src -> page of one script ------------- target/site/live
//! docs -> mkdocs ---------------------------- target/site
//! ```
//!
//! | file | content |
//! |---|---|
//! | `live` | the page with its program |

mod live;

pub use live::live_page;

use crate::COULD_NOT_RUN;
use crate::command::{expect_no_arguments, succeeded};
use crate::node;
use std::process::ExitCode;

/// Description in the list of tasks.
pub const ABOUT: &str = "Builds the site into target/site: documentation, and the live page without a server; needs Node, npm and rustup.";

/// Builds it, or reports what is missing.
pub fn run(arguments: &[String]) -> ExitCode {
    if let Err(code) = expect_no_arguments("site", arguments) {
        return code;
    }
    match build() {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}

/// Builds all of it.
fn build() -> Result<(), String> {
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
