//! Circular tests of made-up machines: `machine` makes the runs from the geometry of its errors, not from the terms of the fit.
//! `parts`: the errors come back, within their uncertainties. `shown`: the quantities by hand, and what may not change them.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

mod machine;
mod parts;
mod shown;
