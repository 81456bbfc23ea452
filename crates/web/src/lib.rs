//! The local server behind `armill serve`: the live page of one study, for the user of this machine alone.
//!
//! It holds no mechanics and no format: every answer is a value of `armill-study`, serialised as the command prints it.
//!
//! ```text
//! browser -> 127.0.0.1 -> guard (host, origin, token) -> handlers -> work (a thread of its own) -> armill-study
//! ```
//!
//! | file | question |
//! |---|---|
//! | `server` | how does it start, listen, and stop? |
//! | `connections`, `stream` | how many are connected, and which of them are given up? |
//! | `guard` | who may ask, and what does every answer carry? |
//! | `cell` | which study is it, and where do its files lie? |
//! | `body`, `error` | what of a request is read, and how is reported what is wrong? |
//! | `work` | where does computing happen, and who still waits for it? |
//! | `study`, `answers`, `jobs`, `files` | what does each path under `/api` do? |
//! | `job`, `task` | how far is one job, and what does each kind do? |
//! | `page` | what is served to look at? |
//! | `opening` | how does the browser learn the address? |
//! | `openapi` | how is all that told to a program? |
//!
//! Nothing outside this machine is requested anything, and the page loads nothing from elsewhere.

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
