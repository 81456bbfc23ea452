//! The server over real sockets on loopback: what it answers, and what it refuses.

// Tests and their helper functions fail by a panic.
#![allow(clippy::unwrap_used, clippy::panic)]

mod bodies;
mod client;
mod connections;
mod jobs;
mod refused;
mod study;
mod tickets;
mod token;
