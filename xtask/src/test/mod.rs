//! All tests on a fresh machine: every step is announced, counted and timed; a failed step does not stop the next.
//!
//! `ARMILL_SAMPLES` goes through to the tests: with it a missing sample fails a test, without it the test
//! says that it was skipped.
//!
//! `step`: one of them; `page`: those of the page of `armill serve`; `python`: those of the Python package;
//! `count`: the tests in what it printed; `room`: whether the disk has room for them.
//!
//! First everything is built, then it is tested. Lists of steps of a stage run at the same time, since a single Python and a
//! linker leave processors unused; the output of the first list is printed at once, that of a step of the others when the step has ended.
//!
//! | stage | steps | fails where |
//! |---|---|---|
//! | page | the page | see `page` |
//! | built | unit and integration tests | a crate or a test does not compile |
//! | | the page without a server | see `page` |
//! | | the Python package: environment | a package of the tests cannot be installed |
//! | tested | unit and integration tests | one does not pass, in any crate of the workspace |
//! | | documentation tests | an example in the documentation does not compile or run |
//! | | documentation | a link leads nowhere, or rustdoc has another warning |
//! | | the kernel for NEON | it does not compile; left out without the standard library for that target |
//! | | the Python package | see `python` |
//! | | the documentation | its tests fail, a page cannot be built, or a link, picture or anchor leads nowhere |
//! | | the page | see `page` |
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
use std::thread;
use step::{Outcome, Output, Step};

/// Description in the list of tasks.
pub const ABOUT: &str = "Runs all tests, also on a fresh machine: unit, integration, documentation, the page in a browser, Python.";

/// What makes up "all tests": stages, one after the other, of lists that run at the same time. A new step, an installation included, is
/// one line here.
fn stages() -> Vec<Vec<Vec<Step>>> {
    // First, so that the program whose tests run contains the page.
    let page = page::build();
    let built = vec![Step::new(
        "unit and integration tests, built",
        test_runner(&["--no-run"]),
    )];
    // The kernel of the browser is one unit, which leaves a processor to the tests.
    let without_server = page::build_without_server();
    python::ensure();
    let environment = python::environment();

    let mut tested = vec![
        Step::new("unit and integration tests", test_runner(&["--no-fail-fast"])),
        Step::new(
            "documentation tests",
            cargo(&["test", "--doc", "--workspace", "--no-fail-fast"]),
        ),
        Step::new("documentation", documentation_without_warnings()),
    ];
    match rustup::add_target(NEON) {
        Ok(()) => tested.push(Step::new(
            "the kernel for NEON, compiled only",
            cargo(&["check", "-p", "armill-core", "--target", NEON]),
        )),
        Err(problem) => eprintln!("the kernel for NEON is not compiled: {problem}"),
    }
    let mut pages = Step::all(documentation());
    pages.extend(page::tests());
    vec![
        vec![page],
        vec![built, without_server, environment],
        vec![tested, python::tests(), pages],
    ]
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
    let outcomes: Vec<Outcome> = stages().into_iter().flat_map(run_together).collect();
    println!("\n{}", table(&outcomes));
    let total = outcomes
        .iter()
        .map(|outcome| outcome.count)
        .fold(Count::default(), Count::plus);
    println!("tests: {total}");
    verdict(&outcomes, total)
}

/// Runs lists of steps at the same time, the steps of a list one after the other.
fn run_together(lists: Vec<Vec<Step>>) -> Vec<Outcome> {
    let run = |steps: Vec<Step>, output| steps.into_iter().map(|step| step.run(output)).collect();
    let mut lists = lists.into_iter();
    let first = lists.next().unwrap_or_default();
    thread::scope(|scope| {
        let others: Vec<_> = lists
            .map(|steps| scope.spawn(move || -> Vec<Outcome> { run(steps, Output::Kept) }))
            .collect();
        let mut outcomes: Vec<Outcome> = run(first, Output::Live);
        for other in others {
            outcomes.extend(other.join().expect("a step that fails has an outcome"));
        }
        outcomes
    })
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

/// Nextest where it is installed (it shows progress and runs in parallel), else the runner every cargo has; with these options.
fn test_runner(options: &[&str]) -> Command {
    let mut command = if has_cargo_tool("nextest") {
        cargo(&["nextest", "run", "--workspace"])
    } else {
        eprintln!("cargo-nextest is not installed: cargo test is used instead");
        // Without documentation tests, which have a step of their own, and without the module of Python, whose manifest says that it has
        // no tests: `--lib` links it all the same, which needs Python.
        cargo(&["test", "--workspace", "--tests"])
    };
    command.args(options);
    command
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
    fn lists_of_a_stage_are_run_at_the_same_time_and_each_in_order() {
        // Each waits for a file that the other list writes: one after the other they would never end.
        let folder = env::temp_dir().join(format!("armill-xtask-{}", std::process::id()));
        std::fs::create_dir(&folder).unwrap();
        let step = |name, script: &str| {
            let mut command = Command::new("sh");
            command.args(["-c", script]).current_dir(&folder);
            Step::new(name, command)
        };
        let wait = |file: &str| {
            format!("for i in $(seq 6000); do test -e {file} && exit 0; sleep 0.01; done; exit 1")
        };
        let outcomes = run_together(vec![
            vec![step("a", "touch a"), step("b", &wait("c"))],
            vec![
                step("c", &format!("({}) && touch c", wait("a"))),
                step("d", "false"),
            ],
        ]);
        std::fs::remove_dir_all(&folder).unwrap();
        let of = |outcome: &Outcome| (outcome.name, outcome.passed);
        let found: Vec<_> = outcomes.iter().map(of).collect();
        assert_eq!(found, [("a", true), ("b", true), ("c", true), ("d", false)]);
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
