//! What a study file gives to any analysis, checked and in SI.
//!
//! [`tables`] the tables as written; [`problem_log`] reports problems at their keys; [`quantities`] lengths, planes and
//! loads in SI; [`stiffness`] the stiffness model; [`posture_search`] the search for spin and branch, [`freedoms`] what else it may choose; [`motion`] how the controller moves the arm; [`vibration`] what is asked of its modes; [`improvement`]
//! the least gain that counts; [`cell`] the bodies of the cell; [`memory`] the estimate of what the answers take; [`setting`] all of it for the points of an analysis.

pub mod cell;
pub mod freedoms;
pub mod improvement;
pub mod memory;
pub mod motion;
pub mod posture_search;
pub mod problem_log;
pub mod quantities;
pub mod setting;
pub mod stiffness;
pub mod tables;
pub mod vibration;
