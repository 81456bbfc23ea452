//! The study: read, written, checked, changed.
//!
//! | path | does |
//! |---|---|
//! | `GET /api/study` | text on disk, its outline, its problems |
//! | `PUT /api/study` | writes it, if it has not been changed since |
//! | `GET /api/study/version` | identifies the state of the file |
//! | `POST /api/check` | outline and problems of a text |
//! | `POST /api/change` | a text with some values changed, its comments kept |
//! | `POST /api/tables` | the values of a text, each with its place |
//! | `GET /api/schema` | which tables and values a study may have, as `armill check --schema` prints it |

use std::sync::LazyLock;

use armill_core::watch::Watch;
use armill_formats::document::{Problem, schema_json};
use armill_study::file::format::StudyFile;
use armill_study::live::{
    self, ChangedAnswer, ChangedValue, OutlineAnswer, OutlinedAnalysis, TablesAnswer, outline,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::cell::{self, Cell};
use crate::context::Context;
use crate::error::ApiError;

/// Largest size of a study, bytes.
pub const MOST_TEXT_BYTES: usize = 4 << 20;

/// The study as it is on disk.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct StudyOnDisk {
    /// The name of its file in messages.
    pub file: String,
    /// Identifies the study over restarts of the server: the path of its file, or the name of the example.
    pub identity: String,
    /// The folder of its files.
    pub folder: String,
    /// Whether its file is there; an example always is.
    pub exists: bool,
    /// Whether it may be written; an example may not.
    pub writable: bool,
    /// Whether it is the example because no study was named and the folder of the server has none.
    pub is_fallback: bool,
    /// Identifies this state of the file.
    pub version: String,
    /// Its text.
    pub text: String,
    /// Title of the study.
    pub title: Option<String>,
    /// The robot, as the study names it.
    pub robot: Option<String>,
    /// Its analyses, in order.
    pub analyses: Vec<OutlinedAnalysis>,
    /// All problems of the text.
    pub problems: Vec<Problem>,
    /// Version of armill.
    pub armill: &'static str,
}

/// A text to be written.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct StudyUpdate {
    /// The text.
    pub text: String,
    /// The state of the file that it is based on.
    pub version: String,
}

/// The state of the file of the study.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct StudyVersion {
    /// Identifies it: another one after every change by any program.
    pub version: String,
    /// Whether the file is there.
    pub exists: bool,
}

/// A text to be checked.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CheckRequest {
    /// The text.
    pub text: String,
}

/// A text to be changed.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ChangeRequest {
    /// The text.
    pub text: String,
    /// The analysis whose values they are; the study itself if left out.
    pub analysis: Option<String>,
    /// The changes.
    pub changes: Vec<ChangedValue>,
}

pub(crate) fn read(context: &Context) -> Result<StudyOnDisk, ApiError> {
    Ok(on_disk(&context.cell))
}

pub(crate) fn write(context: &Context, written: StudyUpdate, _: Watch<'_>) -> Result<StudyOnDisk, ApiError> {
    check_text(&written.text)?;
    context.cell.write(&written.text, &written.version)?;
    Ok(on_disk(&context.cell))
}

pub(crate) fn version(context: &Context) -> Result<StudyVersion, ApiError> {
    Ok(StudyVersion {
        version: context.cell.state(),
        exists: context.cell.exists(),
    })
}

/// The study as it is now; a file that can no longer be read is reported as a problem.
fn on_disk(cell: &Cell) -> StudyOnDisk {
    let (bytes, version, gone) = match cell.bytes() {
        Ok(bytes) => {
            let version = cell::version(&bytes);
            (bytes, version, None)
        }
        Err(error) => (Vec::new(), cell.state(), Some(error)),
    };
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let given = match gone {
        Some(error) => OutlineAnswer {
            problems: vec![Problem::of_file(&cell.shown, error.to_string(), "")],
            ..OutlineAnswer::default()
        },
        None => outline(live::StudyText {
            bytes: &bytes,
            ..cell.text(&text)
        }),
    };
    StudyOnDisk {
        file: cell.shown.clone(),
        identity: cell.identity(),
        exists: cell.exists(),
        is_fallback: cell.fallback,
        folder: cell.root.display().to_string(),
        writable: cell.writable,
        version,
        title: given.title,
        robot: given.robot,
        analyses: given.analyses,
        problems: given.problems,
        armill: env!("CARGO_PKG_VERSION"),
        text,
    }
}

pub(crate) fn check(
    context: &Context,
    checked: CheckRequest,
    _: Watch<'_>,
) -> Result<OutlineAnswer, ApiError> {
    check_text(&checked.text)?;
    Ok(outline(context.cell.text(&checked.text)))
}

/// The title of the study with this text; empty where it has none.
///
/// # Errors
/// A text longer than any study.
pub fn title(context: &Context, text: &str) -> Result<String, ApiError> {
    check_text(text)?;
    Ok(outline(context.cell.text(text)).title.unwrap_or_default())
}

pub(crate) fn change(
    context: &Context,
    requested: ChangeRequest,
    _: Watch<'_>,
) -> Result<ChangedAnswer, ApiError> {
    check_text(&requested.text)?;
    Ok(live::changed(
        context.cell.text(&requested.text),
        requested.analysis.as_deref(),
        &requested.changes,
    )?)
}

pub(crate) fn tables(
    context: &Context,
    checked: CheckRequest,
    _: Watch<'_>,
) -> Result<TablesAnswer, ApiError> {
    check_text(&checked.text)?;
    Ok(live::tables(context.cell.text(&checked.text)))
}

/// Made once: it is that of the program.
static SCHEMA: LazyLock<String> = LazyLock::new(schema_json::<StudyFile>);

pub(crate) fn schema() -> Result<Vec<u8>, ApiError> {
    Ok(SCHEMA.as_bytes().to_vec())
}

/// Refuses a text that is longer than any study.
///
/// # Errors
/// More than [`MOST_TEXT_BYTES`].
pub fn check_text(text: &str) -> Result<(), ApiError> {
    match text.len() > MOST_TEXT_BYTES {
        true => Err(ApiError::too_large(MOST_TEXT_BYTES as u64)),
        false => Ok(()),
    }
}
