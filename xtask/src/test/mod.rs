//! All tests on a fresh machine: every step is announced, counted and timed; a failed step does not stop the next.
//!
//! `ARMILL_SAMPLES` goes through to the tests: with it a missing sample fails a test, without it the test
//! says that it was skipped.
//!
//! `step`: one of them; `page`: those of the page of `armill serve`; `python`: those of the Python package;
//! `count`: the tests in what it printed; `room`: whether the disk has room for them.
//!
//! | step | fails where |
//! |---|---|
//! | the page, built | see `page` |
//! | unit and integration tests | one does not pass, in any crate of the workspace |
//! | documentation tests | an example in the documentation does not compile or run |
//! | documentation | a link leads nowhere, or rustdoc has another warning |
//! | the kernel for NEON | it does not compile; left out without the standard library for that target |
//! | the documentation | its tests fail, a page cannot be built, or a link, picture or anchor leads nowhere |
//! | the page, tested | see `page` |
//! | the Python package | see `python` |
//!
//! Exit codes as for any task; a run without a single test could not run.

mod count;
mod page;
mod python;
mod room;
mod step;

use crate::command::{cargo, expect_no_arguments, has_cargo_tool};
use crate::site::documentation;
use crate::{COULD_NOT_RUN, FOUND_WRONG, rustup};
use count::Count;
use std::env;
use std::process::{Command, ExitCode, Stdio};
use step::{Outcome, Step};

/// Description in the list of tasks.
pub const ABOUT: &str = "Runs all tests, also on a fresh machine: unit, integration, documentation, the page in a browser, Python.";

/// What makes up "all tests", in order. A new step, an installation included, is one line here.
fn steps() -> Vec<Step> {
    // First, so that the program whose tests run contains the page.
    let mut steps = page::build();
    steps.extend([
        Step::new("unit and integration tests", test_runner()),
        Step::new(
            "documentation tests",
            cargo(&["test", "--doc", "--workspace", "--no-fail-fast"]),
        ),
        Step::new("documentation", documentation_without_warnings()),
    ]);
    match rustup::add_target(NEON) {
        Ok(()) => steps.push(Step::new(
            "the kernel for NEON, compiled only",
            cargo(&["check", "-p", "armill-core", "--target", NEON]),
        )),
        Err(problem) => eprintln!("the kernel for NEON is not compiled: {problem}"),
    }
    steps.extend(site_documentation());
    steps.extend(page::tests());
    steps.extend(python::steps());
    steps
}

/// Installs Python where it is missing; gives the steps that build the documentation next to the page without a server.
fn site_documentation() -> Vec<Step> {
    python::ensure();
    match documentation() {
        Ok(made) => made
            .into_iter()
            .map(|(name, command)| Step::new(name, command))
            .collect(),
        // Its test in Chromium fails.
        Err(problem) => {
            eprintln!("{problem}");
            Vec::new()
        }
    }
}

/// The target whose back end cannot run on our test machines.
const NEON: &str = "aarch64-unknown-linux-gnu";

/// Runs all steps, then prints the time of each and, in the closing line, the number of tests.
pub fn run(arguments: &[String]) -> ExitCode {
    if let Err(code) = expect_no_arguments("test", arguments) {
        return code;
    }
    match env::var_os("ARMILL_SAMPLES") {
        Some(folder) => {
            eprintln!("samples: {}; a missing one fails its test", folder.display());
        }
        None => {
            eprintln!("samples: ARMILL_SAMPLES is not set; tests that need them say that they are skipped");
        }
    }
    room::warn_if_little();
    let outcomes: Vec<Outcome> = steps().into_iter().map(Step::run).collect();
    println!("\n{}", table(&outcomes));
    let total = outcomes
        .iter()
        .map(|outcome| outcome.count)
        .fold(Count::default(), Count::plus);
    println!("tests: {total}");
    verdict(&outcomes, total)
}

/// Installs these packages with apt-get, and says so.
fn install(packages: &[&str]) {
    eprintln!("installing for the tests: {}", packages.join(", "));
    for arguments in [
        vec!["update"],
        [vec!["install", "-y"], packages.to_vec()].concat(),
    ] {
        let done = Command::new("apt-get")
            .args(&arguments)
            .stdout(Stdio::null())
            .status();
        if !done.is_ok_and(|status| status.success()) {
            eprintln!(
                "apt-get {} failed: install {} by hand",
                arguments.join(" "),
                packages.join(", ")
            );
            return;
        }
    }
}

/// Nextest where it is installed (it shows progress and runs in parallel), else the runner every cargo has.
fn test_runner() -> Command {
    if has_cargo_tool("nextest") {
        return cargo(&[
            "nextest",
            "run",
            "--workspace",
            "--no-fail-fast",
            "--no-tests=pass",
        ]);
    }
    eprintln!("cargo-nextest is not installed: cargo test is used instead");
    // `--doc` has a step of its own, and these targets leave it out.
    cargo(&[
        "test",
        "--workspace",
        "--no-fail-fast",
        "--lib",
        "--bins",
        "--tests",
        "--examples",
    ])
}

/// Builds the documentation of our crates; a broken link or a warning fails.
fn documentation_without_warnings() -> Command {
    let mut command = cargo(&["doc", "--no-deps", "--workspace"]);
    command.env("RUSTDOCFLAGS", "-D warnings");
    command
}

/// One line a step: verdict, wall time, name.
fn table(outcomes: &[Outcome]) -> String {
    let line = |outcome: &Outcome| {
        let verdict = if outcome.passed { "ok" } else { "FAILED" };
        format!(
            "{verdict:<7}{:>7.1} s  {}\n",
            outcome.wall_time.as_secs_f64(),
            outcome.name
        )
    };
    outcomes.iter().map(line).collect()
}

/// A run without a single test is reported as one that could not run.
fn verdict(outcomes: &[Outcome], total: Count) -> ExitCode {
    if outcomes.iter().any(|outcome| !outcome.passed) {
        return ExitCode::from(FOUND_WRONG);
    }
    if total.passed == 0 {
        eprintln!("no test ran: the summary of the runner was not recognised, or there are no tests");
        return ExitCode::from(COULD_NOT_RUN);
    }
    ExitCode::SUCCESS
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn outcome(passed: bool) -> Outcome {
        let count = Count {
            passed: 3,
            failed: 0,
            skipped: 0,
        };
        Outcome {
            name: "made up",
            passed,
            count,
            wall_time: Duration::from_millis(1250),
        }
    }

    #[test]
    fn table_names_verdict_and_wall_time() {
        let table = table(&[outcome(true), outcome(false)]);
        assert_eq!(table, "ok         1.2 s  made up\nFAILED     1.2 s  made up\n");
    }

    #[test]
    fn one_failed_step_fails_the_run() {
        let total = Count {
            passed: 3,
            failed: 0,
            skipped: 0,
        };
        assert_eq!(
            verdict(&[outcome(true), outcome(false)], total),
            ExitCode::from(FOUND_WRONG)
        );
        assert_eq!(verdict(&[outcome(true)], total), ExitCode::SUCCESS);
    }

    #[test]
    fn a_run_without_tests_is_no_pass() {
        assert_eq!(
            verdict(&[outcome(true)], Count::default()),
            ExitCode::from(COULD_NOT_RUN)
        );
    }
}
