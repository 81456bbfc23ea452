//! The requests of the live page and their answers, without a server: bytes in, bytes out.
//!
//! It contains no mechanics and no format: every answer is a value of `armill-study`, `armill-plan` or `armill-measure`,
//! serialised as the command prints it. `armill serve` (crate `web`) and the program in the browser (crate `browser`) answer
//! with it.
//!
//! | file | content |
//! |---|---|
//! | `operations` | all requests that are answered at once |
//! | `answers`, `study`, `files` | their answers |
//! | `operation` | one request: its path, its description, its answer |
//! | `openapi` | the description of the interface for programs |
//! | `context` | what answers share |
//! | `execute` | how a job is executed |
//! | `job`, `task` | progress of one job, and what each kind does |
//! | `cell`, `folder` | the study, and the folder of its files |
//! | `error` | how errors are reported |
//!
//! A file uses only those below it.

mod answers;
mod cell;
mod context;
mod error;
mod execute;
mod files;
mod folder;
mod job;
mod openapi;
mod operation;
mod operations;
mod study;
mod task;

pub use cell::{Cell, private_folder};
pub use context::Context;
pub use error::{ApiError, ErrorBody, ErrorDetail};
pub use execute::execute;
pub use files::{Files, MOST_FILE_BYTES, UploadedFile, check_name, file_path, uploaded};
pub use folder::FileRow;
pub use job::{Job, JobAnswer, JobState};
pub use openapi::{Description, JSON, Method, describe};
pub use operation::{Operation, parsed};
pub use operations::{find, operations};
pub use study::{MOST_TEXT_BYTES, check_text, title};
pub use task::Task;
