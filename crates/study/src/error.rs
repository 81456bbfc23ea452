//! The errors of a study, and their kinds.

use armill_core::watch::Cancelled;
use armill_formats::document::Problems;
use armill_formats::file::FileError;

/// Anything that ends a command early.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A file says something that cannot be.
    #[error("{0}")]
    Problems(#[from] Problems),
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A value on the command line (or in a call) is not valid.
    #[error("{message}\n  help: {hint}")]
    Value {
        /// The thing, its value, the limit and the unit.
        message: String,
        /// How to correct it.
        hint: String,
    },
    /// The user stopped the work.
    #[error("cancelled: nothing of this answer was written")]
    Cancelled(#[from] Cancelled),
    /// A picture could not be made.
    #[error("{0}")]
    Picture(#[from] armill_report::ReportError),
    /// A table could not be made.
    #[error("{0}")]
    Table(#[from] armill_formats::table::TableError),
    /// A Parquet file could not be made.
    #[cfg(feature = "parquet")]
    #[error("{0}")]
    Parquet(#[from] armill_formats::table::parquet::ParquetError),
    /// A VTK file could not be made.
    #[error("{0}")]
    Vtk(#[from] armill_formats::table::vtk::VtkError),
    /// The answer could not be written as JSON.
    #[error("{0}")]
    Json(#[from] serde_json::Error),
}

/// The kind of an error: it alone determines exit code, HTTP status and Python exception.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// The input is wrong; the user can correct it.
    InvalidInput,
    /// The user stopped the work.
    Cancelled,
    /// A fault of armill.
    Internal,
}

impl StudyError {
    /// A wrong value, and how to correct it.
    pub fn value(message: impl Into<String>, hint: impl Into<String>) -> StudyError {
        StudyError::Value {
            message: message.into(),
            hint: hint.into(),
        }
    }

    /// Of which kind this is.
    pub fn kind(&self) -> ErrorKind {
        match self {
            StudyError::Problems(_) | StudyError::File(_) | StudyError::Value { .. } => {
                ErrorKind::InvalidInput
            }
            StudyError::Cancelled(_) => ErrorKind::Cancelled,
            _ => ErrorKind::Internal,
        }
    }
}
