//! Compliance at the tool, and the deviation of the tool under the load cases.
//!
//! In reading order: `flexibility` (compliance of one lane), `compliance` (the full matrix), `envelope` (the largest
//! in-plane deviation of all cases), `deviation` (each case, the largest, and its contributions).

mod compliance;
mod deviation;
mod envelope;
mod flexibility;

pub(super) use compliance::Compliances;
pub(super) use deviation::{OneCase, Shares, Worst};
pub(super) use envelope::{CASE, Largest, Rows};
pub(super) use flexibility::Flexibility;
