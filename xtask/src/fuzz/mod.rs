//! Hostile input: every parser under coverage-guided fuzzing, one after another.
//!
//! `fuzz/` contains the program: a separate Cargo package with libFuzzer, one program for all parsers. Here it is built
//! with the compiler's coverage counters ([`build`]), called for each target, and its output is read ([`output`]).
//! [`studies`] calls another program: studies that are generated from their schema, read, checked and evaluated.
//! All output is under `target/fuzz/`: `corpus/TARGET/` (kept from run to run), `crashes/TARGET/`,
//! `dictionaries/`, `build/`.
//!
//! | argument | meaning | left out |
//! |---|---|---|
//! | `TARGET` | one parser by its name | all, one after another |
//! | `--seconds N` | time for each | 60 |
//! | `--jobs N` | processes at once | 1 |
//! | `--input FILE` | one input instead of a campaign, to repeat a finding | - |
//! | `--studies N` | N generated studies instead of any target | - |
//!
//! A finding is a panic, an input that takes longer than 10 s, or more than 2 GiB of memory. It is written to
//! `crashes/TARGET/` and reported with the line that repeats it.

mod build;
mod output;
mod studies;

use crate::command::command_line;
use crate::{COULD_NOT_RUN, FOUND_WRONG};
use output::FuzzRun;
use std::ffi::OsString;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

/// Description in the list of tasks.
pub const ABOUT: &str = "Feeds hostile input to the parsers: [TARGET] [--seconds N] [--jobs N] | TARGET --input FILE | --studies N.";

/// The output folder of a run.
const FOLDER: &str = "target/fuzz";
/// Default time for each target, s.
const SECONDS: u32 = 60;
/// An input that takes longer is a finding, s: parsers must be fast.
const LONGEST_S: u32 = 10;
/// A parser that takes more memory is a finding, MiB.
const MOST_MIB: u32 = 2048;
/// Inputs are no longer: 64 KiB are enough for any robot and any study, and longer ones run slowly.
const LONGEST_BYTES: u32 = 64 << 10;

/// What was requested; numbers are above 0.
#[derive(Debug, PartialEq)]
struct Options {
    target: Option<String>,
    seconds: u32,
    jobs: u32,
    input: Option<String>,
    studies: Option<u32>,
}

/// Builds, runs one target or all, prints a row for each.
pub fn run(arguments: &[String]) -> ExitCode {
    let Some(options) = options(arguments) else {
        eprintln!(
            "usage: cargo xtask fuzz [TARGET] [--seconds N] [--jobs N] | TARGET --input FILE | --studies N"
        );
        return ExitCode::from(COULD_NOT_RUN);
    };
    let found = match options.studies {
        Some(studies) => studies::checked(studies),
        None => fuzzed(&options),
    };
    match found {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(FOUND_WRONG),
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}

/// The arguments, or nothing where they cannot be understood.
fn options(arguments: &[String]) -> Option<Options> {
    let mut options = Options {
        target: None,
        seconds: SECONDS,
        jobs: 1,
        input: None,
        studies: None,
    };
    let mut arguments = arguments.iter();
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--seconds" => options.seconds = positive(arguments.next()?)?,
            "--jobs" => options.jobs = positive(arguments.next()?)?,
            "--input" => options.input = Some(arguments.next()?.clone()),
            "--studies" => options.studies = Some(positive(arguments.next()?)?),
            name if !name.starts_with('-') && options.target.is_none() => {
                options.target = Some(name.to_owned());
            }
            _ => return None,
        }
    }
    // An input is for one parser, generated studies for none.
    let understood = match options.studies {
        Some(_) => options.target.is_none() && options.input.is_none(),
        None => options.input.is_none() || options.target.is_some(),
    };
    understood.then_some(options)
}

/// A whole number above 0.
fn positive(text: &str) -> Option<u32> {
    text.parse().ok().filter(|number| *number > 0)
}

/// Builds, runs what was chosen and prints a row for each; whether nothing was found.
///
/// # Errors
/// The program does not build or run; there is no such target; a folder cannot be made.
fn fuzzed(options: &Options) -> Result<bool, String> {
    let program = build::program()?;
    let all = build::targets(&program)?;
    let chosen: Vec<&String> = match &options.target {
        Some(name) => all.iter().filter(|target| *target == name).collect(),
        None => all.iter().collect(),
    };
    if chosen.is_empty() {
        return Err(format!("no such target; there are {}", all.join(", ")));
    }
    let mut sound = true;
    let mut rows = Vec::new();
    for target in chosen {
        let mut command = Command::new(&program);
        command.env("ARMILL_FUZZ_TARGET", target);
        let run = match &options.input {
            Some(file) => watch(command.args(limits()).arg(file))?,
            None => {
                let crashes = format!("{FOLDER}/crashes/{target}/");
                fs::create_dir_all(&crashes)
                    .map_err(|problem| format!("cannot create {crashes}: {problem}"))?;
                watch(
                    command
                        .env("ARMILL_FUZZ_FOLDER", FOLDER)
                        .args(campaign(target, &crashes, options)),
                )?
            }
        };
        if !run.passed {
            sound = false;
            if let Some(file) = run.written.as_ref().or(options.input.as_ref()) {
                println!("{target}: FOUND {file}\n  repeat: cargo xtask fuzz {target} --input {file}");
            } else {
                println!("{target}: FAILED without an input; see above");
            }
        }
        rows.push(run.row(target));
    }
    if options.input.is_none() {
        println!("{}{}", output::HEADING, rows.concat());
    }
    Ok(sound)
}

/// The arguments of libFuzzer for a campaign: corpus, dictionary, place of findings, seconds, processes.
fn campaign(target: &str, crashes: &str, options: &Options) -> Vec<String> {
    let mut arguments = limits();
    arguments.push(format!("{FOLDER}/corpus/{target}"));
    arguments.push(format!("-dict={FOLDER}/dictionaries/{target}.dict"));
    arguments.push(format!("-artifact_prefix={crashes}"));
    arguments.push(format!("-max_total_time={}", options.seconds));
    arguments.push("-print_final_stats=1".to_owned());
    if options.jobs > 1 {
        arguments.push(format!("-fork={}", options.jobs));
    }
    arguments
}

/// Time, memory and length of one input.
fn limits() -> Vec<String> {
    vec![
        format!("-timeout={LONGEST_S}"),
        format!("-rss_limit_mb={MOST_MIB}"),
        format!("-max_len={LONGEST_BYTES}"),
    ]
}

/// Runs it, prints the relevant lines of its output, and keeps its counts.
///
/// # Errors
/// It does not start, or its end cannot be waited for. That it found something is not an error.
fn watch(command: &mut Command) -> Result<FuzzRun, String> {
    let line = command_line(command);
    eprintln!("+ {line}");
    let spawned = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
    let mut child = spawned.map_err(|problem| format!("{line} does not start: {problem}"))?;
    let mut run = FuzzRun::default();
    if let Some(log) = child.stderr.take() {
        // An input may be printed as it is, so that the output need not be UTF-8.
        for line in BufReader::new(log).split(b'\n').map_while(Result::ok) {
            let line = String::from_utf8_lossy(&line);
            if run.read_line(&line) {
                eprintln!("{line}");
            }
        }
    }
    let status = child.wait().map_err(|problem| format!("{line}: {problem}"))?;
    run.passed = status.success();
    Ok(run)
}

/// The path of the program that cargo built in `folder` for `host`.
fn built(folder: &Path, host: &str) -> OsString {
    let name = format!("armill-fuzz{}", std::env::consts::EXE_SUFFIX);
    folder.join(host).join("release").join(name).into_os_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn requested(line: &str) -> Option<Options> {
        options(&line.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    }

    #[test]
    fn options_are_understood_and_unknown_ones_refused() {
        let found = requested("urdf --seconds 5 --jobs 2");
        assert!(found.is_some_and(|found| found.target.as_deref() == Some("urdf")
            && found.seconds == 5
            && found.jobs == 2));
        assert!(requested("").is_some_and(|found| found.target.is_none() && found.seconds == SECONDS));
        assert!(requested("--studies 9").is_some_and(|found| found.studies == Some(9)));
        for line in [
            "urdf dh",
            "urdf --studies 9",
            "--studies 0",
            "--seconds",
            "--seconds 0",
            "--jobs x",
            "--fast",
            "--input a",
        ] {
            assert_eq!(requested(line), None, "{line}");
        }
    }

    #[test]
    fn limits_apply_to_a_campaign_and_to_one_input() {
        let options = requested("dh").unwrap();
        let arguments = campaign("dh", "target/fuzz/crashes/dh/", &options);
        assert!(limits().iter().all(|limit| arguments.contains(limit)));
        assert!(!arguments.iter().any(|argument| argument.starts_with("-fork")));
    }
}
