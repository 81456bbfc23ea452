//! Lanes against the plain version of the same physics, on a million random poses of eight arms.
//!
//! `crates/core/src/kernel/solver/witness.rs` compares and prints a row for each arm and model; here they become the table
//! of `docs/theory/lanes.md`, which is printed.

use crate::command::{cargo, printed};
use crate::{COULD_NOT_RUN, FOUND_WRONG};
use std::process::ExitCode;

/// The test that compares.
const TEST: &str = "kernel::solver::witness::lanes_are_the_plain_row_on_a_million_poses";

/// Compares, and prints the table.
pub fn run() -> ExitCode {
    let arguments = [
        "test",
        "-p",
        "armill-core",
        "--lib",
        "--",
        "--ignored",
        "--nocapture",
        "--exact",
        TEST,
    ];
    match printed(&mut cargo(&arguments)) {
        Ok(output) => {
            let table = table(&output);
            println!("{table}");
            if table.lines().count() > 2 {
                ExitCode::SUCCESS
            } else {
                eprintln!("{TEST} printed no row");
                ExitCode::from(COULD_NOT_RUN)
            }
        }
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::from(FOUND_WRONG)
        }
    }
}

/// The rows in the output of the test, as a Markdown table.
fn table(output: &str) -> String {
    let mut table = String::from(
        "| arm | model | poses | largest difference | near a singularity | handed over | of these near a singularity |\n|---|---|--:|--:|--:|--:|--:|\n",
    );
    for line in output.lines() {
        // The first row may follow the name of the test.
        if let Some((_, row)) = line.split_once("witness\t") {
            table += &format!("| {} |\n", row.replace('\t', " | "));
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_become_a_table_and_other_lines_do_not() {
        let table = table("running 1 test\ntest x ... witness\ta/b\tdrives\t10\t1.0e-13\t2\t1\nok\n");
        assert!(
            table.ends_with("| a/b | drives | 10 | 1.0e-13 | 2 | 1 |\n"),
            "{table}"
        );
        assert_eq!(table.lines().count(), 3);
    }
}
