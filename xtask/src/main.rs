//! The chores of armill: `cargo xtask <chore>`. What a person would otherwise have to remember stands here.
//!
//! Exit code 0: done, nothing to complain about. 1: the chore found something wrong. 2: it could not run.
//!
//! ```text
//! cargo xtask tidy            what the name says; the arguments behind it belong to the chore
//! cargo xtask                 lists all chores and leaves with 2
//! ```
//!
//! A chore works from the root of the repository, wherever it is called. It depends on no crate, so that it
//! builds where nothing else does; what it needs besides (a runner of tests, a compiler for C++, cargo-deny) it
//! asks for in words.

// A chore talks to a person: the report goes to stdout, everything else to stderr.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod audit;
mod bench;
mod command;
mod dist;
mod fuzz;
mod node;
mod scale;
mod serve;
mod test;
mod tidy;
mod validate;
mod web;

use std::path::PathBuf;
use std::process::ExitCode;
use std::{env, fs};

/// The exit code of a chore that found something wrong.
const FOUND_WRONG: u8 = 1;
/// The exit code of a chore that could not run: unknown name, missing program.
const COULD_NOT_RUN: u8 = 2;

/// Something a person does to this repository, by name.
struct Chore {
    name: &'static str,
    /// The line in the list: what it does, and the arguments that it takes.
    about: &'static str,
    /// Does it, with what follows the name on the command line.
    run: fn(&[String]) -> ExitCode,
}

/// In the order of the list; ARCHITECTURE.md names them in the same order.
const CHORES: &[Chore] = &[
    Chore {
        name: "test",
        about: test::ABOUT,
        run: test::run,
    },
    Chore {
        name: "tidy",
        about: tidy::ABOUT,
        run: tidy::run,
    },
    Chore {
        name: "validate",
        about: validate::ABOUT,
        run: validate::run,
    },
    Chore {
        name: "bench",
        about: bench::ABOUT,
        run: bench::run,
    },
    Chore {
        name: "fuzz",
        about: fuzz::ABOUT,
        run: fuzz::run,
    },
    Chore {
        name: "scale",
        about: scale::ABOUT,
        run: scale::run,
    },
    Chore {
        name: "web",
        about: web::ABOUT,
        run: web::run,
    },
    Chore {
        name: "serve",
        about: serve::ABOUT,
        run: serve::run,
    },
    Chore {
        name: "audit",
        about: audit::ABOUT,
        run: audit::run,
    },
    Chore {
        name: "dist",
        about: dist::ABOUT,
        run: dist::run,
    },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let Some((name, rest)) = arguments.split_first() else {
        eprint!("{}", list_of_chores());
        return ExitCode::from(COULD_NOT_RUN);
    };
    if name == "--help" || name == "-h" || name == "help" {
        print!("{}", list_of_chores());
        return ExitCode::SUCCESS;
    }
    let Some(chore) = CHORES.iter().find(|chore| chore.name == name) else {
        eprint!("no chore is called {name}\n\n{}", list_of_chores());
        return ExitCode::from(COULD_NOT_RUN);
    };
    if let Err(problem) = go_to_repository_root() {
        eprintln!("{problem}");
        return ExitCode::from(COULD_NOT_RUN);
    }
    (chore.run)(rest)
}

/// All chores, one a line.
fn list_of_chores() -> String {
    let mut list = String::from("usage: cargo xtask <chore> [arguments]\n\n");
    for chore in CHORES {
        list += &format!("  {:<10}{}\n", chore.name, chore.about);
    }
    list
}

/// Makes the repository root the working directory, so that every chore does the same wherever it is called.
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
    fn help_names_every_chore_with_a_sentence() {
        let list = list_of_chores();
        for chore in CHORES {
            assert!(list.contains(chore.name));
            assert!(chore.about.ends_with('.'), "{} has no sentence", chore.name);
        }
    }
}
