//! A command asked by a program: the same options by name, the same answer, nothing on the terminal.
//!
//! | option | told as |
//! |---|---|
//! | a flag | `true`, `false` |
//! | one value | a text or a number |
//! | several numbers (`X,Y,Z`) | a list of them |
//! | what may be given several times | a list with one element each time |
//!
//! Options have the names of the command, with `_` for `-`. Each call becomes the words that one would
//! type, with `--json`, and goes the same way.

use std::ffi::OsString;
use std::sync::Arc;

use armill_study::StudyError;
use clap::builder::StyledStr;
use clap::{Arg, ArgAction, CommandFactory, Parser};

use crate::arguments::Arguments;
use crate::listener::{Listener, heard_by};
use crate::{Outcome, inputs_of, run};

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    /// Name of the command, such as `pose-accuracy`.
    pub command: String,
    /// Its operands in order, such as files.
    pub operands: Vec<String>,
    /// Its options by name, with what is told of them.
    pub options: Vec<(String, Told)>,
}

/// What is told of an option.
#[derive(Clone, Debug, PartialEq)]
pub enum Told {
    /// Of a flag.
    Flag(bool),
    /// One value, as it would be typed.
    Text(String),
    /// Several.
    List(Vec<Told>),
}

/// What comes back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Every byte that the command prints on stdout with `--json`, the last line end included.
    pub json: String,
    /// What it says on stderr, line by line.
    pub talk: Vec<String>,
    /// Whether the tolerance is held, or nobody was strict.
    pub holds: bool,
}

/// Why nothing comes back.
#[derive(Debug, thiserror::Error)]
pub enum Refused {
    /// Options that do not go together, or that the command does not have.
    #[error("{0}")]
    Usage(String),
    /// What stopped the command.
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
    /// What the help says of it.
    pub help: String,
}

/// Asks the command; `listener` hears how far it is, and may cancel.
///
/// # Errors
/// What the command line would refuse; what stops the command.
pub fn analysis(call: &Call, listener: &Arc<Listener>) -> Result<Answer, Refused> {
    let words = words(call)?;
    let inputs = inputs_of(&words);
    let arguments =
        Arguments::try_parse_from(words).map_err(|refused| Refused::Usage(bare(&refused.render())))?;
    let outcome = heard_by(Some(Arc::clone(listener)), || {
        inputs.during(|| run(&arguments.command))
    })?;
    let (json, talk) = listener.heard();
    Ok(Answer {
        json,
        talk,
        holds: outcome == Outcome::Fine,
    })
}

/// What command `name` says of itself, and its operands and options; `None` where there is no such command, or none that
/// answers in JSON.
pub fn options_of(name: &str) -> Option<(String, Vec<OptionOf>)> {
    let command = command(name)?;
    let help = |text: Option<&StyledStr>| text.map(ToString::to_string).unwrap_or_default();
    let given = command
        .get_arguments()
        .filter(|arg| is_told(arg))
        .map(|arg| OptionOf {
            name: name_of(arg),
            is_operand: arg.is_positional(),
            help: help(arg.get_help()),
        });
    Some((help(command.get_about()), given.collect()))
}

/// A command that answers in JSON.
fn command(name: &str) -> Option<clap::Command> {
    let all = Arguments::command();
    let found = all.find_subcommand(name)?.clone();
    let answers = found.get_arguments().any(|arg| arg.get_id() == JSON);
    answers.then_some(found)
}

/// The option that every call has.
const JSON: &str = "json";

/// Whether a caller tells this one.
fn is_told(arg: &Arg) -> bool {
    arg.get_id() != JSON && !matches!(arg.get_action(), ArgAction::Help | ArgAction::Version)
}

/// What a call names it by: as it is typed, with `_` for `-`; an operand by what it is.
fn name_of(arg: &Arg) -> String {
    let typed = arg.get_long().unwrap_or(arg.get_id().as_str());
    typed.replace('-', "_")
}

/// The text of what clap refuses, without the word before it.
fn bare(rendered: &StyledStr) -> String {
    let text = rendered.to_string();
    let text = text.trim_end();
    text.strip_prefix("error: ").unwrap_or(text).to_owned()
}

/// The words of a call as one would type them.
fn words(call: &Call) -> Result<Vec<OsString>, Refused> {
    let usage = |text: String| Err(Refused::Usage(text));
    let Some(command) = command(&call.command) else {
        return usage(format!("no command `{}` answers in JSON", call.command));
    };
    let mut words = vec!["armill".to_owned(), call.command.clone(), format!("--{JSON}")];
    let named: Vec<(String, &Arg)> = command
        .get_arguments()
        .filter(|arg| is_told(arg) && !arg.is_positional())
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
            (ArgAction::SetTrue, Told::Flag(true)) => words.push(format!("--{long}")),
            (ArgAction::SetTrue, Told::Flag(false)) => {}
            (ArgAction::SetTrue, _) | (_, Told::Flag(_)) => {
                let requested = if matches!(arg.get_action(), ArgAction::SetTrue) {
                    "True or False"
                } else {
                    "a value"
                };
                return usage(format!("`{}`: option `{name}` takes {requested}", call.command));
            }
            (ArgAction::Append, Told::List(each)) if arg.get_value_delimiter().is_none() => {
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

impl Told {
    /// As one would type it.
    fn typed(&self) -> String {
        match self {
            Told::Flag(flag) => flag.to_string(),
            Told::Text(text) => text.clone(),
            Told::List(all) => all.iter().map(Told::typed).collect::<Vec<_>>().join(","),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(options: &[(&str, Told)]) -> Result<Answer, Refused> {
        let call = Call {
            command: "pose".to_owned(),
            operands: vec!["yaskawa/mh12".to_owned()],
            options: options
                .iter()
                .map(|(name, given)| ((*name).to_owned(), given.clone()))
                .collect(),
        };
        analysis(&call, &Arc::default())
    }

    fn numbers(values: &[f64]) -> Told {
        Told::List(values.iter().map(|value| Told::Text(value.to_string())).collect())
    }

    #[test]
    fn a_call_is_answered_with_json_and_its_options_are_typed_as_one_would() {
        let answer = pose(&[
            ("at_mm", numbers(&[1000.0, -50.5, 800.0])),
            ("load_dependent", Told::Flag(true)),
        ])
        .unwrap();
        let value: serde_json::Value = serde_json::from_str(&answer.json).unwrap();
        let tool = &value["postures"][0]["tool"];
        assert!(tool.to_string().contains("-50.5"), "{tool}");
        assert!(answer.json.ends_with('\n') && answer.holds);
    }

    #[test]
    fn what_cannot_be_asked_is_refused_in_the_words_of_the_command() {
        let text = |options: &[(&str, Told)]| pose(options).unwrap_err().to_string();
        let unknown = text(&[("at_m", numbers(&[1.0]))]);
        assert!(
            unknown.contains("no option `at_m`") && unknown.contains("at_mm"),
            "{unknown}"
        );
        let flag = text(&[("load_dependent", Told::Text("yes".to_owned()))]);
        assert!(flag.contains("takes True or False"), "{flag}");
        let missing = text(&[]);
        assert!(
            missing.contains("required") && !missing.starts_with("error"),
            "{missing}"
        );
        let far = text(&[("at_mm", numbers(&[1.0, 2.0]))]);
        assert!(far.contains("--at-mm"), "{far}");
    }

    #[test]
    fn every_command_but_those_without_json_tells_its_options() {
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
