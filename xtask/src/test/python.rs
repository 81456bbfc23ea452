//! The Python package: its wheel, its tests, its types.
//!
//! | step | fails where |
//! |---|---|
//! | environment | `target/python-venv` cannot be made |
//! | tools | pip cannot install what `python/tests/requirements.txt` names |
//! | wheel | the package does not build; in the development profile, so that what tests have built is used again |
//! | installed | the wheel cannot be installed |
//! | tests | a test fails, those of README and guide included |
//! | types | the package is typed wrongly (mypy, pyright), or its stubs differ from the package (stubtest) |
//!
//! Python with its module `venv` is installed by `apt-get` where it is missing and that is there; without it the steps
//! fail.

use super::install;
use super::step::Step;
use std::env;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The environment of the tests.
const VENV: &str = "target/python-venv";
/// Where wheels go.
const WHEELS: &str = "target/python-wheels";

/// Installs Python where it is missing.
pub fn ensure() {
    if !has_venv() {
        install(&["python3", "python3-venv"]);
    }
}

/// The steps that make the environment of the tests.
pub fn environment() -> Vec<Step> {
    let mut environment = Command::new("python3");
    environment.args(["-m", "venv", VENV]);
    let tools = ["-m", "pip", "install", "-q", "-r", "tests/requirements.txt"];
    vec![
        Step::new("the Python package: environment", environment),
        Step::new("the Python package: tools", in_package("python", &tools)),
    ]
}

/// The steps that build and test the package in that environment.
pub fn tests() -> Vec<Step> {
    let python = |arguments: &[&str]| in_package("python", arguments);
    let wheels = at_root(WHEELS).to_string_lossy().into_owned();
    let interpreter = at_root(VENV).join("bin/python").to_string_lossy().into_owned();
    let wheel = [
        "build",
        "--profile",
        "dev",
        "--interpreter",
        &interpreter,
        "--out",
        &wheels,
    ];
    let installed = [
        "-m",
        "pip",
        "install",
        "-q",
        "--force-reinstall",
        "--no-deps",
        "--no-index",
        "--find-links",
        &wheels,
        "armill",
    ];
    vec![
        Step::new("the Python package: wheel", in_package("maturin", &wheel)),
        Step::new("the Python package: installed", python(&installed)),
        Step::new("the Python package: tests", python(&["-m", "pytest"])),
        Step::new("the Python package: types by mypy", python(&["-m", "mypy"])),
        Step::new(
            "the Python package: types by pyright",
            in_package("pyright", &["--pythonpath", &interpreter]),
        ),
        Step::new(
            "the Python package: stubs",
            python(&["-m", "mypy.stubtest", "armill._armill"]),
        ),
    ]
}

/// A program of the environment, in the folder of the package.
fn in_package(program: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new(at_root(VENV).join("bin").join(program));
    command
        .args(arguments)
        .current_dir("python")
        .env("PYTHONDONTWRITEBYTECODE", "1");
    command
}

/// A path of the repository that is valid in any folder.
fn at_root(path: &str) -> PathBuf {
    env::current_dir().unwrap_or_default().join(path)
}

/// Whether Python can make an environment.
fn has_venv() -> bool {
    let mut command = Command::new("python3");
    command
        .args(["-c", "import ensurepip, venv"])
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use crate::command::{cargo, printed};
    use std::collections::BTreeSet;

    /// The packages that cargo builds for these arguments, each with its features.
    fn built(arguments: &[&str]) -> BTreeSet<String> {
        let mut tree = cargo(&["tree", "--format", "{p} {f}", "--prefix", "none"]);
        let printed = printed(tree.args(arguments)).unwrap();
        let lines = printed.lines().map(|line| line.trim_end_matches(" (*)"));
        lines.map(str::to_owned).collect()
    }

    #[test]
    fn the_wheel_is_built_of_what_the_tests_are_built_of() {
        let tests = built(&["--workspace", "--edges", "normal,build,dev"]);
        let wheel = built(&["--package", "armill-py", "--edges", "normal,build"]);
        let again: Vec<&String> = wheel.difference(&tests).collect();
        assert!(
            again.is_empty(),
            "with other features these are built a second time for the wheel, and all that use them: {again:#?}"
        );
    }
}
