//! Compliance at the tool, and the deviation of the tool under the load cases.
//!
//! In reading order: `flexibility` (compliance of one lane), `compliance` (the full matrix), `envelope` (the largest
//! in-plane deviation of all cases), `worst` (the largest so far), `deviation` (each case, and the contributions to the
//! largest).

mod compliance;
mod deviation;
mod envelope;
mod flexibility;
mod worst;

pub(super) use compliance::Compliances;
pub(super) use deviation::{OneCase, Shares};
pub(super) use envelope::{CASE, Largest, Rows};
pub(super) use flexibility::Flexibility;
pub(super) use worst::{CaseLanes, Worst};
