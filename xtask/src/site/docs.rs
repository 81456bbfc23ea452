//! The documentation, in `target/site`.
//!
//! `site/mkdocs.yml` has the navigation, `site/hook.py` collects the pages, checks every link and moves the result next to the
//! live page. The generator is in an environment of its own.

use crate::command::printed;
use std::env;
use std::process::Command;

/// The environment of the generator.
pub const VENV: &str = "target/site-venv";
/// The oldest Python: the first with a reader of TOML.
const OLDEST: [u32; 2] = [3, 11];

/// The commands that make it, each with its name.
///
/// # Errors
/// In a line: Python is missing, too old, or cannot make an environment.
pub fn documentation() -> Result<Vec<(&'static str, Command)>, String> {
    let version = printed(
        Command::new("python3").args(["-c", "import ensurepip, sys, venv; print(*sys.version_info[:2])"]),
    );
    if !version.as_deref().is_ok_and(is_new_enough) {
        let [major, minor] = OLDEST;
        return Err(format!(
            "the documentation needs Python {major}.{minor} or later with its module venv: install python3 and python3-venv"
        ));
    }
    let mut environment = Command::new("python3");
    environment.args(["-m", "venv", VENV]);
    let python = |arguments: &[&str]| {
        let mut command = Command::new(
            env::current_dir()
                .unwrap_or_default()
                .join(VENV)
                .join("bin/python"),
        );
        command
            .args(arguments)
            .env("PYTHONDONTWRITEBYTECODE", "1")
            // A notice of the theme about the next version of its generator, which is not installed.
            .env("NO_MKDOCS_2_WARNING", "1");
        command
    };
    let tools = ["-m", "pip", "install", "-q", "-r", "site/requirements.txt"];
    let tests = ["-m", "pytest", "-p", "no:cacheprovider", "site/tests"];
    // Not with `-q`: it drops warnings, and with them what `--strict` counts.
    let pages = ["-m", "mkdocs", "build", "--strict", "-f", "site/mkdocs.yml"];
    Ok(vec![
        ("the documentation: environment", environment),
        ("the documentation: generator", python(&tools)),
        ("the documentation: tests of its parts", python(&tests)),
        ("the documentation: pages and links", python(&pages)),
    ])
}

/// Whether `3 12` is not older than what is needed.
fn is_new_enough(version: &str) -> bool {
    let numbers: Vec<u32> = version
        .split_whitespace()
        .filter_map(|part| part.parse().ok())
        .collect();
    matches!(numbers[..], [major, minor] if [major, minor] >= OLDEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_by_number() {
        for new in ["3 11\n", "3 20", "4 0"] {
            assert!(is_new_enough(new), "{new}");
        }
        for old in ["3 9", "2 7", "3", "", "no such command"] {
            assert!(!is_new_enough(old), "{old}");
        }
    }
}
