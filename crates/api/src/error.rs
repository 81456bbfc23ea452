//! How errors are reported: `{"error": {"kind", "message", "hint", "problems"}}`, and the status of the answer.

use armill_formats::document::Problem;
use armill_study::{ErrorKind, StudyError};
use schemars::JsonSchema;
use serde::Serialize;

/// An error.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ErrorBody {
    /// The error.
    pub error: ErrorDetail,
}

/// An error.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ErrorDetail {
    /// `invalid-input`, `cancelled`, `internal`, `unauthorised`, `forbidden`, `not-found`, `conflict`, `superseded`,
    /// `too-large` or `too-many`.
    pub kind: &'static str,
    /// The message.
    pub message: String,
    /// How to correct it, where that is known.
    pub hint: Option<String>,
    /// Problems of the study, each with its place.
    pub problems: Vec<Problem>,
}

/// An error as an answer.
#[derive(Debug)]
pub struct ApiError {
    status: u16,
    wrong: ErrorDetail,
}

impl ApiError {
    fn new(status: u16, kind: &'static str, message: impl Into<String>) -> ApiError {
        ApiError {
            status,
            wrong: ErrorDetail {
                kind,
                message: message.into(),
                hint: None,
                problems: Vec::new(),
            },
        }
    }

    /// The request or the study cannot be used as it is.
    pub fn invalid(message: impl Into<String>) -> ApiError {
        ApiError::new(400, "invalid-input", message)
    }

    /// The token of the server is missing.
    pub fn unauthorised() -> ApiError {
        let message = "the token is missing or wrong: open the address that `armill serve` has printed";
        ApiError::new(401, "unauthorised", message)
    }

    /// It is not allowed.
    pub fn forbidden(message: impl Into<String>) -> ApiError {
        ApiError::new(403, "forbidden", message)
    }

    /// There is nothing of that name.
    pub fn not_found(message: impl Into<String>) -> ApiError {
        ApiError::new(404, "not-found", message)
    }

    /// It contradicts the present state.
    pub fn conflict(message: impl Into<String>) -> ApiError {
        ApiError::new(409, "conflict", message)
    }

    /// A later request of the same tab has replaced it.
    pub fn superseded() -> ApiError {
        let message = "replaced by a later request of this tab";
        ApiError::new(409, "superseded", message)
    }

    /// More than `most` bytes.
    pub fn too_large(most: u64) -> ApiError {
        let message = format!("more than {} MiB", most >> 20);
        ApiError::new(413, "too-large", message)
    }

    /// More of them than are allowed at a time.
    pub fn too_many(message: impl Into<String>) -> ApiError {
        ApiError::new(429, "too-many", message)
    }

    /// Its body arrived too slowly.
    pub fn too_slow() -> ApiError {
        ApiError::new(408, "invalid-input", "the body arrived too slowly")
    }

    /// A fault of armill.
    pub fn internal(message: impl Into<String>) -> ApiError {
        ApiError::new(500, "internal", message)
    }

    /// The path is known, with another method.
    pub fn wrong_method() -> ApiError {
        ApiError::new(405, "invalid-input", "this path requires another method")
    }

    /// The path is not known.
    pub fn no_such_path() -> ApiError {
        ApiError::not_found("there is nothing at this path")
    }

    /// The status of the answer, as HTTP numbers it.
    pub fn status(&self) -> u16 {
        self.status
    }

    /// The answer, as JSON.
    pub fn into_json(self) -> Vec<u8> {
        serde_json::to_vec(&ErrorBody { error: self.wrong }).unwrap_or_default()
    }

    /// The error of a job that failed.
    pub fn into_detail(self) -> ErrorDetail {
        self.wrong
    }
}

impl From<StudyError> for ApiError {
    fn from(error: StudyError) -> ApiError {
        let kind = error.kind();
        match (error, kind) {
            (StudyError::Problems(problems), _) => {
                let mut given = ApiError::new(422, "invalid-input", "the study has problems");
                given.wrong.problems = problems.as_slice().to_vec();
                given
            }
            (StudyError::Value { message, hint }, _) => {
                let mut given = ApiError::invalid(message);
                given.wrong.hint = Some(hint);
                given
            }
            (error, ErrorKind::InvalidInput) => ApiError::invalid(error.to_string()),
            (error, ErrorKind::Cancelled) => ApiError::new(409, "cancelled", error.to_string()),
            (error, ErrorKind::Internal) => ApiError::internal(error.to_string()),
        }
    }
}

impl From<serde_json::Error> for ApiError {
    fn from(error: serde_json::Error) -> ApiError {
        ApiError::internal(error.to_string())
    }
}
