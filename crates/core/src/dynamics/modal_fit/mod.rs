//! Modal parameters from measured frequency response functions (FRFs).
//!
//! Read in this order: [`frf`] (a measured FRF as receptance), `denominator` (poles of one order: least squares in the frequency domain with a
//! common denominator), `stable` (poles that remain over the orders), `model` (receptance of given poles; residues by linear least squares), `refine`
//! (poles by nonlinear least squares), `selection` (how many modes the FRFs determine), `residual_search` (weak modes in what is left over), [`fit`](mod@fit) (all together, with standard
//! uncertainties), `complexity` (how far the modes are from real ones), [`shape`] (shape normalised by mass in the measured directions).
//!
//! Theory: `docs/theory/modal-parameters.md`.

mod complexity;
mod denominator;
pub mod fit;
pub mod frf;
mod model;
mod refine;
mod residual_search;
mod selection;
pub mod shape;
mod stable;

pub use fit::{FitError, FitOptions, FittedFrf, FittedMode, ModalFit, fit};
pub use frf::{Dof, Frf};
pub use shape::{MeasuredShape, NoShape, connected, shape_of};

#[cfg(test)]
mod tests;
