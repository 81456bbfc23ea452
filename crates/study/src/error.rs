//! What can go wrong, and of which kind it is.

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
    /// A value on the command line (or in a call) cannot be.
    #[error("{message}\n  help: {hint}")]
    Value {
        /// The thing, its value, the limit and the unit.
        message: String,
        /// What to do about it.
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
    /// The answer could not be told as JSON.
    #[error("{0}")]
    Json(#[from] serde_json::Error),
}

/// Of which kind an error is: this alone decides exit code, HTTP status and Python exception.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// The input is wrong; the user can mend it.
    InvalidInput,
    /// The user stopped the work.
    Cancelled,
    /// armill is wrong.
    Internal,
}

impl StudyError {
    /// A wrong value with what to do about it.
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
