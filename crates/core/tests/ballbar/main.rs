//! Circular tests of made-up machines: `machine` makes the runs from the geometry of its errors, not from the terms of the fit.
//! `joints`: gaps of the joints of an arm. `parts`: the errors come back, within their uncertainties. `shown`: the quantities by hand, and what may not change them.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../arms/mod.rs"]
mod arms;
mod joints;
mod machine;
mod parts;
mod shown;
