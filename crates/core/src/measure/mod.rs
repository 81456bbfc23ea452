//! What did a measurement of the path show, unloaded or under load?
//!
//! In reading order: [`ballbar`] (circular tests: the radius along a circle, both ways round),
//! [`pose_accuracy`] (how near the arm comes to a commanded pose, and how alike).

pub mod ballbar;
pub mod pose_accuracy;
