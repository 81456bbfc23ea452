//! Runs every validation case, prints the errors, and writes `validation/TABLE.md`.
//!
//! ```text
//! passes tx200-compliance: translational compliance in the workpiece frame: 0.00043 um/N (tolerance 0.0005 um/N)
//! ...
//! validation: 13 cases, 0 checks fail
//! ```
//!
//! The table is written even where a check fails, so that it shows what was reached; `docs/measured.md` where `ARMILL_SAMPLES` names
//! the folder of the measurements. Exit code 1 where a check fails or a file cannot be written.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program that prints its results"
)]

use std::process::ExitCode;

use armill_validation::measured::{Samples, page};
use armill_validation::{results, table};

fn main() -> ExitCode {
    let results = results();
    for (case, checks) in &results {
        for check in checks {
            let (verdict, tolerance) = (table::verdict(check), &check.tolerance);
            println!(
                "{verdict} {}: {}: {} (tolerance {tolerance})",
                case.folder, check.what, check.reached
            );
        }
    }
    if let Err(problem) = std::fs::write(table::PATH, table::table(&results)) {
        eprintln!("cannot write {}: {problem}", table::PATH);
        return ExitCode::FAILURE;
    }
    match Samples::from_environment() {
        None => println!("docs/measured.md is not written: ARMILL_SAMPLES is not set"),
        Some(samples) => {
            if let Err(problem) = std::fs::write(page::PATH, page::page(&samples)) {
                eprintln!("cannot write {}: {problem}", page::PATH);
                return ExitCode::FAILURE;
            }
        }
    }
    let wrong = results
        .iter()
        .flat_map(|(_, checks)| checks)
        .filter(|check| !check.passed)
        .count();
    println!("validation: {} cases, {wrong} checks fail", results.len());
    if wrong == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
