//! The tasks of armill, from the file to the answer.
//!
//! A study file is read and checked ([`file`](mod@file)), its analyses are run ([`run`]), answered as one JSON value
//! ([`answer`]), and written as tables, pictures and a report ([`output`]; [`finished`] stores results for later
//! requests). [`compare`] compares several studies or robots. [`pose`] evaluates a single pose, [`pendant`] compares a
//! robot file with the display of its pendant, [`forces`] reads measured forces, [`roundness`] measured profiles,
//! [`ballbar`] circular tests, [`backlash`] estimates the backlash of joints from them, [`pose_accuracy`] and
//! [`calibrate`] use measured poses, [`path_accuracy`] measured paths, [`budget`] compares a measurement with its
//! prediction, [`place`] searches the best placement of a part, [`advise`] recommends measures for a path, [`live`]
//! answers the queries of a page that shows a study while it is edited. The robot library and the example studies are
//! embedded in the program ([`library`]); [`compliance_class`] assumes joint compliances if none are known. [`robots`]
//! and [`studies`] find what a user names, [`robot_answers`] and [`materials`] report what is known of a robot or
//! material, [`mod@new`] creates a study. [`joint_unit`] and [`number`] format numbers.
//!
//! Command line, Python and web return the same bytes.

pub mod advise;
pub mod answer;
pub mod backlash;
pub mod ballbar;
pub mod budget;
pub mod calibrate;
pub mod compare;
pub mod compensate;
pub mod compliance_class;
pub mod error;
pub mod file;
pub mod finished;
pub mod forces;
pub mod identify;
pub mod in_place;
pub mod joint_unit;
pub mod library;
pub mod live;
pub mod materials;
pub mod model_words;
mod naming;
pub mod new;
pub mod number;
pub mod output;
pub mod path_accuracy;
pub mod pendant;
pub mod place;
pub mod pose;
pub mod pose_accuracy;
pub mod program_out;
pub mod robot_answers;
pub mod robots;
pub mod roundness;
pub mod run;
pub mod studies;

pub use compliance_class::ComplianceClass;
pub use error::{ErrorKind, StudyError};
pub use file::resolve::Study;
pub use naming::{BASE_LINK, base_from_reference, branch_choice_of};

/// Joints required for any pose of a tool.
pub const ENOUGH_JOINTS: usize = 6;
