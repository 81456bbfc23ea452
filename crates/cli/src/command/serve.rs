//! `armill serve`: the live page of a study, until it is interrupted.
//!
//! The first line on stdout is the address, with the required token; messages go to stderr.

use armill_study::StudyError;
use armill_web::{Options, Server, has_page};

use crate::arguments::ServeArguments;
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Serves until Ctrl-C.
///
/// # Errors
/// No such study; a port in use; stdout cannot be written.
pub(crate) fn run(arguments: &ServeArguments) -> Result<Outcome, StudyError> {
    let server = Server::start(&Options {
        study: arguments.study.clone(),
        port: arguments.port,
        opens_browser: !arguments.no_open,
    })?;
    print(server.url())?;
    if !has_page() {
        say("warning: this armill was built without its page, and only serves the API under /api");
        say("help: in the source tree, with Node 20 or later: cargo xtask web, then build again");
    }
    say("the page can only be opened on this machine; Ctrl-C stops it");
    server.run();
    Ok(Outcome::Fine)
}
