//! G-code programs: those of LinuxCNC against its own interpreter, and our own.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod programs;
mod samples;
