//! One request that is answered at once: its path, its description, its answer.

use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::context::Context;
use crate::error::ApiError;
use crate::openapi::{Description, Method};

/// From the body of a request to the bytes of its answer.
type Work = Box<dyn Fn(&Context, &[u8], Watch<'_>) -> Result<Vec<u8>, ApiError> + Send + Sync>;

/// A request that is answered at once.
pub struct Operation {
    /// Its path and its types.
    pub description: Description,
    /// Requests of one tab with the same word replace each other; `None`: each is answered.
    pub replaced_as: Option<&'static str>,
    work: Work,
}

impl Operation {
    /// One without a body, answered in JSON.
    pub(crate) fn get<A: Serialize + JsonSchema + 'static>(
        path: &'static str,
        about: &'static str,
        work: fn(&Context) -> Result<A, ApiError>,
    ) -> Operation {
        Operation {
            description: Description::new(Method::Get, path, about).answers::<A>(),
            replaced_as: None,
            work: Box::new(move |context, _, _| as_json(&work(context)?)),
        }
    }

    /// One without a body, whose answer is made once, as bytes of this description.
    pub(crate) fn constant(description: Description, work: fn() -> Result<Vec<u8>, ApiError>) -> Operation {
        Operation {
            description,
            replaced_as: None,
            work: Box::new(move |_, _, _| work()),
        }
    }

    /// One with a body in JSON, answered in JSON.
    pub(crate) fn json<Q: DeserializeOwned + JsonSchema + 'static, A: Serialize + JsonSchema + 'static>(
        method: Method,
        path: &'static str,
        about: &'static str,
        work: fn(&Context, Q, Watch<'_>) -> Result<A, ApiError>,
    ) -> Operation {
        Operation {
            description: Description::new(method, path, about).takes::<Q>().answers::<A>(),
            replaced_as: None,
            work: Box::new(move |context, body, watch| as_json(&work(context, parsed(body)?, watch)?)),
        }
    }

    /// One with a body in JSON, answered in bytes of this description.
    pub(crate) fn bytes<Q: DeserializeOwned + JsonSchema + 'static>(
        description: Description,
        work: fn(&Context, Q, Watch<'_>) -> Result<Vec<u8>, ApiError>,
    ) -> Operation {
        Operation {
            description: description.takes::<Q>(),
            replaced_as: None,
            work: Box::new(move |context, body, watch| work(context, parsed(body)?, watch)),
        }
    }

    /// A newer request of a tab replaces an older one with the same word.
    pub(crate) fn replaced_as(mut self, word: &'static str) -> Operation {
        self.replaced_as = Some(word);
        self
    }

    /// The answer to this body; its type is that of the description.
    ///
    /// # Errors
    /// A body that is not the requested type; the error of the answer.
    pub fn answer(&self, context: &Context, body: &[u8], watch: Watch<'_>) -> Result<Vec<u8>, ApiError> {
        (self.work)(context, body, watch)
    }
}

/// A body in JSON.
///
/// # Errors
/// Not JSON, or not of this type.
pub fn parsed<T: DeserializeOwned>(body: &[u8]) -> Result<T, ApiError> {
    serde_json::from_slice(body).map_err(|error| ApiError::invalid(format!("the request body: {error}")))
}

fn as_json(value: &impl Serialize) -> Result<Vec<u8>, ApiError> {
    Ok(serde_json::to_vec(value)?)
}
