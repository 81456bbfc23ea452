//! The files of the page, if it was built into the program, else a message on how to build it.
//!
//! Its files contain nothing of the study, so that they need no token.

use std::sync::Arc;

use axum::Extension;
use axum::extract::State as Shared;
use axum::http::Uri;
use axum::response::{IntoResponse, Response};

use crate::connections::Client;
use crate::error::no_such_path;
use crate::reply::{media_type, typed};
use crate::state::State;

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

/// The file of the page at the path of the request.
pub(crate) async fn file(
    Shared(state): Shared<Arc<State>>,
    Extension(client): Extension<Client>,
    uri: Uri,
) -> Response {
    if client.is_known() {
        // The browser has the address.
        state.opening.remove();
    }
    let path = match uri.path().trim_start_matches('/') {
        "" => "index.html",
        path => path,
    };
    match BUILT.iter().find(|(name, _)| *name == path) {
        Some((_, bytes)) => typed(media_type(path), *bytes),
        None if path == "index.html" => typed(media_type(path), NOT_BUILT),
        None => no_such_path().await.into_response(),
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
