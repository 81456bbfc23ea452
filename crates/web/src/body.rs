//! How a request body is read: bounded in size and time before anything is kept.

use std::time::Duration;

use armill_api::ApiError;
use axum::body::{Body, BodyDataStream};
use axum::extract::{FromRequest, Request};
use axum::http::HeaderMap;
use axum::http::header::CONTENT_LENGTH;
use futures_util::StreamExt;
use serde::de::DeserializeOwned;

use crate::error::SentError;

/// Largest size of a request in JSON, bytes.
pub(crate) const MOST_JSON: u64 = 16 << 20;
/// How long the next piece of a body may take.
const PIECE_TIME: Duration = Duration::from_secs(10);
/// Time limit for a whole request.
const JSON_TIME: Duration = Duration::from_secs(60);

/// A body that arrives in pieces, bounded in size and in time.
pub(crate) struct Pieces {
    stream: BodyDataStream,
    read: u64,
    most: u64,
}

impl Pieces {
    /// # Errors
    /// A body whose header states that it is too large.
    pub(crate) fn of(headers: &HeaderMap, body: Body, most: u64) -> Result<Pieces, ApiError> {
        let given = headers
            .get(CONTENT_LENGTH)
            .and_then(|length| length.to_str().ok()?.parse().ok());
        if given.is_some_and(|length: u64| length > most) {
            return Err(ApiError::too_large(most));
        }
        Ok(Pieces {
            stream: body.into_data_stream(),
            read: 0,
            most,
        })
    }

    /// The next piece; `None` at the end.
    ///
    /// # Errors
    /// Too large, too slow, broken off.
    pub(crate) async fn next(&mut self) -> Result<Option<axum::body::Bytes>, ApiError> {
        let next = tokio::time::timeout(PIECE_TIME, self.stream.next()).await;
        match next.map_err(|_| ApiError::too_slow())? {
            None => Ok(None),
            Some(Err(error)) => Err(ApiError::invalid(format!("the body ended early: {error}"))),
            Some(Ok(piece)) => {
                self.read += piece.len() as u64;
                if self.read > self.most {
                    return Err(ApiError::too_large(self.most));
                }
                Ok(Some(piece))
            }
        }
    }
}

/// The whole body of a request that is answered at once.
pub(crate) struct WholeBody(pub Vec<u8>);

impl<S: Send + Sync> FromRequest<S> for WholeBody {
    type Rejection = SentError;

    async fn from_request(request: Request, _: &S) -> Result<WholeBody, SentError> {
        let (parts, body) = request.into_parts();
        let mut pieces = Pieces::of(&parts.headers, body, MOST_JSON)?;
        let read = async {
            let mut bytes = Vec::new();
            while let Some(piece) = pieces.next().await? {
                bytes.extend_from_slice(&piece);
            }
            Ok::<_, ApiError>(bytes)
        };
        let bytes = tokio::time::timeout(JSON_TIME, read)
            .await
            .map_err(|_| ApiError::too_slow())??;
        Ok(WholeBody(bytes))
    }
}

/// A request in JSON.
pub(crate) struct JsonBody<T>(pub T);

impl<T: DeserializeOwned, S: Send + Sync> FromRequest<S> for JsonBody<T> {
    type Rejection = SentError;

    async fn from_request(request: Request, state: &S) -> Result<JsonBody<T>, SentError> {
        let WholeBody(bytes) = WholeBody::from_request(request, state).await?;
        Ok(JsonBody(armill_api::parsed(&bytes)?))
    }
}
