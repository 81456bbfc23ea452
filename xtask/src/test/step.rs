//! One step of a run: a named command whose output is passed on and counted.
//!
//! Output is passed on unchanged and at once, as if the command ran alone. Standard output and
//! errors are relayed by a thread each, since a runner may write its summary to either.

use super::count::Count;
use crate::command::command_line;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// A command and its name in the output.
pub struct Step {
    name: &'static str,
    command: Command,
}

/// What came of a step; a command that does not start is a failed step.
pub struct Outcome {
    /// The name of the step.
    pub name: &'static str,
    /// Whether the command started and exited with 0.
    pub passed: bool,
    /// The tests that its output reports.
    pub count: Count,
    /// From start to end.
    pub wall_time: Duration,
}

impl Step {
    /// The step `name`, done by `command`.
    pub fn new(name: &'static str, command: Command) -> Self {
        Self { name, command }
    }

    /// Prints the command and runs it, without input.
    pub fn run(mut self) -> Outcome {
        eprintln!("\n== {}\n+ {}", self.name, command_line(&self.command));
        let start = Instant::now();
        let (passed, count) = run_and_count(&mut self.command).unwrap_or_else(|problem| {
            eprintln!("{}: {problem}", command_line(&self.command));
            (false, Count::default())
        });
        Outcome {
            name: self.name,
            passed,
            count,
            wall_time: start.elapsed(),
        }
    }
}

/// Runs `command`; returns whether it succeeded and the tests that either of its outputs reports.
fn run_and_count(command: &mut Command) -> io::Result<(bool, Count)> {
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    // Both are read at once: a full pipe that is not read would stop the child.
    let talk = child
        .stderr
        .take()
        .map(|talk| thread::spawn(move || relay(talk, io::stderr())));
    let data = child
        .stdout
        .take()
        .map_or(Ok(Count::default()), |data| relay(data, io::stdout()))?;
    let talk = match talk.map(thread::JoinHandle::join) {
        Some(Ok(count)) => count?,
        Some(Err(_)) => return Err(io::Error::other("the reader of its error output broke off")),
        None => Count::default(),
    };
    Ok((child.wait()?.success(), data.plus(talk)))
}

/// Copies `from` to `to` line by line and counts the tests that the lines report.
fn relay(from: impl Read, mut to: impl Write) -> io::Result<Count> {
    let mut from = BufReader::new(from);
    let mut count = Count::default();
    let mut line = Vec::new();
    while from.read_until(b'\n', &mut line)? > 0 {
        to.write_all(&line)?;
        to.flush()?;
        count = count.plus(Count::in_line(&String::from_utf8_lossy(&line)));
        line.clear();
    }
    Ok(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relay_copies_every_byte_and_counts() {
        let text = "Compiling\ntest result: ok. 2 passed; 0 failed; 0 ignored\nno newline at the end";
        let mut copied = Vec::new();
        let count = relay(text.as_bytes(), &mut copied).unwrap();
        assert_eq!(copied, text.as_bytes());
        assert_eq!(count.passed, 2);
    }

    #[test]
    fn a_program_that_does_not_start_is_a_failed_step() {
        let outcome = Step::new("made up", Command::new("./no such program")).run();
        assert!(!outcome.passed);
    }
}
