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
//! | `api` | the paths under `/api`, each with its handler and its description |
//! | `study`, `answers`, `jobs`, `files` | the handlers |
//! | `openapi` | the description of the interface for programs |
//! | `page` | the files of the page |
//! | `state` | what handlers share |
//! | `queue`, `execute` | the jobs, and how one is executed |
//! | `job`, `task` | progress of one job, and what each kind does |
//! | `work` | threads of the computation, cancelling |
//! | `opening` | how the browser receives the address |
//! | `tickets` | addresses that open one file once |
//! | `cell`, `folder` | the study that is served; the folder of its files |
//! | `guard` | allowed requests, headers of every answer |
//! | `connections`, `stream` | number of connections, and which are closed |
//! | `body`, `error`, `reply` | reading of request bodies, reporting of errors, writing of answers |
//!
//! A file uses only those below it.
//!
//! Nothing is requested from outside this machine, and the page loads nothing from elsewhere.

mod answers;
mod api;
mod body;
mod cell;
mod connections;
mod error;
mod execute;
mod files;
mod folder;
mod guard;
mod job;
mod jobs;
mod openapi;
mod opening;
mod page;
mod queue;
mod reply;
mod server;
mod state;
mod stream;
mod study;
mod task;
mod tickets;
mod work;

pub use api::document as openapi_document;
pub use page::has_page;
pub use server::{Options, Server};
