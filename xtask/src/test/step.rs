//! One step of a run: a named command whose output is passed on and counted.
//!
//! Output is passed on unchanged: at once, as if the command ran alone, or in one piece after its end, if another one has the terminal.
//! Standard output and errors are relayed by a thread each, since a runner may write its summary to either.

use super::count::Count;
use crate::command::command_line;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// When the output of a step is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// At once.
    Live,
    /// In one piece, after its end.
    Kept,
}

/// Output that is kept, in the order of its lines; clones share it.
#[derive(Clone, Default)]
struct Kept(Arc<Mutex<Vec<u8>>>);

impl Write for Kept {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

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

    /// These commands as steps; where they cannot be made the reason is printed, and there is none: a later test of what
    /// they make fails.
    pub fn all(made: Result<Vec<(&'static str, Command)>, String>) -> Vec<Self> {
        let made = made.unwrap_or_else(|problem| {
            eprintln!("{problem}");
            Vec::new()
        });
        made.into_iter()
            .map(|(name, command)| Self::new(name, command))
            .collect()
    }

    /// Prints the command and runs it, without input.
    pub fn run(self, output: Output) -> Outcome {
        match output {
            Output::Live => self.run_into(io::stdout(), io::stderr()),
            Output::Kept => {
                eprintln!("\n== {}: begun; its output follows at its end", self.name);
                let kept = Kept::default();
                let outcome = self.run_into(kept.clone(), kept.clone());
                let bytes = kept.0.lock().unwrap_or_else(PoisonError::into_inner);
                // A terminal that is closed must not end the run.
                let _ = io::stdout().lock().write_all(&bytes);
                outcome
            }
        }
    }

    /// The same with these in place of standard output and errors.
    fn run_into(mut self, data: impl Write, mut messages: impl Write + Send + 'static) -> Outcome {
        let line = command_line(&self.command);
        let _ = write!(messages, "\n== {}\n+ {line}\n", self.name);
        let start = Instant::now();
        let ran = run_and_count(&mut self.command, data, messages);
        let (passed, count) = ran.unwrap_or_else(|problem| {
            eprintln!("{}: {line}: {problem}", self.name);
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
fn run_and_count(
    command: &mut Command,
    data: impl Write,
    messages: impl Write + Send + 'static,
) -> io::Result<(bool, Count)> {
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    // Both are read at once: a full pipe that is not read would stop the child.
    let of_messages = child
        .stderr
        .take()
        .map(|from| thread::spawn(move || relay(from, messages)));
    let of_data = child
        .stdout
        .take()
        .map_or(Ok(Count::default()), |from| relay(from, data))?;
    let of_messages = match of_messages.map(thread::JoinHandle::join) {
        Some(Ok(count)) => count?,
        Some(Err(_)) => return Err(io::Error::other("the reader of its error output broke off")),
        None => Count::default(),
    };
    Ok((child.wait()?.success(), of_data.plus(of_messages)))
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
        let outcome = Step::new("made up", Command::new("./no such program")).run(Output::Live);
        assert!(!outcome.passed);
    }

    #[test]
    fn kept_output_has_both_streams_and_is_counted() {
        let mut command = Command::new("sh");
        command.args(["-c", "echo some data; echo a message >&2; echo '# pass 3'"]);
        let kept = Kept::default();
        let outcome = Step::new("made up", command).run_into(kept.clone(), kept.clone());
        assert!(outcome.passed);
        assert_eq!(outcome.count.passed, 3);
        let text = String::from_utf8(kept.0.lock().unwrap().clone()).unwrap();
        assert!(text.starts_with("\n== made up\n+ sh -c "), "{text}");
        for line in ["some data\n", "a message\n", "# pass 3\n"] {
            assert!(text.contains(line), "{text}");
        }
    }
}
