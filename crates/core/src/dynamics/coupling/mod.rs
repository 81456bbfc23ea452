//! Receptance coupling: a holder and a cutter, as beams, at the end of a machine of known receptance.
//!
//! Read in this order: [`section`] (material and cross section), [`joint`] (elastic connection), [`segment`] (a uniform beam), `bending` and
//! `rod` (from end to end), [`transfer`] (in all directions), [`tip`] (machine, joints and segments coupled: receptance at the tip), [`sweep`](mod@sweep) (at many
//! frequencies), [`tip_modes`](mod@tip_modes) (modes of the coupled tip, fitted) with `rank_one` (all shapes together).
//!
//! Theory: `docs/theory/receptance-coupling.md`.

mod bending;
pub mod joint;
mod rank_one;
mod rod;
pub mod section;
pub mod segment;
pub mod sweep;
pub mod tip;
pub mod tip_modes;
pub mod transfer;

pub use joint::Joint;
pub use section::{Material, Section};
pub use segment::{BeamTheory, Segment};
pub use sweep::{Frequencies, Swept, sweep};
pub use tip::{Base, Body, NotFinite, tip_receptance};
pub use tip_modes::{TipFit, tip_modes};

#[cfg(test)]
mod tests;
