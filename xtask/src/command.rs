//! Other programs: how a task names, announces and runs them.
//!
//! Every program is announced on stderr, behind a `+`, as a line that can be typed: to repeat one step of a task, copy
//! it from there.

use crate::{COULD_NOT_RUN, FOUND_WRONG};
use std::env;
use std::process::{Command, ExitCode, Stdio};

/// `cargo` with `arguments`: the cargo that runs this task, so that both are of one toolchain.
pub fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments);
    command
}

/// Whether `cargo <tool> --version` works, that is, whether this cargo extension is installed. Its output is
/// not shown.
pub fn has_cargo_tool(tool: &str) -> bool {
    let mut command = cargo(&[tool, "--version"]);
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// The command line for `command`, variables that differ from ours included. Arguments with blanks
/// are not put into quotes: it is for reading.
pub fn command_line(command: &Command) -> String {
    let variables = command.get_envs().filter_map(|(name, value)| {
        Some(format!(
            "{}='{}'",
            name.to_string_lossy(),
            value?.to_string_lossy()
        ))
    });
    let program = command.get_program().to_string_lossy();
    let program = program.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
    let arguments = command
        .get_args()
        .map(|argument| argument.to_string_lossy().into_owned());
    variables
        .chain([program])
        .chain(arguments)
        .collect::<Vec<_>>()
        .join(" ")
}

/// Prints the command, runs it on our own terminal, and returns its result as ours: 0 for success, 1 for any
/// failure, 2 where it does not start.
pub fn run_in_place(mut command: Command) -> ExitCode {
    eprintln!("+ {}", command_line(&command));
    match command.status() {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(_) => ExitCode::from(FOUND_WRONG),
        Err(problem) => {
            eprintln!("{} does not start: {problem}", command_line(&command));
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}

/// Prints the command and returns its output; its stderr goes to ours.
///
/// # Errors
/// In a line: it does not start, it failed, or what it printed is not text.
pub fn printed(command: &mut Command) -> Result<String, String> {
    let line = command_line(command);
    eprintln!("+ {line}");
    let ran = command.stderr(Stdio::inherit()).output();
    let output = ran.map_err(|problem| format!("{line} does not start: {problem}"))?;
    if !output.status.success() {
        return Err(format!("{line} failed"));
    }
    String::from_utf8(output.stdout).map_err(|problem| format!("{line}: {problem}"))
}

/// Prints the command and runs it on our own terminal.
///
/// # Errors
/// In a line: it does not start, or it failed.
pub fn succeeded(command: &mut Command) -> Result<(), String> {
    let line = command_line(command);
    eprintln!("+ {line}");
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(_) => Err(format!("{line} failed")),
        Err(problem) => Err(format!("{line} does not start: {problem}")),
    }
}

/// Refuses arguments for a task that takes none: an ignored argument would look as if it had an effect.
///
/// # Errors
/// The exit code to leave with, after saying what was refused.
pub fn expect_no_arguments(task: &str, arguments: &[String]) -> Result<(), ExitCode> {
    if arguments.is_empty() {
        return Ok(());
    }
    eprintln!(
        "cargo xtask {task} takes no arguments, got: {}",
        arguments.join(" ")
    );
    Err(ExitCode::from(COULD_NOT_RUN))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn command_line_shows_variables_program_and_arguments() {
        let mut command = Command::new("/usr/bin/cargo");
        command
            .args(["doc", "--no-deps"])
            .env("RUSTDOCFLAGS", "-D warnings");
        assert_eq!(
            command_line(&command),
            "RUSTDOCFLAGS='-D warnings' cargo doc --no-deps"
        );
    }

    #[test]
    fn arguments_are_refused_where_none_are_taken() {
        assert!(expect_no_arguments("tidy", &[]).is_ok());
        assert!(expect_no_arguments("tidy", &["--fix".to_owned()]).is_err());
    }
}
