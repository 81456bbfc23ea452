//! The server over real sockets on loopback: what it answers, and what it refuses.

mod client;
mod jobs;
mod refused;
mod study;
