//! armill in a browser: the answers of the live page without a server, as a WebAssembly program.
//!
//! It contains no mechanics and no format: requests are those of `armill-api`, which `armill serve` answers too. It is built
//! for `wasm32-wasip1-threads`: files are those of a folder that the page gives it, [`FOLDER`]; the page is in `web/src/browser`.
//!
//! ```text
//! page -> worker -> exports (bytes of memory) -> session -> armill-api
//! ```
//!
//! | file | content |
//! |---|---|
//! | `exports` | the functions that the page calls |
//! | `session` | the study of the page, and its requests |
//! | `progress` | progress of a job, as lines on stdout |

mod exports;
mod progress;
mod session;

pub use session::{FOLDER, Reply, Session};
