//! `armill check`: every problem of a study at once.
//!
//! Problems are told on stderr, with `--json` on stdout too; where there are none, stderr says how much there is to run.
//! `--schema` prints the JSON Schema of the study file instead.

use armill_formats::document::schema_json;
use armill_study::file::format::StudyFile;
use armill_study::run::point_count;
use armill_study::{StudyError, studies};

use crate::Outcome;
use crate::arguments::CheckArguments;
use crate::terminal::{print, say};

/// Checks the study, or prints the schema.
///
/// # Errors
/// No study there; every problem of its file, told together.
pub(crate) fn run(arguments: &CheckArguments) -> Result<Outcome, StudyError> {
    if arguments.schema {
        print(schema_json::<StudyFile>().trim_end())?;
        return Ok(Outcome::Fine);
    }
    let found = studies::find(arguments.study.as_deref().unwrap_or_else(|| ".".as_ref()))?;
    let study = found.read()?;
    if arguments.json {
        print(r#"{"problems":[]}"#)?;
    }
    let counted = |count: usize, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
    let (analyses, points) = (
        counted(study.analyses.len(), "analysis"),
        counted(point_count(&study), "point"),
    );
    say(&format!("{}: fine; {analyses}, {points}", found.shown));
    Ok(Outcome::Fine)
}
