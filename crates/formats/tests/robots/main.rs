//! Robot files of every format: those of the makers, and broken ones.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod joints;
mod mutations;
mod samples;
#[path = "../samples_folder/mod.rs"]
mod samples_folder;
#[path = "../../../../validation/urdf-forward/tree.rs"]
mod tree;
