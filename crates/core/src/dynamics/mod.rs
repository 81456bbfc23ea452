//! Dynamics: vibration of the arm and the cutter at the tool.
//!
//! Read in this order: [`mode`] (a mode of vibration at the tool), [`mod@receptance`] (displacement by a harmonic force, from modes), [`mod@release`] (a force that
//! stops at once), [`inertia`] (of the bodies that a drive or spring moves), [`mod@mass_matrix`] (of drives and springs), [`modes`] (from mass matrix and
//! compliances), [`modal_fit`] (from measured frequency response functions), [`coupling`] (holder and cutter as beams on a machine).
//!
//! Lengths in m, angles in rad, forces in N, masses in kg, angular frequencies in rad/s.

pub mod coupling;
pub mod inertia;
pub mod mass_matrix;
pub mod modal_fit;
pub mod mode;
pub mod modes;
pub mod receptance;
pub mod release;

pub use inertia::{CarriedInertia, Inertia};
pub use mass_matrix::{mass_matrix, over_joint_positions};
pub use mode::Mode;
pub use modes::{ArmMode, ArmModes, modes_of};
pub use receptance::{displacement, receptance};
pub use release::{Release, release};
