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

use std::sync::{Arc, LazyLock};

use armill_formats::document::{Problem, schema_json};
use armill_study::file::format::StudyFile;
use armill_study::live::{ChangedValue, OutlineAnswer, OutlinedAnalysis, changed, outline, tables};
use axum::body::Bytes;
use axum::extract::State as Shared;
use axum::http::StatusCode;
use axum::response::Response;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::body::{JsonBody, check_text};
use crate::cell::{self, Cell};
use crate::error::Answered;
use crate::reply::{JSON, json, typed};
use crate::state::State;

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

pub(crate) async fn read(Shared(state): Shared<Arc<State>>) -> Answered {
    let shared = Arc::clone(&state);
    let study = state.work.done(move |_| Ok(on_disk(&shared.cell))).await?;
    Ok(json(StatusCode::OK, &study)?)
}

pub(crate) async fn write(
    Shared(state): Shared<Arc<State>>,
    JsonBody(written): JsonBody<StudyUpdate>,
) -> Answered {
    check_text(&written.text)?;
    let shared = Arc::clone(&state);
    let work = move |_: armill_core::watch::Watch<'_>| {
        Ok(shared
            .cell
            .write(&written.text, &written.version)
            .map(|()| on_disk(&shared.cell)))
    };
    Ok(json(StatusCode::OK, &state.work.done(work).await??)?)
}

pub(crate) async fn version(Shared(state): Shared<Arc<State>>) -> Answered {
    let shared = Arc::clone(&state);
    let work = move |_: armill_core::watch::Watch<'_>| {
        Ok(StudyVersion {
            version: shared.cell.state(),
            exists: shared.cell.exists(),
        })
    };
    Ok(json(StatusCode::OK, &state.work.done(work).await?)?)
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
        None => outline(armill_study::live::StudyText {
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

pub(crate) async fn check(
    Shared(state): Shared<Arc<State>>,
    JsonBody(checked): JsonBody<CheckRequest>,
) -> Answered {
    check_text(&checked.text)?;
    let shared = Arc::clone(&state);
    let work = move |_: armill_core::watch::Watch<'_>| Ok(outline(shared.cell.text(&checked.text)));
    Ok(json(StatusCode::OK, &state.work.done(work).await?)?)
}

pub(crate) async fn change(
    Shared(state): Shared<Arc<State>>,
    JsonBody(requested): JsonBody<ChangeRequest>,
) -> Answered {
    check_text(&requested.text)?;
    let shared = Arc::clone(&state);
    let work = move |_: armill_core::watch::Watch<'_>| {
        changed(
            shared.cell.text(&requested.text),
            requested.analysis.as_deref(),
            &requested.changes,
        )
    };
    Ok(json(StatusCode::OK, &state.work.done(work).await?)?)
}

pub(crate) async fn of_tables(
    Shared(state): Shared<Arc<State>>,
    JsonBody(checked): JsonBody<CheckRequest>,
) -> Answered {
    check_text(&checked.text)?;
    let shared = Arc::clone(&state);
    let work = move |_: armill_core::watch::Watch<'_>| Ok(tables(shared.cell.text(&checked.text)));
    Ok(json(StatusCode::OK, &state.work.done(work).await?)?)
}

/// Made once: it is that of the program.
static SCHEMA: LazyLock<Bytes> = LazyLock::new(|| schema_json::<StudyFile>().into());

pub(crate) async fn schema() -> Response {
    typed(JSON, SCHEMA.clone())
}
