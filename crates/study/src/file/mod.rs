//! What a user writes: the study file, format 1.
//!
//! ```text
//! text -> Document -> StudyFile (schema walked, all slips told) -> Study: asks in SI, in base, checked
//! ```
//!
//! [`format`](mod@format) is the file as it stands; [`resolve`] checks it and works out what each ask means (`analysis`,
//! [`path`], [`holes`], `names`, `memory`), its [`quantities`] in SI, the [`compliance`] and [`stiffness`] that it brings, and the
//! [`positioner`]; `actual` the arm as it was measured; `other_robot` puts another robot in place of its own; [`posture_search`] the turns of the tool that are tried
//! along paths, [`placement`] where a part may lie, [`experiment`] what was measured on a circle, [`circles`] circular tests for the backlash of joints; `places` tells problems where they stand.

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

mod calibrated;
pub(crate) mod analysis;
mod memory;
mod names;
pub(crate) mod other_robot;
mod places;
