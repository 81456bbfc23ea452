//! Speed: armill and its peers at the same work on the same poses, in one run.
//!
//! `bench/` contains the programs: a separate Cargo package (never built with armill), Python and C++. Each prints
//! rows; here they are called, put side by side ([`page`]) and compared with the goals ([`goals`]). What a peer needs
//! is installed under `target/` ([`peers`]); a peer that is not available is reported and left out.
//!
//! `bounds`: what bounds the rows that miss their goal; `witness`: whether fast and plain version agree; `row`: what a
//! program prints; `instructions`: the same work in instructions instead of time, `operations`: quotients,
//! roots, loads and stores of it; `machine`: where it ran.
//!
//! | arguments | what runs | writes the page |
//! |---|---|---|
//! | none | armill, peers in Rust, Python and C++ | yes |
//! | `--quick` | the same with fewer rounds | no |
//! | `--only rust`, `--only paths` | a part | no |
//! | `--instructions` | counts under Valgrind, against the record | no; `--record` writes the record, and what bounds missed rows |
//! | `--witness` | compares lanes with the plain version on 10^6 poses of eight arms | no, prints a table |

mod bounds;
mod goals;
mod instructions;
mod machine;
mod operations;
mod page;
mod peers;
mod row;
mod witness;

use crate::command::{cargo, printed};
use crate::{COULD_NOT_RUN, FOUND_WRONG};
use row::Row;
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode};

/// Description in the list of tasks.
pub const ABOUT: &str =
    "Times armill and its peers: [--quick] [--only rust|paths] | --instructions [--record] | --witness.";

/// The page that a full run writes.
const PAGE: &str = "docs/performance.md";
/// The poses that all peers read.
const WORKLOAD: &str = "target/bench-workload";
/// Where `bench/` is built, and where it is for this processor.
const TARGET: &str = "target/bench";
const NATIVE_TARGET: &str = "target/bench-native";

/// What was requested.
#[derive(Debug, Default, PartialEq)]
struct Options {
    /// Fewer rounds: to see whether it runs, not how fast.
    quick: bool,
    only: Option<Only>,
    instructions: bool,
    /// Whether counts become the new record; with `instructions` alone.
    record: bool,
    witness: bool,
}

/// The selected part of the benchmarks.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Only {
    /// armill and the peers in Rust.
    Rust,
    /// Tool paths, in addition to the yardstick.
    Paths,
}

/// What a run found.
#[derive(Default)]
struct BenchRun {
    rows: Vec<Row>,
    /// Who is missing, and why.
    skipped: Vec<String>,
}

/// Runs all benchmarks and writes the page, or prints it alone if the run was not a full one.
pub fn run(arguments: &[String]) -> ExitCode {
    let Some(options) = options(arguments) else {
        eprintln!(
            "usage: cargo xtask bench [--quick] [--only rust|paths] | --instructions [--record] | --witness"
        );
        return ExitCode::from(COULD_NOT_RUN);
    };
    if options.witness {
        return witness::run();
    }
    if options.instructions {
        let code = instructions::run(options.record);
        return if options.record { renew_bounds(code) } else { code };
    }
    match measured(&options).and_then(|found| publish(&options, &found)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::from(FOUND_WRONG)
        }
    }
}

/// The arguments, or nothing where they cannot be understood.
fn options(arguments: &[String]) -> Option<Options> {
    let mut options = Options::default();
    let mut arguments = arguments.iter().map(String::as_str);
    while let Some(argument) = arguments.next() {
        match argument {
            "--quick" => options.quick = true,
            "--only" => {
                options.only = match arguments.next() {
                    Some("rust") => Some(Only::Rust),
                    Some("paths") => Some(Only::Paths),
                    _ => return None,
                }
            }
            "--instructions" => options.instructions = true,
            "--record" => options.record = true,
            "--witness" => options.witness = true,
            _ => return None,
        }
    }
    (options.instructions || !options.record).then_some(options)
}

/// Rows of all available programs; why others are not available.
///
/// # Errors
/// A program that is there fails: its rows would be missing without a reason.
fn measured(options: &Options) -> Result<BenchRun, String> {
    let mut found = BenchRun::default();
    let venv = match options.only {
        Some(_) => Err("left out by --only".to_owned()),
        None => peers::virtual_environment(),
    };
    rust(options, &mut found)?;
    match venv {
        Ok(()) => {
            found.read(&printed(options.quicken(&mut peers::python()))?);
            for (who, peer) in [
                ("armill for Python", peers::package()),
                ("Pinocchio", peers::pinocchio()),
                ("C++ by hand", peers::by_hand()),
            ] {
                match peer {
                    Ok(mut command) => found.read(&printed(options.quicken(&mut command))?),
                    Err(why) => found.skipped.push(format!("{who}: {why}")),
                }
            }
        }
        Err(why) => found.skipped.push(format!("Python and C++ peers: {why}")),
    }
    Ok(found)
}

/// armill as users get it, and the peers in Rust built for this processor; writes the poses for the others.
fn rust(options: &Options, found: &mut BenchRun) -> Result<(), String> {
    let mut command = bench_cargo(&["run", "--release"]);
    command.args(["--", WORKLOAD]);
    if options.only == Some(Only::Paths) {
        command.arg("--paths");
    }
    found.read(&printed(options.quicken(&mut command))?);
    if options.only == Some(Only::Paths) {
        return Ok(());
    }
    let mut command = bench_cargo(&["run", "--release"]);
    command.env("CARGO_TARGET_DIR", NATIVE_TARGET);
    command.env("RUSTFLAGS", "-C target-cpu=native");
    if let Some(cmake) = peers::cmake() {
        command.args(["--features", "ik-geo"]).env("CMAKE", cmake);
    } else {
        found
            .skipped
            .push("ik-geo: its dependency nlopt needs cmake to build".to_owned());
    }
    command.args(["--", WORKLOAD, "--peers"]);
    found.read(&printed(options.quicken(&mut command))?);
    Ok(())
}

/// After new counts: what bounds missed rows is written into the page again; `code` where that works.
fn renew_bounds(code: ExitCode) -> ExitCode {
    let renewed = fs::read_to_string(PAGE).and_then(|page| fs::write(PAGE, bounds::with_section(&page)));
    match renewed {
        Ok(()) => code,
        Err(problem) => {
            eprintln!("cannot renew {PAGE}: {problem}");
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}

/// `cargo` on the package in `bench/`.
fn bench_cargo(arguments: &[&str]) -> Command {
    let mut command = cargo(arguments);
    command.args(["--manifest-path", "bench/Cargo.toml"]);
    command.env("CARGO_TARGET_DIR", TARGET);
    command
}

/// Prints the page, and writes it after a full run.
fn publish(options: &Options, found: &BenchRun) -> Result<(), String> {
    let page = bounds::with_section(&page::page(&found.rows, &found.skipped, &machine::lines()));
    println!("{page}");
    if options.quick || options.only.is_some() {
        eprintln!("{PAGE} is left as it is: only a full run writes it");
        return Ok(());
    }
    fs::write(Path::new(PAGE), page).map_err(|problem| format!("cannot write {PAGE}: {problem}"))
}

impl Options {
    /// Hands `--quick` on.
    fn quicken<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        if self.quick {
            command.arg("--quick");
        }
        command
    }
}

impl BenchRun {
    /// Reads the rows, and the messages of peers that could not run, from the output of a program.
    fn read(&mut self, printed: &str) {
        for line in printed.lines() {
            if let Some(skipped) = line.strip_prefix("skipped\t") {
                self.skipped.push(skipped.replace('\t', ": "));
            } else {
                self.rows.extend(Row::read(line));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn requested(line: &str) -> Option<Options> {
        options(&line.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    }

    #[test]
    fn options_are_understood_and_unknown_ones_refused() {
        let both = requested("--quick --only rust");
        assert!(both.is_some_and(|options| options.quick && options.only == Some(Only::Rust)));
        let paths = requested("--only paths");
        assert!(paths.is_some_and(|options| options.only == Some(Only::Paths)));
        assert_eq!(requested(""), Some(Options::default()));
        assert_eq!(requested("--only python"), None);
        assert_eq!(requested("--record"), None);
    }

    #[test]
    fn rows_and_missing_peers_are_reported_apart() {
        let mut found = BenchRun::default();
        found.read("a\tdev\t1\t2.0\t1.5\t2.5\tnote\nskipped\tEAIK\tno module\n");
        assert_eq!(found.rows.len(), 1);
        assert_eq!(found.skipped, ["EAIK: no module"]);
    }
}
