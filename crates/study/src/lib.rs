//! What a user asks of armill, from the file to the answer.
//!
//! A study file is read and checked ([`file`](mod@file)), its asks are run ([`run`]), answered as one JSON value
//! ([`answer`]), and written as tables, pictures and a report ([`output`]; [`finished`] keeps what came out until it is asked
//! for); [`compare`] puts several side by side. [`pose`]
//! answers for a single pose, [`pendant`] compares a robot file with what its pendant shows, [`forces`] reads measured forces,
//! [`roundness`] measured profiles, [`ballbar`] circular tests, [`backlash`] what these tell of the joints of an arm, [`pose_accuracy`] and [`calibrate`] measured poses, [`path_accuracy`]
//! measured paths,
//! [`budget`] puts what was measured beside what is predicted,
//! [`place`] finds where a part may lie best, [`advise`] what to do about a path, [`live`] tells a page what it shows of a
//! study while it is being written.
//! The robot library and the example studies travel inside the program ([`library`]); [`compliance_class`] assumes
//! joint compliances from it where none are known. [`robots`] and [`studies`] find what a user names,
//! [`robot_answers`] and [`materials`] tell what is known of one, [`mod@new`] begins a study. [`joint_unit`] and
//! [`number`] are how numbers are told.
//!
//! Everything here is the same whatever the surface: command, Python and web return these bytes.

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

/// Joints that hold a tool at any pose.
pub const ENOUGH_JOINTS: usize = 6;
