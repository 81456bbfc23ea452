//! Robot programs, run by a second interpreter of each language that shares no code with the crate `programs`.
//!
//! `replay` runs a program to a list of events. What it is made of: `source` (files and places), `words`, `value`
//! (statements), `pose` (orientations), `event`, `log`. The languages: `krl`, `rapid`, `inform`, `tp`, `urscript`,
//! `val3`. What is checked: `checks` (of the events of any program), `expect` (of short programs), `written` (what
//! armill writes), `cells` (holes, rails, data of the controller), `positioner` (a part on a turntable), `part_in_hand` (one that the robot holds),
//! `samples` (programs of other software).

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod cells;
mod checks;
mod event;
mod expect;
mod inform;
mod krl;
mod log;
mod part_in_hand;
mod pose;
mod positioner;
mod rapid;
mod replay;
mod samples;
mod source;
mod tp;
mod urscript;
mod val3;
mod value;
mod words;
mod written;
