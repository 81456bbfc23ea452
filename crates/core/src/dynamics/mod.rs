//! Dynamics: vibration of the arm and the cutter at the tool.
//!
//! Read in this order: [`mode`] (a mode of vibration at the tool), [`receptance`](mod@receptance) (displacement by a harmonic force, from modes),
//! [`release`](mod@release) (a force that stops at once).
//!
//! Lengths in m, angles in rad, forces in N, angular frequencies in rad/s.

pub mod mode;
pub mod receptance;
pub mod release;

pub use mode::Mode;
pub use receptance::receptance;
pub use release::{Release, release};
