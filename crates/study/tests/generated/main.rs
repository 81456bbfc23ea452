//! Study files that are generated from the schema: armill answers or says what is wrong, and never panics.
//!
//! The suite checks a few hundred; `cargo xtask fuzz --studies N` checks N of them, which it says in `ARMILL_STUDIES`.
//! A finding names its seed; `ARMILL_STUDY_SEED=SEED` checks that study alone, and prints it.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod generator;
mod random;
mod requirements;
mod schema;
mod tree;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use std::{env, thread};

use generator::Generator;
use requirements::{Outcome, check};

/// Studies that the suite checks.
const FEW: u64 = 300;
/// Of so many studies one is evaluated, if it is valid.
const SHARE: u64 = 4;
/// Studies between two lines of progress.
const PROGRESS: u64 = 2000;
/// Studies that take longer are named.
const SLOW: Duration = Duration::from_secs(2);

/// How many studies ended how.
#[derive(Debug, Default)]
struct Counts {
    not_toml: u64,
    refused: u64,
    accepted: u64,
    evaluated: u64,
    findings: Vec<String>,
}

impl Counts {
    fn add(&mut self, outcome: &Outcome) {
        match outcome {
            Outcome::NotToml => self.not_toml += 1,
            Outcome::Refused => self.refused += 1,
            Outcome::Accepted => self.accepted += 1,
            Outcome::Evaluated => self.evaluated += 1,
        }
    }
}

fn number(variable: &str) -> Option<u64> {
    let text = env::var(variable).ok()?;
    Some(
        text.parse()
            .unwrap_or_else(|_| panic!("{variable} is not a whole number: {text}")),
    )
}

/// Checks the study of one seed; a panic is a finding too.
fn checked(generator: &Generator, seed: u64) -> Result<Outcome, String> {
    let study = generator.study(seed);
    let outcome = catch_unwind(AssertUnwindSafe(|| check(&study, seed.is_multiple_of(SHARE))));
    let found = match outcome {
        Ok(Ok(outcome)) => return Ok(outcome),
        Ok(Err(found)) => found,
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned();
            text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()))
                .unwrap_or_default()
        }
    };
    Err(format!("seed {seed}: {found}"))
}

/// Checks these seeds on all threads.
fn counts(generator: &Generator, first: u64, end: u64) -> Counts {
    let next = AtomicU64::new(first);
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let work = || {
        let mut counts = Counts::default();
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= end {
                return counts;
            }
            if seed.is_multiple_of(PROGRESS) {
                println!("study {seed}");
            }
            let begun = Instant::now();
            let outcome = checked(generator, seed);
            // For the reader alone: nothing depends on it.
            if begun.elapsed() > SLOW {
                println!("study {seed} took {:.1} s", begun.elapsed().as_secs_f64());
            }
            match outcome {
                Ok(outcome) => counts.add(&outcome),
                Err(found) => {
                    println!("FOUND {found}");
                    counts.findings.push(found);
                }
            }
        }
    };
    let parts = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .map(|worker| worker.join().unwrap())
            .collect::<Vec<_>>()
    });
    let mut all = Counts::default();
    for part in parts {
        all.not_toml += part.not_toml;
        all.refused += part.refused;
        all.accepted += part.accepted;
        all.evaluated += part.evaluated;
        all.findings.extend(part.findings);
    }
    all
}

#[test]
fn generated_studies_are_answered_or_refused_with_a_reason() {
    let generator = Generator::new();
    if let Some(seed) = number("ARMILL_STUDY_SEED") {
        let study = generator.study(seed);
        println!(
            "{}\n# in {}",
            String::from_utf8_lossy(&study.bytes),
            study.folder.display()
        );
        println!("{:?}", check(&study, true).unwrap());
        return;
    }
    let studies = number("ARMILL_STUDIES").unwrap_or(FEW);
    let first = number("ARMILL_STUDY_FIRST").unwrap_or(0);
    let counts = counts(&generator, first, first + studies);
    println!("{counts:?}");
    assert!(counts.findings.is_empty(), "{}", counts.findings.join("\n"));
    // Each kind of end is reached, else the generator has lost its aim.
    for count in [
        counts.not_toml,
        counts.refused,
        counts.accepted + counts.evaluated,
        counts.evaluated,
    ] {
        assert!(count > studies / 50, "{counts:?}");
    }
}

#[test]
fn the_studies_that_others_are_made_from_are_good() {
    for (file, study) in Generator::new().unchanged() {
        let outcome = check(&study, true).unwrap_or_else(|found| panic!("{file}: {found}"));
        let good = matches!(outcome, Outcome::Accepted | Outcome::Evaluated);
        assert!(good, "{file}: {outcome:?}\n{}", requirements::refusal(&study));
    }
}

#[test]
fn the_study_of_a_seed_is_always_the_same() {
    let [one, other] = [Generator::new(), Generator::new()];
    for seed in 0..20 {
        assert_eq!(one.study(seed).bytes, other.study(seed).bytes);
    }
    assert_ne!(one.study(0).bytes, one.study(1).bytes);
}
