//! All paths under `/api`: the requests that are answered at once, and those that need a server.
//!
//! To add a path of a server: a handler in the file of its subject, and a row in [`of_server`].

use std::sync::{Arc, LazyLock};

use armill_api::{Description, JSON, JobAnswer, Method, Operation, Task, UploadedFile};
use armill_core::watch::Watch;
use axum::Router;
use axum::body::Bytes;
use axum::extract::State as Shared;
use axum::http::HeaderMap;
use axum::response::Response;
use axum::routing::{MethodFilter, MethodRouter, on};
use serde_json::Value;

use crate::body::WholeBody;
use crate::error::{Answered, no_such_path, wrong_method};
use crate::files::{self, TicketAnswer, TicketRequest};
use crate::jobs::{self, JobBegun, JobList};
use crate::reply::typed;
use crate::state::State;

/// A path with its handler.
type Route = (Description, MethodRouter<Arc<State>>);

/// The paths whose answers are files, events, or the work of the server itself.
fn of_server() -> Vec<Route> {
    use Method::{Delete, Get, Post, Put};
    let path = Description::new;
    let events = "Progress of a job: events `job`";
    let ticket = "An address that opens one file once";
    vec![
        (
            path(Post, "/jobs", "Begins a job")
                .takes::<Task>()
                .answers::<JobBegun>()
                .with(202),
            on(MethodFilter::POST, jobs::begin),
        ),
        (
            path(Get, "/jobs", "All jobs").answers::<JobList>(),
            on(MethodFilter::GET, jobs::list),
        ),
        (
            path(Get, "/jobs/{id}", "One job with its answer").answers::<JobAnswer>(),
            on(MethodFilter::GET, jobs::one),
        ),
        (
            path(Delete, "/jobs/{id}", "Cancels a job").answers::<JobAnswer>(),
            on(MethodFilter::DELETE, jobs::cancel),
        ),
        (
            path(Get, "/jobs/{id}/events", events).sends("text/event-stream"),
            on(MethodFilter::GET, jobs::events),
        ),
        (
            path(Get, "/files/{*path}", "One file").sends("application/octet-stream"),
            on(MethodFilter::GET, files::read),
        ),
        (
            path(Put, "/files/{*path}", "Uploads a file")
                .answers::<UploadedFile>()
                .with(201),
            on(MethodFilter::PUT, files::take),
        ),
        (
            path(Post, "/tickets", ticket)
                .takes::<TicketRequest>()
                .answers::<TicketAnswer>(),
            on(MethodFilter::POST, files::ticket),
        ),
        (
            path(Get, "/openapi.json", "This document"),
            on(MethodFilter::GET, openapi),
        ),
    ]
}

/// The handlers of all paths.
pub(crate) fn router() -> Router<Arc<State>> {
    let at_once = armill_api::operations().iter().map(at_once);
    let add =
        |router: Router<Arc<State>>, (description, handler): Route| router.route(description.path, handler);
    let paths = at_once.chain(of_server()).fold(Router::new(), add);
    paths
        .fallback(no_such_path)
        .method_not_allowed_fallback(wrong_method)
}

/// A request that is answered at once: on a separate thread, and replaced by a newer one of its tab.
fn at_once(operation: &'static Operation) -> Route {
    let Description { method, kind, .. } = operation.description;
    let filter = match method {
        Method::Get => MethodFilter::GET,
        Method::Put => MethodFilter::PUT,
        Method::Post => MethodFilter::POST,
        Method::Delete => MethodFilter::DELETE,
    };
    let handler = move |Shared(state): Shared<Arc<State>>, headers: HeaderMap, body: WholeBody| async move {
        let context = Arc::clone(&state.context);
        let work = move |watch: Watch<'_>| Ok(operation.answer(&context, &body.0, watch));
        let bytes = match operation.replaced_as {
            Some(word) => state.work.done_in_tab(&headers, word, work).await??,
            None => state.work.done(work).await??,
        };
        Answered::Ok(typed(kind, bytes))
    };
    (operation.description, on(filter, handler))
}

/// The description of all paths for programs, OpenAPI 3.1.
pub fn document() -> Value {
    let at_once = armill_api::operations()
        .iter()
        .map(|operation| operation.description);
    let all: Vec<Description> = at_once
        .chain(of_server().into_iter().map(|(description, _)| description))
        .collect();
    armill_api::describe(&all)
}

/// The document as it is sent: made once.
static DOCUMENT: LazyLock<Bytes> = LazyLock::new(|| document().to_string().into());

async fn openapi() -> Response {
    typed(JSON, DOCUMENT.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every `$ref` below `value`.
    fn references(value: &Value, found: &mut Vec<String>) {
        match value {
            Value::Object(fields) => {
                if let Some(Value::String(to)) = fields.get("$ref") {
                    found.push(to.clone());
                }
                fields.values().for_each(|value| references(value, found));
            }
            Value::Array(entries) => entries.iter().for_each(|value| references(value, found)),
            _ => {}
        }
    }

    #[test]
    fn every_reference_leads_to_a_schema() {
        let document = document();
        let mut found = Vec::new();
        references(&document, &mut found);
        assert!(found.len() > 50);
        for to in found {
            let there = document.pointer(to.strip_prefix('#').unwrap());
            assert!(there.is_some(), "{to}");
        }
    }

    #[test]
    fn an_answer_always_has_all_its_fields() {
        let document = document();
        let map = &document["components"]["schemas"]["MapAnswer"];
        let required: Vec<&str> = map["required"]
            .as_array()
            .unwrap()
            .iter()
            .filter_map(Value::as_str)
            .collect();
        assert!(
            required.contains(&"worst") && required.contains(&"grid"),
            "{required:?}"
        );
    }
}
