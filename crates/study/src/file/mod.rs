//! What a user writes: the study file, format 1.
//!
//! [`format`](mod@format) is the file as it stands; [`resolve`] checks it and works out what
//! each ask means, its [`quantities`] in SI and the [`compliance`] that it brings.
//!
//! Of one table each: `cut`, `drill`, `measured`, `positioner`, `program`, `stiffness`, `ask`. `names` and `memory`:
//! what two asks share; `places`: where a problem stands.

pub mod compliance;
pub mod cut;
pub mod drill;
pub mod format;
pub mod measured;
pub mod positioner;
pub mod program;
pub mod quantities;
pub mod resolve;
pub mod stiffness;

mod ask;
mod memory;
mod names;
mod places;
