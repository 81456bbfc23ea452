//! What did a measurement of the path show, unloaded or under load?
//!
//! In reading order: [`ballbar`] (circular tests: the radius along a circle, both ways round),
//! [`pose_accuracy`] (how near the arm comes to a commanded pose, and how alike), [`path_accuracy`] (the same of a path).

pub mod ballbar;
pub mod path_accuracy;
pub mod pose_accuracy;
