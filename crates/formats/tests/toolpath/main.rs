//! Tool paths: the guide's page of words, real cutter locations, our own G-code, and LinuxCNC's against its interpreter.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod apt;
mod gcode;
mod linuxcnc;
#[path = "../samples_folder/mod.rs"]
mod samples_folder;
mod words;
