//! `armill serve`: the live page of a study, until it is interrupted.
//!
//! The first line on stdout is the address, with the token that it needs; all else is said on stderr.

use armill_study::StudyError;
use armill_web::{Options, Server, has_page};

use crate::Outcome;
use crate::arguments::ServeArguments;
use crate::terminal::{print, say};

/// Serves until Ctrl-C.
///
/// # Errors
/// No study there; a port that is taken; stdout takes no more.
pub(crate) fn run(arguments: &ServeArguments) -> Result<Outcome, StudyError> {
    let server = Server::start(&Options {
        study: arguments.study.clone(),
        port: arguments.port,
        opens_browser: !arguments.no_open,
    })?;
    print(server.url())?;
    if !has_page() {
        say("warning: this armill was built without its page, and serves its answers under /api alone");
        say("help: in the sources, with Node 20 or later installed: cargo xtask web, then build again");
    }
    say("the page is open on this machine alone; Ctrl-C ends it");
    server.run();
    Ok(Outcome::Fine)
}
