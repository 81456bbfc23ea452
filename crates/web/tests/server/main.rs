//! The server over real sockets on loopback: what it answers, and what it refuses.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

mod client;
mod connections;
mod jobs;
mod refused;
mod study;
