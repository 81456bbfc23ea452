//! Where should the part lie, how should the arm hold the tool, what path should the program say?
//!
//! - [`posture`]: turn of the tool and branch along a path.
//!
//! `chain`: the cheapest way through columns of postures.

mod chain;
pub mod posture;

pub use posture::{Counts, Goal, Lattice, PostureFound, PostureSearch, Spins, postures_along};
