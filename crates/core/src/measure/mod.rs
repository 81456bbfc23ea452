//! Evaluation of measurements of the path, unloaded or under load.
//!
//! In reading order: [`ballbar`] (circular tests: the radius along a circle, both ways round),
//! [`pose_accuracy`] (accuracy and repeatability of poses), [`path_accuracy`] (the same of a path), [`passes`] (a record of several passes, divided at rests),
//! [`reflectors`] (poses of a body with three reflectors, and misreadings).

pub mod ballbar;
pub mod passes;
pub mod path_accuracy;
pub mod pose_accuracy;
pub mod reflectors;
