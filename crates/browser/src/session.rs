//! The study of the page, and its requests: those of `armill-api`, and what a server does otherwise.
//!
//! | request | answer |
//! |---|---|
//! | those of `armill_api::operations`, below `/api` | as there |
//! | `GET /api/examples` | name and title of the example studies |
//! | `POST /api/example` | puts the files of an example into the folder |
//! | `POST /api/uploaded` | whether a file of the folder may be there, and its kind |
//! | `POST /api/job` | a job that waits |
//! | `POST /api/execute` | the same job, finished; its progress is written to stdout |

use std::path::Path;

use armill_api::{ApiError, Cell, Context, JSON, Job, Task, check_name, execute, parsed, title, uploaded};
use armill_core::watch::Watch;
use armill_formats::file::write_atomically;
use armill_study::StudyError;
use armill_study::library;
use armill_study::live::{StudyText, outline};
use serde::{Deserialize, Serialize};

use crate::progress;

/// The folder of the study.
pub const FOLDER: &str = "/study";

/// A reply.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reply {
    /// As HTTP numbers it.
    pub status: u16,
    /// The type of the bytes.
    pub kind: &'static str,
    /// The bytes.
    pub bytes: Vec<u8>,
}

/// The study of the page, with what was evaluated last.
pub struct Session {
    context: Context,
}

/// An example study.
#[derive(Serialize)]
struct ExampleRow {
    name: &'static str,
    title: String,
}

/// An example, or a file, by its name.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Named {
    name: String,
}

/// A job to begin, or to execute.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NumberedTask {
    /// Its name.
    id: String,
    /// What to do.
    task: Task,
}

impl Session {
    /// The study in this folder.
    pub fn of_folder(folder: &Path) -> Session {
        Session {
            context: Context::new(Cell::of_folder(folder.to_owned())),
        }
    }

    /// The reply to a request.
    pub fn answer(&self, method: &str, path: &str, body: &[u8]) -> Reply {
        let below = path.strip_prefix("/api").unwrap_or_default();
        let (kind, answered) = match armill_api::find(method, below) {
            Some(operation) => (
                operation.description.kind,
                operation.answer(&self.context, body, Watch::NONE),
            ),
            None => (JSON, self.own(method, below, body)),
        };
        match answered {
            Ok(bytes) => Reply {
                status: 200,
                kind,
                bytes,
            },
            Err(error) => Reply {
                status: error.status(),
                kind: JSON,
                bytes: error.into_json(),
            },
        }
    }

    /// What a server does otherwise.
    fn own(&self, method: &str, path: &str, body: &[u8]) -> Result<Vec<u8>, ApiError> {
        match (method, path) {
            ("GET", "/examples") => json(&examples()),
            ("POST", "/example") => json(&self.take_example(&parsed::<Named>(body)?.name)?),
            ("POST", "/uploaded") => self.uploaded(parsed::<Named>(body)?.name),
            ("POST", "/job") => json(&self.job(parsed(body)?)?.reported(false)),
            ("POST", "/execute") => {
                let job = self.job(parsed(body)?)?.reporting_to(progress::show);
                let cell = &self.context.cell;
                execute(&job, &cell.shown, &cell.root);
                json(&job.reported(true))
            }
            _ => Err(ApiError::no_such_path()),
        }
    }

    /// A job that waits. A study with problems becomes a job that fails, and reports them.
    fn job(&self, NumberedTask { id, task }: NumberedTask) -> Result<Job, ApiError> {
        let title = title(&self.context, task.text())?;
        Ok(Job::new(id, task, title))
    }

    /// Puts the files of an example into the folder; their names.
    fn take_example(&self, name: &str) -> Result<Vec<&'static str>, ApiError> {
        let files = library::example(name)?;
        for (name, file) in &files {
            write_atomically(self.context.cell.root.join(name), file.text.as_bytes())
                .map_err(StudyError::from)?;
        }
        Ok(files.into_iter().map(|(name, _)| name).collect())
    }

    /// What is in the file of this name.
    fn uploaded(&self, name: String) -> Result<Vec<u8>, ApiError> {
        let cell = &self.context.cell;
        check_name(cell, &name)?;
        let path = cell.root.join(&name);
        let length = path
            .metadata()
            .map_err(|_| ApiError::not_found("there is no such file"))?
            .len();
        json(&uploaded(&path, name, length))
    }
}

/// All examples.
fn examples() -> Vec<ExampleRow> {
    let row = |study: &'static library::Embedded| {
        let text = StudyText {
            shown: study.path,
            folder: Path::new(study.name),
            bytes: study.text.as_bytes(),
        };
        ExampleRow {
            name: study.name,
            title: outline(text).title.unwrap_or_default(),
        }
    };
    library::example_studies().map(row).collect()
}

fn json(value: &impl Serialize) -> Result<Vec<u8>, ApiError> {
    Ok(serde_json::to_vec(value)?)
}
