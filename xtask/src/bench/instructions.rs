//! Instructions a pose costs, counted by Valgrind: a measure that no other load on the machine disturbs.
//!
//! Compared with what `bench/instructions.tsv` records (function, instructions per pose, compiler); `--record` writes
//! it again. Valgrind emulates AVX2 and FMA but not AVX-512: the AVX2 path is counted.
//!
//! | column of the record | meaning |
//! |---|---|
//! | `function` | name in `bench/benches/instructions.rs` |
//! | `instructions_per_pose` | one decimal |
//! | `quotients_per_pose`, `roots_per_pose` | those of a vector are several; empty without `objdump` |
//! | `loads_per_pose`, `stores_per_pose` | a vector is one; those of libraries are not included; empty without `objdump` |
//! | `in_libraries_per_pose` | instructions in libraries of the system; empty without `objdump` |
//! | `compiler` | what `rustc --version` prints; reported, not compared |
//!
//! A rise of more than 2 % against the record is a regression and exits with 1; a fall is reported and needs a new
//! record only to be kept.

use super::bench_cargo;
use super::operations::{Dividing, Operations};
use crate::command::{cargo, printed};
use crate::{COULD_NOT_RUN, FOUND_WRONG};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs};

/// What was counted before, kept in the repository.
const RECORD: &str = "bench/instructions.tsv";
const COLUMNS: [&str; 8] = [
    "function",
    "instructions_per_pose",
    "quotients_per_pose",
    "roots_per_pose",
    "loads_per_pose",
    "stores_per_pose",
    "in_libraries_per_pose",
    "compiler",
];
/// Where the runner is installed.
const TOOLS: &str = "target/tools";
/// Where the runner puts what Callgrind writes.
const OUTPUT: &str = "target/bench-callgrind";
/// Must be the version of gungraun in `bench/Cargo.toml`.
const RUNNER: &str = "0.20.0";
/// A rise above this share is a regression: smaller ones come with any change of the compiler's mind.
const ALLOWED: f64 = 0.02;

/// What one function costs a pose.
#[derive(Debug, PartialEq)]
pub struct Count {
    function: String,
    /// Instructions.
    pub per_pose: f64,
    /// Where the instructions could be listed.
    pub operations: Option<Operations>,
}

/// The count of this function in the record.
pub fn recorded(function: &str) -> Option<Count> {
    let all = read(&fs::read_to_string(RECORD).unwrap_or_default());
    all.into_iter().find(|count| count.function == function)
}

/// Counts, and compares or records.
pub fn run(record: bool) -> ExitCode {
    let counts = match counted() {
        Ok(counts) if !counts.is_empty() => counts,
        Ok(_) => return could_not_run("no function was counted"),
        Err(problem) => return could_not_run(&problem),
    };
    let compiler = printed(Command::new("rustc").arg("--version")).unwrap_or_default();
    if record {
        return match fs::write(RECORD, written(&counts, compiler.trim())) {
            Ok(()) => ExitCode::SUCCESS,
            Err(problem) => could_not_run(&format!("cannot write {RECORD}: {problem}")),
        };
    }
    let recorded = read(&fs::read_to_string(RECORD).unwrap_or_default());
    let mut regressed = false;
    for count in &counts {
        let before = recorded.iter().find(|other| other.function == count.function);
        let (line, worse) = compared(count, before);
        println!("{line}");
        regressed |= worse;
    }
    if regressed {
        println!("if the rise is meant: cargo xtask bench --instructions --record");
        return ExitCode::from(FOUND_WRONG);
    }
    ExitCode::SUCCESS
}

/// Prints the reason, and returns the exit code.
fn could_not_run(problem: &str) -> ExitCode {
    eprintln!("{problem}");
    ExitCode::from(COULD_NOT_RUN)
}

/// Installs the runner if it is not there, and counts.
///
/// # Errors
/// The runner cannot be installed, or the benchmark does not build or run under Valgrind.
fn counted() -> Result<Vec<Count>, String> {
    let runner = env::current_dir()
        .unwrap_or_default()
        .join(TOOLS)
        .join("bin/gungraun-runner");
    if !Path::new(&runner).is_file() {
        let install = [
            "install",
            "--locked",
            "--root",
            TOOLS,
            "--version",
            RUNNER,
            "gungraun-runner",
        ];
        printed(&mut cargo(&install))?;
    }
    let mut command = bench_cargo(&["bench", "--bench", "instructions"]);
    command.env("GUNGRAUN_RUNNER", runner);
    command.env(
        "GUNGRAUN_HOME",
        env::current_dir().unwrap_or_default().join(OUTPUT),
    );
    let mut counts = printed(&mut command).map(|given| parse(&given))?;
    let mut programs: Vec<(String, Dividing)> = Vec::new();
    for (count, poses) in &mut counts {
        count.operations = operations(&count.function, &mut programs).map(|sum| sum.per_pose(*poses));
    }
    Ok(counts.into_iter().map(|(count, _)| count).collect())
}

/// Operations of a function in the last run; `programs`: those listed so far.
fn operations(function: &str, programs: &mut Vec<(String, Dividing)>) -> Option<Operations> {
    let callgrind = fs::read_to_string(callgrind_file(function)?).ok()?;
    let name = callgrind.lines().find_map(|line| {
        let object = line.strip_prefix("ob=")?;
        let path = object.split_once(' ').map_or(object, |(_, path)| path);
        Path::new(path)
            .file_name()
            .and_then(|name| name.to_str())
            .filter(|name| name.starts_with("instructions-"))
            .map(|_| path.to_owned())
    })?;
    if !programs.iter().any(|(program, _)| *program == name) {
        let listing = printed(Command::new("objdump").args(["-d", "--no-show-raw-insn", &name])).ok()?;
        programs.push((name.clone(), Dividing::of(&listing)));
    }
    let (_, dividing) = programs.iter().find(|(program, _)| *program == name)?;
    dividing.counted(&callgrind, &name)
}

/// The file that Callgrind wrote for this function.
fn callgrind_file(function: &str) -> Option<PathBuf> {
    let folder = Path::new(OUTPUT).join("armill-bench/instructions/per_pose");
    let case = fs::read_dir(folder).ok()?.flatten().find(|entry| {
        let name = entry.file_name();
        let (of, _) = name
            .to_str()
            .and_then(|name| name.split_once('.'))
            .unwrap_or_default();
        of == function
    })?;
    let files = fs::read_dir(case.path()).ok()?.flatten();
    let mut paths = files.map(|file| file.path());
    paths.find(|path| path.extension().is_some_and(|extension| extension == "out"))
}

/// Reads `instructions::group::function poses_100:...` and the line `Instructions: 123|...` after it; with the number of
/// poses.
fn parse(printed: &str) -> Vec<(Count, f64)> {
    let mut counts = Vec::new();
    let mut counting: Option<(&str, f64)> = None;
    for line in printed.lines() {
        if let Some(heading) = line.strip_prefix("instructions::") {
            counting = named(heading);
        } else if let (Some(rest), Some((function, poses))) =
            (line.trim().strip_prefix("Instructions:"), counting)
        {
            let total = rest
                .split('|')
                .next()
                .and_then(|total| total.trim().parse::<f64>().ok());
            counts.extend(total.map(|total| {
                let count = Count {
                    function: function.to_owned(),
                    per_pose: total / poses,
                    operations: None,
                };
                (count, poses)
            }));
            counting = None;
        }
    }
    counts
}

/// Function and number of poses of a heading.
fn named(heading: &str) -> Option<(&str, f64)> {
    let (path, case) = heading.split_once(' ')?;
    let poses = case.strip_prefix("poses_")?.split(':').next()?.parse().ok()?;
    Some((path.rsplit("::").next()?, poses))
}

/// One line of the report, and whether it is a regression.
fn compared(count: &Count, before: Option<&Count>) -> (String, bool) {
    let now = format!("{}: {:.0} instructions a pose", count.function, count.per_pose);
    let Some(before) = before else {
        return (format!("{now}, not recorded yet"), false);
    };
    let rise = count.per_pose / before.per_pose - 1.0;
    let worse = rise > ALLOWED;
    let verdict = if worse { ": REGRESSION" } else { "" };
    (
        format!(
            "{now}, recorded {:.0}, {:+.1} %{verdict}",
            before.per_pose,
            100.0 * rise
        ),
        worse,
    )
}

/// The text of the record, one line a function.
fn written(counts: &[Count], compiler: &str) -> String {
    let mut text = format!("{}\n", COLUMNS.join("\t"));
    for count in counts {
        let operations = match count.operations {
            Some(each) => [
                each.quotients,
                each.roots,
                each.loads,
                each.stores,
                each.in_libraries,
            ]
            .map(|value| format!("{value:.2}")),
            None => Default::default(),
        };
        text += &format!(
            "{}\t{:.1}\t{}\t{compiler}\n",
            count.function,
            count.per_pose,
            operations.join("\t")
        );
    }
    text
}

/// The lines of a record; one that is none is left out, the heading too.
fn read(text: &str) -> Vec<Count> {
    let row = |line: &str| {
        let mut fields = line.split('\t');
        let (function, per_pose) = (fields.next()?, fields.next()?.parse().ok()?);
        let mut number = || fields.next()?.parse().ok();
        let mut operations = || {
            Some(Operations {
                quotients: number()?,
                roots: number()?,
                loads: number()?,
                stores: number()?,
                in_libraries: number()?,
            })
        };
        Some(Count {
            function: function.to_owned(),
            per_pose,
            operations: operations(),
        })
    };
    text.lines().filter_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(per_pose: f64) -> Count {
        Count {
            function: "evaluate".to_owned(),
            per_pose,
            operations: None,
        }
    }

    #[test]
    fn counts_are_read_per_pose() {
        let printed = "instructions::per_pose::evaluate poses_200:(setup(200))\n  Instructions:   5000|N/A  (*)\n  L1 Hits: 3|N/A\n";
        assert_eq!(parse(printed), [(count(25.0), 200.0)]);
    }

    #[test]
    fn written_files_can_be_read() {
        let divided = Count {
            operations: Some(Operations {
                quotients: 2.5,
                roots: 0.25,
                loads: 12.0,
                stores: 7.0,
                in_libraries: 3.0,
            }),
            ..count(30.0)
        };
        let counts = [count(25.0), divided];
        assert_eq!(read(&written(&counts, "rustc 1.95.0")), counts);
    }

    #[test]
    fn only_a_rise_above_two_percent_is_a_regression() {
        assert!(compared(&count(102.5), Some(&count(100.0))).1);
        assert!(!compared(&count(101.5), Some(&count(100.0))).1);
        assert!(!compared(&count(50.0), Some(&count(100.0))).1);
        assert!(!compared(&count(50.0), None).1);
    }
}
