//! The page of `armill serve`, and the same page without a server: its types, its parts without a browser, and all of it in a real one.
//!
//! | step | fails where |
//! |---|---|
//! | packages | npm cannot install what `package-lock.json` names |
//! | types and bundle | a type is wrong, or nothing can be built |
//! | without a server | the program of the browser does not compile |
//! | parts | a test without a browser fails |
//! | in Chromium | the page does not show what the server answers, or looks otherwise |
//!
//! Chromium is installed by `apt-get` where it is missing and that is there, Node and npm into `target/node` where they are missing or
//! too old; without them the steps fail.

use super::step::Step;
use super::{install, python};
use crate::node;
use crate::site::live_page;
use std::path::Path;
use std::process::Command;

/// The browser, as Debian has it.
const CHROMIUM: &str = "/usr/bin/chromium";
/// The command that unit and integration tests have built.
const ARMILL: &str = "../target/debug/armill";

/// The page without a server, as `live_page` makes it.
const SITE: &str = "../target/site/live";

/// Installs what is missing; gives the steps that make the page, from where the next build of armill takes it.
pub fn build() -> Vec<Step> {
    if !Path::new(CHROMIUM).is_file() {
        install(&["chromium"]);
    }
    if node::missing().is_some() {
        python::ensure();
        node::install();
    }
    vec![
        Step::new("the page: packages", npm(&["ci", "--no-audit", "--no-fund"])),
        Step::new("the page: types and bundle", npm(&["run", "build"])),
    ]
}

/// The steps that make the page without a server, with the packages of [`build`].
pub fn build_without_server() -> Vec<Step> {
    Step::all(live_page(&[]))
}

/// The steps that test it.
pub fn tests() -> Vec<Step> {
    let mut in_chromium = npm(&["run", "e2e"]);
    in_chromium.env("ARMILL_BIN", ARMILL).env("ARMILL_SITE", SITE);
    vec![
        Step::new("the page: parts", npm(&["test"])),
        Step::new("the page: in Chromium", in_chromium),
    ]
}

/// Summaries are read: without colours.
fn npm(arguments: &[&str]) -> Command {
    let mut command = node::npm(arguments);
    command.env("NO_COLOR", "1");
    command
}
