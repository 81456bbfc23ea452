//! How errors are reported: `{"error": {"kind", "message", "hint", "problems"}}`, and the status of the answer.

use armill_formats::document::Problem;
use armill_study::{ErrorKind, StudyError};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use schemars::JsonSchema;
use serde::Serialize;

use crate::reply::json;

/// An error.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct ErrorBody {
    /// The error.
    pub error: ErrorDetail,
}

/// An error.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct ErrorDetail {
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
pub(crate) struct ApiError {
    status: StatusCode,
    wrong: ErrorDetail,
}

/// The result of a handler.
pub(crate) type Answered = Result<Response, ApiError>;

impl ApiError {
    fn new(status: StatusCode, kind: &'static str, message: impl Into<String>) -> ApiError {
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

    pub(crate) fn invalid(message: impl Into<String>) -> ApiError {
        ApiError::new(StatusCode::BAD_REQUEST, "invalid-input", message)
    }

    pub(crate) fn unauthorised() -> ApiError {
        let message = "the token is missing or wrong: open the address that `armill serve` has printed";
        ApiError::new(StatusCode::UNAUTHORIZED, "unauthorised", message)
    }

    pub(crate) fn forbidden(message: impl Into<String>) -> ApiError {
        ApiError::new(StatusCode::FORBIDDEN, "forbidden", message)
    }

    pub(crate) fn not_found(message: impl Into<String>) -> ApiError {
        ApiError::new(StatusCode::NOT_FOUND, "not-found", message)
    }

    pub(crate) fn conflict(message: impl Into<String>) -> ApiError {
        ApiError::new(StatusCode::CONFLICT, "conflict", message)
    }

    pub(crate) fn superseded() -> ApiError {
        let message = "replaced by a later request of this tab";
        ApiError::new(StatusCode::CONFLICT, "superseded", message)
    }

    pub(crate) fn too_large(most: u64) -> ApiError {
        let message = format!("more than {} MiB", most >> 20);
        ApiError::new(StatusCode::PAYLOAD_TOO_LARGE, "too-large", message)
    }

    pub(crate) fn too_many(message: impl Into<String>) -> ApiError {
        ApiError::new(StatusCode::TOO_MANY_REQUESTS, "too-many", message)
    }

    pub(crate) fn too_slow() -> ApiError {
        ApiError::new(
            StatusCode::REQUEST_TIMEOUT,
            "invalid-input",
            "the body arrived too slowly",
        )
    }

    pub(crate) fn internal(message: impl Into<String>) -> ApiError {
        ApiError::new(StatusCode::INTERNAL_SERVER_ERROR, "internal", message)
    }

    /// The error of a job that failed.
    pub(crate) fn into_detail(self) -> ErrorDetail {
        self.wrong
    }
}

impl From<StudyError> for ApiError {
    fn from(error: StudyError) -> ApiError {
        let kind = error.kind();
        match (error, kind) {
            (StudyError::Problems(problems), _) => {
                let mut given = ApiError::new(
                    StatusCode::UNPROCESSABLE_ENTITY,
                    "invalid-input",
                    "the study has problems",
                );
                given.wrong.problems = problems.as_slice().to_vec();
                given
            }
            (StudyError::Value { message, hint }, _) => {
                let mut given = ApiError::invalid(message);
                given.wrong.hint = Some(hint);
                given
            }
            (error, ErrorKind::InvalidInput) => ApiError::invalid(error.to_string()),
            (error, ErrorKind::Cancelled) => {
                ApiError::new(StatusCode::CONFLICT, "cancelled", error.to_string())
            }
            (error, ErrorKind::Internal) => ApiError::internal(error.to_string()),
        }
    }
}

impl From<serde_json::Error> for ApiError {
    fn from(error: serde_json::Error) -> ApiError {
        ApiError::internal(error.to_string())
    }
}

impl IntoResponse for ApiError {
    fn into_response(self) -> Response {
        let written = json(self.status, &ErrorBody { error: self.wrong });
        written.unwrap_or_else(|_| StatusCode::INTERNAL_SERVER_ERROR.into_response())
    }
}

/// The answer to an unknown path.
pub(crate) async fn no_such_path() -> ApiError {
    ApiError::not_found("there is nothing at this path")
}

/// The answer to a known path with another method.
pub(crate) async fn wrong_method() -> ApiError {
    ApiError::new(
        StatusCode::METHOD_NOT_ALLOWED,
        "invalid-input",
        "this path requires another method",
    )
}
