//! Where should the part lie, how should the arm hold the tool, what path should the program say?
//!
//! - [`posture`]: turn of the tool and branch along a path.
//! - [`compensation`]: the path to be commanded so that the tool goes where it is drawn.
//! - [`reversals`](fn@reversals): how often each joint turns back.
//!
//! `chain`: the cheapest way through columns of postures.

mod chain;
pub mod compensation;
pub mod posture;
mod reversals;

pub use compensation::{Compensated, Compensation, compensated};
pub use posture::{Counts, Goal, Lattice, PostureFound, PostureSearch, Spins, postures_along};
pub use reversals::reversals;
