//! Circular tests of simulated machines: `machine` computes the runs from the geometry of its errors, not from the
//! terms of the fit. `joints`: backlash of the joints of an arm. `parts`: the errors are recovered within their
//! uncertainties. `shown`: the quantities by hand, and invariances.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../arms/mod.rs"]
mod arms;
mod joints;
mod machine;
mod parts;
mod shown;
