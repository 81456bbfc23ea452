//! What a user writes: the study file, format 1.
//!
//! ```text
//! text -> Document -> StudyFile (schema checked, all mistakes reported) -> Study: analyses in SI, in base, checked
//! ```
//!
//! [`format`](mod@format) is the file as written; [`resolve`] checks it and resolves each analysis (`analysis`,
//! [`path`], [`holes`], `names`, `memory`), its [`quantities`] in SI, its [`compliance`] and [`stiffness`], and the
//! [`positioner`]. `calibrated` is the calibrated arm; [`posture_search`] is the
//! search for spin and branch along paths, [`placement`] the permitted placements of a part, [`experiment`] the
//! measurements of a circle, [`circles`] circular tests for the backlash of joints. `problem_log` reports problems at
//! their keys.

pub mod circles;
pub mod compliance;
pub mod experiment;
pub mod format;
pub mod holes;
pub mod path;
pub mod placement;
pub mod positioner;
pub mod posture_search;
pub mod quantities;
pub mod resolve;
pub mod stiffness;

pub(crate) mod analysis;
mod calibrated;
mod memory;
mod names;
mod problem_log;
