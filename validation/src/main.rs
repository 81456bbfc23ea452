//! Runs every validation case, tells how near each came, and writes `validation/TABLE.md`.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program that tells its results"
)]

use std::process::ExitCode;

use armill_validation::{results, table};

fn main() -> ExitCode {
    let results = results();
    for (case, checks) in &results {
        for check in checks {
            let (verdict, tolerance) = (table::verdict(check), &check.tolerance);
            println!(
                "{verdict} {}: {}: {} (may be {tolerance})",
                case.folder, check.what, check.reached
            );
        }
    }
    if let Err(problem) = std::fs::write(table::PATH, table::table(&results)) {
        eprintln!("cannot write {}: {problem}", table::PATH);
        return ExitCode::FAILURE;
    }
    let wrong = results
        .iter()
        .flat_map(|(_, checks)| checks)
        .filter(|check| !check.holds)
        .count();
    println!("validation: {} cases, {wrong} checks fail", results.len());
    if wrong == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
