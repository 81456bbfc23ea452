//! The local server behind `armill serve`: the live page of one study, for the user of this machine alone.
//!
//! It contains no mechanics and no format: every answer is one of `armill-api`, as the browser alone gives it too.
//!
//! ```text
//! browser -> 127.0.0.1 -> guard (host, origin, token) -> handlers -> work (own thread) -> armill-api
//! ```
//!
//! | file | content |
//! |---|---|
//! | `server` | start, listening and stop |
//! | `api` | the paths under `/api`, each with its handler |
//! | `jobs`, `files` | the handlers of what needs a server |
//! | `page` | the files of the page |
//! | `state` | what handlers share |
//! | `queue` | the jobs |
//! | `work` | threads of the computation, cancelling |
//! | `opening` | how the browser receives the address |
//! | `tickets` | addresses that open one file once |
//! | `guard` | allowed requests, headers of every answer |
//! | `connections`, `stream` | number of connections, and which are closed |
//! | `body`, `error`, `reply` | reading of request bodies, sending of errors, writing of answers |
//!
//! A file uses only those below it.
//!
//! Nothing is requested from outside this machine, and the page loads nothing from elsewhere.

mod api;
mod body;
mod connections;
mod error;
mod files;
mod guard;
mod jobs;
mod opening;
mod page;
mod queue;
mod reply;
mod server;
mod state;
mod stream;
mod tickets;
mod work;

pub use api::document as openapi_document;
pub use page::has_page;
pub use server::{Options, Server};
