//! Meshes of every format: a published one, and broken ones.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod mutations;
mod samples;
#[path = "../samples_folder/mod.rs"]
mod samples_folder;
