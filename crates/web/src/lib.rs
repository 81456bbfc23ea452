//! The local server behind `armill serve`: the live page of one study, for the user of this machine alone.
//!
//! It contains no mechanics and no format: every answer is a value of `armill-study`, serialised as the command prints
//! it.
//!
//! ```text
//! browser -> 127.0.0.1 -> guard (host, origin, token) -> handlers -> work (own thread) -> armill-study
//! ```
//!
//! | file | content |
//! |---|---|
//! | `server` | start, listening and stop |
//! | `connections`, `stream` | number of connections, and which are closed |
//! | `guard` | allowed requests, headers of every answer |
//! | `cell` | the study that is served, and the folder of its files |
//! | `body`, `error` | reading of request bodies, reporting of errors |
//! | `work` | threads of the computation, cancelling |
//! | `study`, `answers`, `jobs`, `files` | the paths under `/api` |
//! | `job`, `task` | progress of one job, and what each kind does |
//! | `page` | the files of the page |
//! | `opening` | how the browser receives the address |
//! | `openapi` | the description of the interface for programs |
//!
//! Nothing is requested from outside this machine, and the page loads nothing from elsewhere.

mod answers;
mod body;
mod cell;
mod connections;
mod error;
mod files;
mod guard;
mod job;
mod jobs;
mod openapi;
mod opening;
mod page;
mod server;
mod stream;
mod study;
mod task;
mod work;

pub use openapi::document as openapi_document;
pub use page::has_page;
pub use server::{Options, Server};
