//! What a user writes: the study file, format 1.
//!
//! ```text
//! text -> Document -> StudyFile (schema checked, all mistakes reported) -> Study: analyses in SI, in base, checked
//! ```
//!
//! [`format`](mod@format) is the file as written; [`resolve`] checks it and resolves each analysis (`names`, `memory`),
//! its [`compliance`], its [`motion`], the [`positioner`] and the [`part_in_hand`]. `calibrated` is the calibrated arm; [`placement`] the permitted placements
//! of a part, [`experiment`] the measurements of a circle, [`circles`] circular tests for the backlash of joints;
//! [`slips`] finds values that are probably slips. [`search_postures`] searches spins and branches of a study without such a search.

pub mod circles;
pub mod compliance;
pub mod experiment;
pub mod format;
pub mod motion;
pub mod part_in_hand;
pub mod placement;
pub mod positioner;
pub mod resolve;
pub mod search_postures;
pub mod slips;

mod calibrated;
mod memory;
mod names;

use crate::analysis::Analysis;

/// The analyses of a study that were resolved.
#[derive(Clone, Copy)]
struct ResolvedAnalyses<'a> {
    /// In the order of the study.
    list: &'a [Analysis],
    /// Whether none is missing; the problems of a missing one are reported at its keys.
    complete: bool,
}
