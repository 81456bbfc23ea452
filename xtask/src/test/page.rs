//! The page of `armill serve`: its types, its parts without a browser, and all of it in a real one.
//!
//! | step | fails where |
//! |---|---|
//! | packages | npm cannot install what `package-lock.json` names |
//! | types and bundle | a type is wrong, or nothing can be built |
//! | parts | a test without a browser fails |
//! | in Chromium | the page does not show what the server answers, or looks otherwise |
//!
//! Node, npm and Chromium are installed by `apt-get` where they are missing and it is there; without them the steps fail.

use super::install;
use super::step::Step;
use std::path::Path;
use std::process::{Command, Stdio};

/// The browser, as Debian has it.
const CHROMIUM: &str = "/usr/bin/chromium";
/// The command that unit and integration tests have built.
const ARMILL: &str = "../target/debug/armill";

/// Installs what is missing; gives the steps that make the page, from where the next build of armill takes it.
pub fn build() -> Vec<Step> {
    let missing: Vec<&str> = [("nodejs", starts("node")), ("npm", starts("npm"))]
        .into_iter()
        .chain([("chromium", Path::new(CHROMIUM).is_file())])
        .filter_map(|(package, is_there)| (!is_there).then_some(package))
        .collect();
    if !missing.is_empty() {
        install(&missing);
    }
    vec![
        Step::new("the page: packages", npm(&["ci", "--no-audit", "--no-fund"])),
        Step::new("the page: types and bundle", npm(&["run", "build"])),
    ]
}

/// The steps that test it.
pub fn tests() -> Vec<Step> {
    let mut in_chromium = npm(&["run", "e2e"]);
    in_chromium.env("ARMILL_BIN", ARMILL);
    vec![
        Step::new("the page: parts", npm(&["test"])),
        Step::new("the page: in Chromium", in_chromium),
    ]
}

/// `npm` in the folder of the page.
fn npm(arguments: &[&str]) -> Command {
    let mut command = Command::new("npm");
    // Summaries are read: without colours.
    command.args(arguments).current_dir("web").env("NO_COLOR", "1");
    command
}

/// Whether a program is there.
fn starts(program: &str) -> bool {
    let mut command = Command::new(program);
    command
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}
