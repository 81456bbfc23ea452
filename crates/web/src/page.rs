//! The files of the page, if it was built into the program, else a message on how to build it.
//!
//! Its files contain nothing of the study, so that they need no token.

use std::sync::Arc;

use axum::extract::State as Shared;
use axum::http::Uri;
use axum::response::{IntoResponse, Response};
use axum::{Extension, Router};

use crate::body::typed;
use crate::connections::Client;
use crate::error::ApiError;
use crate::server::State;

/// The files of the page by their names, which `cargo xtask web` makes and `build.rs` finds; empty where there are
/// none.
const BUILT: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// What is served without it.
const NOT_BUILT: &str = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>armill</title>\
<p>This armill was built without its page. In the sources, with Node installed: <code>cargo xtask web</code>, then build \
again. Everything under <code>/api</code> works as it is.</p></html>";

/// Whether the page was built into this program.
pub fn has_page() -> bool {
    !BUILT.is_empty()
}

pub(crate) fn routes() -> Router<Arc<State>> {
    Router::new()
        .route("/", axum::routing::get(file))
        .route("/{*path}", axum::routing::get(file))
}

async fn file(Shared(state): Shared<Arc<State>>, Extension(client): Extension<Client>, uri: Uri) -> Response {
    if client.is_known() {
        // The browser has the address.
        state.opening.remove();
    }
    let path = match uri.path().trim_start_matches('/') {
        "" => "index.html",
        path => path,
    };
    match BUILT.iter().find(|(name, _)| *name == path) {
        Some((_, bytes)) => typed(kind(path), *bytes),
        None if path == "index.html" => typed(kind(path), NOT_BUILT),
        None => ApiError::not_found("there is nothing at this path").into_response(),
    }
}

/// The type of a file, by its ending.
pub(crate) fn kind(path: &str) -> &'static str {
    match path.rsplit_once('.').map_or("", |(_, ending)| ending) {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" => "application/json",
        "csv" => "text/csv; charset=utf-8",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "ico" => "image/x-icon",
        "woff2" => "font/woff2",
        "wasm" => "application/wasm",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_included_page_is_complete() {
        // What the page names is there, be it built in or not.
        let of = |name: &str| {
            BUILT
                .iter()
                .find(|(other, _)| *other == name)
                .map(|(_, bytes)| *bytes)
        };
        let Some(index) = of("index.html") else {
            assert!(!has_page());
            return;
        };
        let index = String::from_utf8_lossy(index);
        let mut named = index
            .split('"')
            .filter(|word| word.ends_with(".js") || word.ends_with(".css"));
        assert!(named.clone().count() >= 2, "{index}");
        assert!(
            named.all(|name| of(name.trim_start_matches("./").trim_start_matches('/')).is_some()),
            "{index}"
        );
    }
}
