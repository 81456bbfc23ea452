//! How many tests ran, read from the summary lines of the test runners.
//!
//! | runner | line | passed, failed, skipped |
//! |---|---|---|
//! | `cargo test` | `test result: ok. 5 passed; 0 failed; 1 ignored; ...` | 5, 0, 1; one line for each program |
//! | nextest | `Summary [   0.01s] 5 tests run: 5 passed, 1 skipped` | 5, 0, 1; one line in all |
//! | vitest | `Tests  1 failed \| 5 passed \| 1 skipped (7)` | 5, 1, 1; one line in all |
//! | pytest | `===== 1 failed, 5 passed, 1 skipped in 0.12s =====` | 5, 1, 1; one line in all; what breaks before its test counts as failed |
//! | node | `ℹ pass 5`, or `# pass 5`; the same with `fail`, `skipped` | a line each |
//!
//! Not checked: what the runners print elsewhere; a summary in other words counts nothing, and a run that
//! counts nothing is reported as one that could not run.

use std::fmt;

/// Tests by verdict. Prints as `12 passed, 0 failed, 1 skipped`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Tests that ran and passed.
    pub passed: u64,
    /// Tests that ran and did not pass, for whatever reason.
    pub failed: u64,
    /// Tests that did not run.
    pub skipped: u64,
}

impl Count {
    /// Both together, verdict by verdict.
    pub fn plus(self, other: Self) -> Self {
        Self {
            passed: self.passed + other.passed,
            failed: self.failed + other.failed,
            skipped: self.skipped + other.skipped,
        }
    }

    /// What a line of a runner's output adds; nothing unless it is a summary line.
    ///
    /// Understood: `test result: ok. 5 passed; 0 failed; 1 ignored; ...` (cargo test) and
    /// `Summary [   0.01s] 5 tests run: 5 passed, 1 skipped` (nextest).
    pub fn in_line(line: &str) -> Self {
        let line = line.trim();
        if line.starts_with("test result:") {
            return Self {
                passed: number_before(line, "passed"),
                failed: number_before(line, "failed"),
                skipped: number_before(line, "ignored"),
            };
        }
        if line.starts_with("Summary [") {
            let passed = number_before(line, "passed");
            // Failed, timed out and not started are reported separately there; none of them passed.
            let run = number_before(line, "tests run:").max(number_before(line, "test run:"));
            let skipped = number_before(line, "skipped");
            return Self {
                passed,
                failed: run.saturating_sub(passed),
                skipped,
            };
        }
        if line.starts_with('=') && line.ends_with('=') && line.contains(" in ") {
            return Self {
                passed: number_before(line, " passed"),
                failed: number_before(line, " failed") + number_before(line, " error"),
                skipped: number_before(line, " skipped"),
            };
        }
        let words: Vec<&str> = line.split_whitespace().collect();
        if let ["Tests", ..] = words[..] {
            return Self {
                passed: number_before(line, "passed"),
                failed: number_before(line, "failed"),
                skipped: number_before(line, "skipped"),
            };
        }
        if let ["ℹ" | "#", verdict, number] = words[..] {
            let number = number.parse().unwrap_or(0);
            let of = |name: &str| if verdict == name { number } else { 0 };
            return Self {
                passed: of("pass"),
                failed: of("fail"),
                skipped: of("skipped"),
            };
        }
        Self::default()
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} passed, {} failed, {} skipped",
            self.passed, self.failed, self.skipped
        )
    }
}

/// The number right before `word`; 0 where there is none. A cancelled run's `3/8` counts as 3.
fn number_before(line: &str, word: &str) -> u64 {
    let before = line.split(word).next().filter(|before| before.len() < line.len());
    let last = before
        .and_then(|before| before.split_whitespace().last())
        .unwrap_or_default();
    last.split('/').next().unwrap_or_default().parse().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cargo_test_summary_is_counted() {
        let line =
            "test result: FAILED. 15 passed; 2 failed; 1 ignored; 0 measured; 4 filtered out; finished";
        assert_eq!(
            Count::in_line(line),
            Count {
                passed: 15,
                failed: 2,
                skipped: 1
            }
        );
    }

    #[test]
    fn summaries_of_the_page_are_counted() {
        let counted = |line| Count::in_line(line).to_string();
        assert_eq!(
            counted("      Tests  1 failed | 29 passed | 2 skipped (32)"),
            "29 passed, 1 failed, 2 skipped"
        );
        assert_eq!(
            counted(" Test Files  5 passed (5)"),
            "0 passed, 0 failed, 0 skipped"
        );
        assert_eq!(counted("ℹ pass 37"), "37 passed, 0 failed, 0 skipped");
        assert_eq!(counted("# fail 2"), "0 passed, 2 failed, 0 skipped");
        assert_eq!(counted("ℹ skipped 1"), "0 passed, 0 failed, 1 skipped");
        assert_eq!(counted("ℹ tests 40"), "0 passed, 0 failed, 0 skipped");
    }

    #[test]
    fn pytest_summary_is_counted() {
        let counted = |line| Count::in_line(line).to_string();
        assert_eq!(
            counted("==== 1 failed, 41 passed, 2 skipped, 1 error in 12.34s ===="),
            "41 passed, 2 failed, 2 skipped"
        );
        assert_eq!(
            counted("=========== 90 passed, 2 warnings in 63.20s (0:01:03) ==========="),
            "90 passed, 0 failed, 0 skipped"
        );
        for other in [
            "=== short test summary info ===",
            "==== FAILURES ====",
            "a = 5 passed =",
        ] {
            assert_eq!(counted(other), "0 passed, 0 failed, 0 skipped");
        }
    }

    #[test]
    fn nextest_summary_is_counted() {
        let line =
            "     Summary [   0.127s] 23 tests run: 21 passed (1 slow), 1 failed, 1 timed out, 2 skipped";
        assert_eq!(
            Count::in_line(line),
            Count {
                passed: 21,
                failed: 2,
                skipped: 2
            }
        );
        let single = "Summary [   0.001s] 1 test run: 1 passed, 0 skipped";
        assert_eq!(
            Count::in_line(single),
            Count {
                passed: 1,
                failed: 0,
                skipped: 0
            }
        );
    }

    #[test]
    fn cancelled_nextest_run_counts_what_ran() {
        let line = "Summary [   0.127s] 3/8 tests run: 2 passed, 1 failed, 0 skipped";
        assert_eq!(
            Count::in_line(line),
            Count {
                passed: 2,
                failed: 1,
                skipped: 0
            }
        );
    }

    #[test]
    fn other_lines_are_not_counted() {
        assert_eq!(
            Count::in_line("PASS [0.003s] armill-core 3 passed"),
            Count::default()
        );
        assert_eq!(Count::in_line(""), Count::default());
    }

    #[test]
    fn closing_line_states_the_counts() {
        let count = Count {
            passed: 3,
            failed: 0,
            skipped: 1,
        }
        .plus(Count {
            passed: 2,
            failed: 1,
            skipped: 0,
        });
        assert_eq!(count.to_string(), "5 passed, 1 failed, 1 skipped");
    }
}
