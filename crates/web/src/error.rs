//! Errors as answers of the server.

use armill_api::{ApiError, JSON};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};

use crate::reply::typed;

/// An error that is sent.
#[derive(Debug)]
pub(crate) struct SentError(pub ApiError);

/// The result of a handler.
pub(crate) type Answered = Result<Response, SentError>;

impl<E> From<E> for SentError
where
    ApiError: From<E>,
{
    fn from(error: E) -> SentError {
        SentError(error.into())
    }
}

impl IntoResponse for SentError {
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.0.status()).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
        (status, typed(JSON, self.0.into_json())).into_response()
    }
}

/// The answer to an unknown path.
pub(crate) async fn no_such_path() -> SentError {
    SentError(ApiError::no_such_path())
}

/// The answer to a known path with another method.
pub(crate) async fn wrong_method() -> SentError {
    SentError(ApiError::wrong_method())
}
