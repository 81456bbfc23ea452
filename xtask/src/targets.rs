//! Type-checks the sources for the systems on which armill runs, on any of them.
//!
//! Nothing is linked or run: an error of types, a function of another system or a dependency that does not know the
//! target are found; what differs at run time is not.

use crate::command::{cargo, succeeded};
use crate::{COULD_NOT_RUN, FOUND_WRONG, rustup};
use std::process::ExitCode;

/// Description in the list of tasks.
pub const ABOUT: &str =
    "Type-checks armill for Windows, macOS, Linux on two processors and WebAssembly: [TARGET ...].";

/// A target, and the packages that are for it.
struct Target {
    name: &'static str,
    packages: &'static [&'static str],
}

/// All crates and the programs of the repository.
const ALL: &[&str] = &["--workspace"];
/// The page without a server.
const BROWSER: &[&str] = &["--package", "armill-browser"];

const TARGETS: &[Target] = &[
    Target {
        name: "x86_64-unknown-linux-gnu",
        packages: ALL,
    },
    Target {
        name: "aarch64-unknown-linux-gnu",
        packages: ALL,
    },
    Target {
        name: "x86_64-pc-windows-msvc",
        packages: ALL,
    },
    Target {
        name: "x86_64-apple-darwin",
        packages: ALL,
    },
    Target {
        name: "aarch64-apple-darwin",
        packages: ALL,
    },
    Target {
        name: "wasm32-wasip1-threads",
        packages: BROWSER,
    },
];

/// Checks all targets, or those that the arguments name.
pub fn run(arguments: &[String]) -> ExitCode {
    let chosen = match chosen(arguments) {
        Ok(chosen) => chosen,
        Err(problem) => {
            eprintln!("{problem}");
            return ExitCode::from(COULD_NOT_RUN);
        }
    };
    let mut code = ExitCode::SUCCESS;
    let mut results = Vec::new();
    for target in chosen {
        let result = match rustup::add_target(target.name) {
            Ok(()) => succeeded(&mut cargo(&words(target))).map_or("errors", |()| "no error"),
            Err(problem) => {
                eprintln!("{problem}");
                "not checked"
            }
        };
        if result != "no error" {
            code = ExitCode::from(FOUND_WRONG);
        }
        results.push(format!("{:<28}{result}", target.name));
    }
    println!("{}", results.join("\n"));
    code
}

/// The words of cargo for a target: with its tests, examples and benchmarks.
fn words(target: &Target) -> Vec<&'static str> {
    let mut words = vec!["check", "--locked", "--all-targets", "--target", target.name];
    words.extend(target.packages);
    words
}

/// The targets that the arguments name; all of them without arguments.
///
/// # Errors
/// One is not in the list.
fn chosen(arguments: &[String]) -> Result<Vec<&'static Target>, String> {
    if arguments.is_empty() {
        return Ok(TARGETS.iter().collect());
    }
    let known = |argument: &String| {
        let found = TARGETS.iter().find(|target| target.name == argument);
        found.ok_or_else(|| {
            let names: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
            format!("`{argument}` is not one of {}", names.join(", "))
        })
    };
    arguments.iter().map(known).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_targets_are_checked_and_others_refused() {
        let names = |arguments: &[&str]| -> Result<Vec<&str>, String> {
            let arguments: Vec<String> = arguments.iter().map(|name| (*name).to_owned()).collect();
            Ok(chosen(&arguments)?.iter().map(|target| target.name).collect())
        };
        assert_eq!(names(&[]).unwrap().len(), TARGETS.len());
        assert_eq!(names(&["x86_64-apple-darwin"]).unwrap(), ["x86_64-apple-darwin"]);
        let problem = names(&["--fast"]).unwrap_err();
        assert!(problem.contains("`--fast`") && problem.contains("wasm32-wasip1-threads"));
    }

    #[test]
    fn the_browser_gets_its_own_crate_alone() {
        let browser = TARGETS
            .iter()
            .find(|target| target.name.starts_with("wasm32"))
            .unwrap();
        let words = words(browser);
        assert!(words.contains(&"armill-browser") && !words.contains(&"--workspace"));
    }
}
