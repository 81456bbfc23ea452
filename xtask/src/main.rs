//! The tasks of armill: `cargo xtask <task>`. They automate the steps of development and release.
//!
//! Exit code 0: done, no problem found. 1: the task found a problem. 2: it could not run.
//!
//! ```text
//! cargo xtask tidy            runs this task; the arguments behind it belong to the task
//! cargo xtask                 lists all tasks and exits with 2
//! ```
//!
//! A task works from the root of the repository, wherever it is called. It depends on no crate, so that it
//! builds everywhere; if it needs another program (a runner of tests, a compiler for C++, cargo-deny), it says
//! what to install.

// A task reports to stdout; everything else goes to stderr.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod audit;
mod bench;
mod command;
mod dist;
mod fuzz;
mod node;
mod rustup;
mod scale;
mod serve;
mod site;
mod targets;
mod test;
mod tidy;
mod validate;
mod web;

use std::path::PathBuf;
use std::process::ExitCode;
use std::{env, fs};

/// The exit code of a task that found something wrong.
const FOUND_WRONG: u8 = 1;
/// The exit code of a task that could not run: unknown name, missing program.
const COULD_NOT_RUN: u8 = 2;

/// A task of development or release, by name.
struct RepositoryTask {
    name: &'static str,
    /// The line in the list: what it does, and the arguments that it takes.
    about: &'static str,
    /// Does it, with what follows the name on the command line.
    run: fn(&[String]) -> ExitCode,
}

/// In the order of the list; ARCHITECTURE.md names them in the same order.
const TASKS: &[RepositoryTask] = &[
    RepositoryTask {
        name: "test",
        about: test::ABOUT,
        run: test::run,
    },
    RepositoryTask {
        name: "tidy",
        about: tidy::ABOUT,
        run: tidy::run,
    },
    RepositoryTask {
        name: "validate",
        about: validate::ABOUT,
        run: validate::run,
    },
    RepositoryTask {
        name: "bench",
        about: bench::ABOUT,
        run: bench::run,
    },
    RepositoryTask {
        name: "fuzz",
        about: fuzz::ABOUT,
        run: fuzz::run,
    },
    RepositoryTask {
        name: "scale",
        about: scale::ABOUT,
        run: scale::run,
    },
    RepositoryTask {
        name: "web",
        about: web::ABOUT,
        run: web::run,
    },
    RepositoryTask {
        name: "serve",
        about: serve::ABOUT,
        run: serve::run,
    },
    RepositoryTask {
        name: "site",
        about: site::ABOUT,
        run: site::run,
    },
    RepositoryTask {
        name: "audit",
        about: audit::ABOUT,
        run: audit::run,
    },
    RepositoryTask {
        name: "targets",
        about: targets::ABOUT,
        run: targets::run,
    },
    RepositoryTask {
        name: "dist",
        about: dist::ABOUT,
        run: dist::run,
    },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let Some((name, rest)) = arguments.split_first() else {
        eprint!("{}", list_of_tasks());
        return ExitCode::from(COULD_NOT_RUN);
    };
    if name == "--help" || name == "-h" || name == "help" {
        print!("{}", list_of_tasks());
        return ExitCode::SUCCESS;
    }
    let Some(task) = TASKS.iter().find(|task| task.name == name) else {
        eprint!("no task is called {name}\n\n{}", list_of_tasks());
        return ExitCode::from(COULD_NOT_RUN);
    };
    if let Err(problem) = go_to_repository_root() {
        eprintln!("{problem}");
        return ExitCode::from(COULD_NOT_RUN);
    }
    (task.run)(rest)
}

/// All tasks, one a line.
fn list_of_tasks() -> String {
    let mut list = String::from("usage: cargo xtask <task> [arguments]\n\n");
    for task in TASKS {
        list += &format!("  {:<10}{}\n", task.name, task.about);
    }
    list
}

/// Makes the repository root the working directory, so that every task does the same wherever it is called.
///
/// # Errors
/// There is no `Cargo.toml` where the root should be, or the folder cannot be entered.
fn go_to_repository_root() -> Result<(), String> {
    // Cargo sets the variable for `cargo run`; without it the caller is in the root.
    let xtask = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let root = xtask
        .and_then(|folder| folder.parent().map(PathBuf::from))
        .unwrap_or_default();
    let root = fs::canonicalize(root.join("Cargo.toml"))
        .map_err(|problem| format!("no Cargo.toml in {}: {problem}", root.display()))?;
    let folder = root.parent().unwrap_or(&root);
    env::set_current_dir(folder).map_err(|problem| format!("cannot enter {}: {problem}", folder.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_names_every_task_with_a_sentence() {
        let list = list_of_tasks();
        for task in TASKS {
            assert!(list.contains(task.name));
            assert!(task.about.ends_with('.'), "{} has no sentence", task.name);
        }
    }
}
