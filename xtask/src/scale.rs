//! Streams: a tool path program of any length takes no more memory than a short one.
//!
//! `crates/formats/examples/scale.rs` reads programs that are generated while they are read, each in a separate
//! process. Here it is called for every case, and its memory is compared with the limit of the case.
//!
//! | case | input | must be |
//! |---|---|---|
//! | `gcode`, `apt`, `csv` | many short lines | read within 64 MiB |
//! | `...-line` | one line without end | refused within 64 MiB |
//! | `gcode-loop`, `-call`, `-labels` | lines that have to be kept | read or refused within 1 GiB |
//!
//! Memory is the peak memory of the process, as the example reports it.

use crate::command::{cargo, printed};
use crate::{COULD_NOT_RUN, FOUND_WRONG};
use std::process::ExitCode;

/// Description in the list of tasks.
pub const ABOUT: &str = "Reads programs of 200 MB and more and fails if memory grows with them: [MEGABYTES].";

/// Default length of a program, MB.
const MEGABYTES: u64 = 200;
/// Most memory of a program that is done line by line, MiB: the program itself takes some 5.
const STREAMED_MIB: u64 = 64;
/// Most memory where lines must be kept, MiB: four times `gcode::interpreter::MOST_KEPT_BYTES`, since lines may
/// be read ahead and kept as well, and each takes memory in addition to its text.
const KEPT_MIB: u64 = 1024;

/// A case of the example, whether it must be read to its end, and its limit.
struct Case {
    name: &'static str,
    /// Length as a share of what is requested, percent.
    percent: u64,
    /// Whether it is read to its end; else it must be refused.
    read: bool,
    /// Most memory that it may take.
    most_mib: u64,
}

/// One line of the list below.
const fn case(name: &'static str, percent: u64, read: bool, most_mib: u64) -> Case {
    Case {
        name,
        percent,
        read,
        most_mib,
    }
}

const CASES: &[Case] = &[
    case("gcode", 100, true, STREAMED_MIB),
    case("apt", 100, true, STREAMED_MIB),
    case("csv", 100, true, STREAMED_MIB),
    case("gcode-line", 100, false, STREAMED_MIB),
    case("apt-line", 100, false, STREAMED_MIB),
    case("csv-line", 100, false, STREAMED_MIB),
    // A million lines.
    case("gcode-loop", 15, true, KEPT_MIB),
    case("gcode-loop", 200, false, KEPT_MIB),
    case("gcode-call", 200, false, KEPT_MIB),
    case("gcode-labels", 200, false, KEPT_MIB),
];

/// What the example prints of a case: six fields between tabs, the first its name.
#[derive(Debug, PartialEq)]
struct Row {
    /// How much of the program was taken before its end or its refusal.
    bytes: u64,
    steps: u64,
    seconds: f64,
    /// Peak memory of the process; 0 where the system does not report it, and then no limit is exceeded.
    kib: u64,
    /// `read`, or why it was refused.
    said: String,
}

/// Reads every case and prints a row for each.
pub fn run(arguments: &[String]) -> ExitCode {
    let megabytes = match arguments {
        [] => Some(MEGABYTES),
        [number] => number.parse().ok().filter(|number| *number > 0),
        _ => None,
    };
    let Some(megabytes) = megabytes else {
        eprintln!("usage: cargo xtask scale [MEGABYTES]");
        return ExitCode::from(COULD_NOT_RUN);
    };
    let mut sound = true;
    println!("case          MB read      steps   million steps/s   most MiB   limit  message");
    for case in CASES {
        match measured(case, megabytes) {
            Ok(row) => {
                let wrong = case.wrong(&row);
                sound &= wrong.is_none();
                println!("{}", case.line(&row, wrong));
            }
            Err(problem) => {
                eprintln!("{problem}");
                return ExitCode::from(COULD_NOT_RUN);
            }
        }
    }
    if sound {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(FOUND_WRONG)
    }
}

/// Runs the example on one case.
fn measured(case: &Case, megabytes: u64) -> Result<Row, String> {
    let bytes = (megabytes * 1_000_000 * case.percent / 100).to_string();
    let mut command = cargo(&["run", "--quiet", "--release", "--package", "armill-formats"]);
    command.args([
        "--no-default-features",
        "--example",
        "scale",
        "--",
        case.name,
        &bytes,
    ]);
    let given = printed(&mut command)?;
    Row::read(&given).ok_or_else(|| format!("{} printed no row: {given}", case.name))
}

impl Row {
    /// The row in a line; nothing where it is none.
    fn read(line: &str) -> Option<Row> {
        let fields: Vec<&str> = line.trim_end().split('\t').collect();
        let [_, bytes, steps, seconds, kib, said] = fields.as_slice() else {
            return None;
        };
        Some(Row {
            bytes: bytes.parse().ok()?,
            steps: steps.parse().ok()?,
            seconds: seconds.parse().ok()?,
            kib: kib.parse().ok()?,
            said: (*said).to_owned(),
        })
    }
}

impl Case {
    /// What is wrong with a row, if anything is.
    fn wrong(&self, row: &Row) -> Option<&'static str> {
        if row.kib > self.most_mib * 1024 {
            return Some("TOO MUCH MEMORY");
        }
        ((row.said == "read") != self.read).then_some(match self.read {
            true => "NOT READ",
            false => "NOT REFUSED",
        })
    }

    /// One line of the report, with the failure at its end.
    fn line(&self, row: &Row, wrong: Option<&str>) -> String {
        format!(
            "{:<12}{:>10.1}{:>10}{:>18.2}{:>11}{:>8}  {}{}",
            self.name,
            row.bytes as f64 * 1e-6,
            row.steps,
            row.steps as f64 * 1e-6 / row.seconds.max(1e-9),
            row.kib / 1024,
            self.most_mib,
            row.said,
            wrong.map_or_else(String::new, |wrong| format!("  {wrong}"))
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_beyond_the_limit_and_a_wrong_end_are_reported() {
        let row =
            |kib: u64, said: &str| Row::read(&format!("gcode\t2000\t10\t0.5\t{kib}\t{said}\n")).unwrap();
        let must_read = case("gcode", 100, true, 64);
        assert_eq!(must_read.wrong(&row(64 * 1024, "read")), None);
        assert_eq!(
            must_read.wrong(&row(64 * 1024 + 1, "read")),
            Some("TOO MUCH MEMORY")
        );
        assert_eq!(must_read.wrong(&row(1, "line too long")), Some("NOT READ"));
        let refused = case("gcode-line", 100, false, 64);
        assert_eq!(refused.wrong(&row(1, "line too long")), None);
        assert_eq!(refused.wrong(&row(1, "read")), Some("NOT REFUSED"));
        assert_eq!(Row::read("gcode\t2000\n"), None);
    }
}
