//! Dynamics: vibration of the arm and the cutter at the tool.
//!
//! Read in this order: [`mode`] (a mode of vibration at the tool), [`receptance`] (displacement by a harmonic force, from modes).
//!
//! Lengths in m, angles in rad, forces in N, angular frequencies in rad/s.

pub mod mode;
pub mod receptance;

pub use mode::Mode;
pub use receptance::receptance;
