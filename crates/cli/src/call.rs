//! Calls of a command by a program: the same options by name, the same result, nothing on the terminal.
//!
//! | option | value |
//! |---|---|
//! | a flag | `true`, `false` |
//! | one value | a text or a number |
//! | several numbers (`X,Y,Z`) | a list |
//! | a repeatable option | a list with one element for each occurrence |
//!
//! Options have the names of the command, with `_` for `-`. Each call is converted to command-line arguments
//! with `--json` and processed in the same way.

use std::ffi::OsString;
use std::sync::Arc;

use armill_study::StudyError;
use clap::builder::StyledStr;
use clap::{Arg, ArgAction, CommandFactory, Parser};

use crate::arguments::Arguments;
use crate::listener::{Listener, heard_by};
use crate::outcome::Outcome;
use crate::{inputs_of, run};

/// A call of a command.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    /// Name of the command, such as `pose-accuracy`.
    pub command: String,
    /// Its operands in order, such as files.
    pub operands: Vec<String>,
    /// Its options by name, with their values.
    pub options: Vec<(String, OptionValue)>,
}

/// Value of an option.
#[derive(Clone, Debug, PartialEq)]
pub enum OptionValue {
    /// A flag.
    Flag(bool),
    /// One value, as it would be typed.
    Text(String),
    /// Several values.
    List(Vec<OptionValue>),
}

/// Result of a call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Every byte that the command prints on stdout with `--json`, the last line end included.
    pub json: String,
    /// Messages on stderr, line by line.
    pub messages: Vec<String>,
    /// Whether the tolerance is met; true if `strict` was not given.
    pub within_tolerance: bool,
}

/// Reason why there is no result.
#[derive(Debug, thiserror::Error)]
pub enum Refused {
    /// Options that cannot be combined, or unknown options.
    #[error("{0}")]
    Usage(String),
    /// The error of the command.
    #[error(transparent)]
    Study(#[from] StudyError),
}

/// An option or operand of a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OptionOf {
    /// Its name in a call.
    pub name: String,
    /// Whether it is an operand.
    pub is_operand: bool,
    /// Its help text.
    pub help: String,
}

/// Runs the command; `listener` receives the progress and can cancel it.
///
/// # Errors
/// Arguments that the command line would refuse; errors of the command.
pub fn call(call: &Call, listener: &Arc<Listener>) -> Result<Answer, Refused> {
    let words = words(call)?;
    let inputs = inputs_of(&words);
    let arguments =
        Arguments::try_parse_from(words).map_err(|refused| Refused::Usage(bare(&refused.render())))?;
    let outcome = heard_by(Some(Arc::clone(listener)), || {
        inputs.during(|| run(&arguments.command))
    })?;
    let (json, messages) = listener.heard();
    Ok(Answer {
        json,
        messages,
        within_tolerance: outcome == Outcome::Fine,
    })
}

/// Help text of the command `name`, and its operands and options; `None` if there is no such command, or none that
/// prints JSON.
pub fn options_of(name: &str) -> Option<(String, Vec<OptionOf>)> {
    let command = command(name)?;
    let help = |text: Option<&StyledStr>| text.map(ToString::to_string).unwrap_or_default();
    let given = command
        .get_arguments()
        .filter(|arg| is_call_option(arg))
        .map(|arg| OptionOf {
            name: name_of(arg),
            is_operand: arg.is_positional(),
            help: help(arg.get_help()),
        });
    Some((help(command.get_about()), given.collect()))
}

/// A command that prints JSON.
fn command(name: &str) -> Option<clap::Command> {
    let all = Arguments::command();
    let found = all.find_subcommand(name)?.clone();
    let answers = found.get_arguments().any(|arg| arg.get_id() == JSON);
    answers.then_some(found)
}

/// The option that every call sets.
const JSON: &str = "json";

/// Whether the caller gives this argument.
fn is_call_option(arg: &Arg) -> bool {
    arg.get_id() != JSON && !matches!(arg.get_action(), ArgAction::Help | ArgAction::Version)
}

/// Name in a call: as on the command line, with `_` for `-`; of an operand its name.
fn name_of(arg: &Arg) -> String {
    let typed = arg.get_long().unwrap_or(arg.get_id().as_str());
    typed.replace('-', "_")
}

/// The text of an error of clap, without the leading `error: `.
fn bare(rendered: &StyledStr) -> String {
    let text = rendered.to_string();
    let text = text.trim_end();
    text.strip_prefix("error: ").unwrap_or(text).to_owned()
}

/// The call as command-line arguments.
fn words(call: &Call) -> Result<Vec<OsString>, Refused> {
    let usage = |text: String| Err(Refused::Usage(text));
    let Some(command) = command(&call.command) else {
        return usage(format!(
            "command `{}` is unknown or has no JSON result",
            call.command
        ));
    };
    let mut words = vec!["armill".to_owned(), call.command.clone(), format!("--{JSON}")];
    let named: Vec<(String, &Arg)> = command
        .get_arguments()
        .filter(|arg| is_call_option(arg) && !arg.is_positional())
        .map(|arg| (name_of(arg), arg))
        .collect();
    for (name, given) in &call.options {
        let Some((_, arg)) = named.iter().find(|(known, _)| known == name) else {
            let known: Vec<&str> = named.iter().map(|(name, _)| name.as_str()).collect();
            return usage(format!(
                "`{}` has no option `{name}`: there are {}",
                call.command,
                known.join(", ")
            ));
        };
        let long = name.replace('_', "-");
        match (arg.get_action(), given) {
            (ArgAction::SetTrue, OptionValue::Flag(true)) => words.push(format!("--{long}")),
            (ArgAction::SetTrue, OptionValue::Flag(false)) => {}
            (ArgAction::SetTrue, _) | (_, OptionValue::Flag(_)) => {
                let requested = if matches!(arg.get_action(), ArgAction::SetTrue) {
                    "True or False"
                } else {
                    "a value"
                };
                return usage(format!(
                    "`{}`: option `{name}` requires {requested}",
                    call.command
                ));
            }
            (ArgAction::Append, OptionValue::List(each)) if arg.get_value_delimiter().is_none() => {
                words.extend(each.iter().map(|one| format!("--{long}={}", one.typed())));
            }
            (_, given) => words.push(format!("--{long}={}", given.typed())),
        }
    }
    // A file may begin with a hyphen.
    words.push("--".to_owned());
    words.extend(call.operands.iter().cloned());
    Ok(words.into_iter().map(OsString::from).collect())
}

impl OptionValue {
    /// As on the command line.
    fn typed(&self) -> String {
        match self {
            OptionValue::Flag(flag) => flag.to_string(),
            OptionValue::Text(text) => text.clone(),
            OptionValue::List(all) => all.iter().map(OptionValue::typed).collect::<Vec<_>>().join(","),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(options: &[(&str, OptionValue)]) -> Result<Answer, Refused> {
        let call = Call {
            command: "pose".to_owned(),
            operands: vec!["yaskawa/mh12".to_owned()],
            options: options
                .iter()
                .map(|(name, given)| ((*name).to_owned(), given.clone()))
                .collect(),
        };
        super::call(&call, &Arc::default())
    }

    fn numbers(values: &[f64]) -> OptionValue {
        OptionValue::List(
            values
                .iter()
                .map(|value| OptionValue::Text(value.to_string()))
                .collect(),
        )
    }

    #[test]
    fn a_call_returns_json_and_accepts_all_kinds_of_options() {
        let answer = pose(&[
            ("at_mm", numbers(&[1000.0, -50.5, 800.0])),
            ("load_dependent", OptionValue::Flag(true)),
        ])
        .unwrap();
        let value: serde_json::Value = serde_json::from_str(&answer.json).unwrap();
        let tool = &value["postures"][0]["tool"];
        assert!(tool.to_string().contains("-50.5"), "{tool}");
        assert!(answer.json.ends_with('\n') && answer.within_tolerance);
    }

    #[test]
    fn refuses_invalid_calls_with_the_messages_of_the_command_line() {
        let text = |options: &[(&str, OptionValue)]| pose(options).unwrap_err().to_string();
        let unknown = text(&[("at_m", numbers(&[1.0]))]);
        assert!(
            unknown.contains("no option `at_m`") && unknown.contains("at_mm"),
            "{unknown}"
        );
        let flag = text(&[("load_dependent", OptionValue::Text("yes".to_owned()))]);
        assert!(flag.contains("requires True or False"), "{flag}");
        let missing = text(&[]);
        assert!(
            missing.contains("required") && !missing.starts_with("error"),
            "{missing}"
        );
        let far = text(&[("at_mm", numbers(&[1.0, 2.0]))]);
        assert!(far.contains("--at-mm"), "{far}");
    }

    #[test]
    fn every_command_except_those_without_json_lists_its_options() {
        for command in Arguments::command().get_subcommands() {
            let name = command.get_name();
            let given = options_of(name);
            assert_eq!(
                given.is_none(),
                ["serve", "completions", "man"].contains(&name),
                "{name}"
            );
            for option in given.map(|(_, options)| options).unwrap_or_default() {
                assert!(!option.help.is_empty(), "{name}: {}", option.name);
            }
        }
    }
}
