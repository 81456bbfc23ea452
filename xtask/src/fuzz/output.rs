//! The output of libFuzzer: how much was tried, how much was reached, where a finding is.
//!
//! ```text
//! #1234  NEW    cov: 567 ft: 890 corp: 12/34Kb lim: 64 exec/s: 1000 rss: 50Mb ...
//! stat::number_of_executed_units: 123456
//! stat::peak_rss_mb:              70
//! Test unit written to target/fuzz/crashes/urdf/crash-...
//! ```
//!
//! Source: what libFuzzer prints, one process or many (`-fork`), as its documentation and its runs show it.

/// The heading over all rows.
pub const HEADING: &str =
    "target        verdict   executions   per s   edges   features   inputs   most MiB\n";

/// The result of a run; the last line with a number decides.
#[derive(Debug, Default, PartialEq)]
pub struct FuzzRun {
    /// Whether it ended without a finding.
    pub passed: bool,
    /// The input of the finding.
    pub written: Option<String>,
    /// Inputs tried.
    executions: u64,
    /// Inputs tried in a second.
    per_second: u64,
    /// Branches reached (`cov`), and what libFuzzer distinguishes beyond them (`ft`).
    edges: u64,
    features: u64,
    /// Inputs kept since each reached something new.
    inputs: u64,
    /// Most memory that the run took.
    most_mib: u64,
}

impl FuzzRun {
    /// Reads a line; returns whether it is to be printed.
    pub fn read_line(&mut self, line: &str) -> bool {
        if let Some((_, file)) = line.split_once("Test unit written to ") {
            self.written = Some(file.trim().to_owned());
            return true;
        }
        let Some(progress) = line.strip_prefix('#') else {
            if let Some(total) = line.strip_prefix("stat::number_of_executed_units:") {
                self.executions = total.trim().parse().unwrap_or(self.executions);
            }
            if let Some(most) = line.strip_prefix("stat::peak_rss_mb:") {
                self.most_mib = most.trim().parse().unwrap_or(self.most_mib);
            }
            // Of the three warnings none matters: they miss functions of sanitizers.
            let talk = [
                "INFO: ",
                "stat::",
                "WARNING: Failed to find function",
                "\t",
                "\"",
                "#",
            ];
            return !line.trim().is_empty() && !talk.iter().any(|start| line.starts_with(start));
        };
        let mut words = progress.split_whitespace().peekable();
        // `#1234`, or `#1234:` of many processes.
        let executed = words
            .next()
            .and_then(|word| word.trim_end_matches(':').parse().ok());
        self.executions = executed.unwrap_or(self.executions);
        while let Some(word) = words.next() {
            let Some(value) = words.peek().and_then(|next| leading_number(next)) else {
                continue;
            };
            match word {
                "cov:" => self.edges = value,
                "ft:" => self.features = value,
                "corp:" => self.inputs = value,
                // Of many processes the number of the last second comes first, the mean in brackets.
                "exec/s:" | "exec/s" => self.per_second = value,
                _ => {}
            }
        }
        // Each new input has a line; these two begin and end the run.
        ["INITED", "DONE"].iter().any(|word| progress.contains(word))
    }

    /// One line of the report, under [`HEADING`].
    pub fn row(&self, target: &str) -> String {
        format!(
            "{target:<14}{:<10}{:>10}{:>8}{:>8}{:>11}{:>9}{:>11}\n",
            if self.passed { "ok" } else { "FOUND" },
            self.executions,
            self.per_second,
            self.edges,
            self.features,
            self.inputs,
            self.most_mib
        )
    }
}

/// The number that `12/34Kb` begins with.
fn leading_number(word: &str) -> Option<u64> {
    let end = word.find(|c: char| !c.is_ascii_digit()).unwrap_or(word.len());
    word.get(..end)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_those_of_the_last_line() {
        let mut run = FuzzRun::default();
        assert!(
            !run.read_line("#8\tNEW    cov: 2 ft: 3 corp: 2/10b lim: 4 exec/s: 0 rss: 30Mb L: 4/4 MS: 1 X-")
        );
        assert!(
            run.read_line("#524288\tDONE   cov: 310 ft: 1200 corp: 45/2Kb lim: 64 exec/s: 9000 rss: 40Mb")
        );
        assert!(!run.read_line("stat::number_of_executed_units: 524290"));
        assert!(!run.read_line("stat::peak_rss_mb:              41"));
        let row = run.row("dh");
        for number in ["524290", "9000", " 310", "1200", " 45", " 41"] {
            assert!(row.contains(number), "{row}");
        }
        assert_eq!(
            row.lines().next().map(str::len),
            HEADING.lines().next().map(str::len)
        );
    }

    #[test]
    fn the_output_of_many_processes_has_the_same_numbers_in_other_words() {
        let mut run = FuzzRun::default();
        run.read_line("#4137: cov: 512 ft: 900 corp: 30 exec/s: 1200 oom/timeout/crash: 0/0/0 time: 4s job: 2 dft_time: 0");
        let row = run.row("dh");
        for number in ["4137", "1200", " 512", " 900", " 30"] {
            assert!(row.contains(number), "{row}");
        }
    }

    #[test]
    fn a_finding_is_reported_with_its_file() {
        let mut run = FuzzRun::default();
        assert!(
            run.read_line("artifact_prefix='x/'; Test unit written to target/fuzz/crashes/dh/crash-12ab")
        );
        assert_eq!(run.written.as_deref(), Some("target/fuzz/crashes/dh/crash-12ab"));
        assert!(run.read_line("thread '<unnamed>' panicked at src/a.rs:1:2:"));
    }
}
