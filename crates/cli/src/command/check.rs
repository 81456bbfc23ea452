//! `armill check`: all problems of a study.
//!
//! Problems are printed on stderr. If there are none, stderr reports the values that are probably slips, as warnings,
//! and the size of the study. With `--json` problems and warnings are printed on stdout too.
//! `--schema` prints the JSON Schema of the study file instead.

use armill_formats::document::schema_json;
use armill_study::answer::CheckAnswer;
use armill_study::file::format::StudyFile;
use armill_study::run::points_to_evaluate;
use armill_study::{StudyError, studies};

use crate::arguments::CheckArguments;
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Checks the study, or prints the schema.
///
/// # Errors
/// No such study; all problems of its file together.
pub(crate) fn run(arguments: &CheckArguments) -> Result<Outcome, StudyError> {
    if arguments.schema {
        print(schema_json::<StudyFile>().trim_end())?;
        return Ok(Outcome::Fine);
    }
    let found = studies::find(arguments.study.as_deref().unwrap_or_else(|| ".".as_ref()))?;
    let study = found.read()?;
    let answer = CheckAnswer::of(&study);
    if arguments.json {
        print(&serde_json::to_string(&answer)?)?;
    }
    let counted = |count: usize, [one, several]: [&str; 2]| {
        format!("{count} {}", if count == 1 { one } else { several })
    };
    let (analyses, points) = (
        counted(study.analyses.len(), ["analysis", "analyses"]),
        counted(points_to_evaluate(&study), ["point", "points"]),
    );
    for warning in &answer.warnings {
        say(&format!("warning: {warning}"));
    }
    let verdict = match answer.warnings.len() {
        0 => "fine".to_owned(),
        count => counted(count, ["warning", "warnings"]),
    };
    say(&format!("{}: {verdict}; {analyses}, {points}", found.shown));
    Ok(Outcome::Fine)
}
