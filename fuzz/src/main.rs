//! Coverage-guided fuzzing of every parser: one program, one [`targets::TARGETS`] table, one target a run.
//!
//! `cargo xtask fuzz` builds this with the counters of LLVM's sanitizer coverage and calls it; libFuzzer has the
//! `main`. A run is configured by the environment:
//!
//! | variable | meaning |
//! |---|---|
//! | `ARMILL_FUZZ_TARGET` | name of the target; without it the names of all are printed and nothing is run |
//! | `ARMILL_FUZZ_FOLDER` | where `corpus/TARGET/` and `dictionaries/TARGET.dict` are written before the run |
//! | `ARMILL_SAMPLES` | folder of sample files: those that a target reads are seeds too |
//!
//! An input is bytes as they would come from disk; nothing is read from disk except the files that an input names.
//! To add a target: one line in [`targets::TARGETS`]. To fuzz further: `cargo xtask fuzz TARGET --seconds 3600`; what
//! was found stays in `corpus/TARGET/`, and the next run begins there.

#![no_main]

mod corpus;
mod dictionaries;
mod edited;
mod fixtures;
mod meshes;
mod modal;
mod scanned;
mod signal_stack;
mod tables;
mod targets;
mod tracked;
mod tracked_fixtures;
mod verdicts;

use std::sync::OnceLock;
use std::{env, panic, process, thread};

use libfuzzer_sys::fuzz_target;

use targets::{TARGETS, Target};

/// Exit code for a run that could not begin.
const COULD_NOT_RUN: i32 = 2;

static CHOSEN: OnceLock<&'static Target> = OnceLock::new();

fuzz_target!(init: begin(), |bytes: &[u8]| {
    if let Some(target) = CHOSEN.get() {
        (target.read)(bytes);
    }
});

/// Chooses the target and writes its seeds, before libFuzzer looks at the folders.
fn begin() {
    let Ok(name) = env::var("ARMILL_FUZZ_TARGET") else {
        for target in TARGETS {
            println!("{}", target.name);
        }
        process::exit(0);
    };
    let Some(target) = TARGETS.iter().find(|target| target.name == name) else {
        eprintln!("no target is called {name}");
        process::exit(COULD_NOT_RUN);
    };
    if let Some(folder) = env::var_os("ARMILL_FUZZ_FOLDER")
        && let Err(problem) = corpus::write(target, folder.as_ref())
    {
        eprintln!("cannot write the seeds: {problem}");
        process::exit(COULD_NOT_RUN);
    }
    signal_stack::install();
    let_the_expander_panic();
    CHOSEN.get_or_init(|| target);
}

/// A panic ends the run, but for one inside the crate that expands xacro: that runs in a thread of its own and becomes
/// a problem of the file.
fn let_the_expander_panic() {
    let ends_the_run = panic::take_hook();
    panic::set_hook(Box::new(move |panicked| {
        if thread::current().name() != Some(armill_formats::robot::xacro::EXPANDER) {
            ends_the_run(panicked);
        }
    }));
}
