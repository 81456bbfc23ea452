//! The prediction, from the study file to the answer.
//!
//! A study file is read and checked ([`file`](mod@file), with the measurements that it names, [`measured`]), its
//! analyses are run ([`run`]), compared with a measurement ([`budget`]), answered as one JSON value ([`answer`]), and
//! written as tables, pictures and a report ([`output`]; [`finished`] stores results for later requests). [`pose`]
//! evaluates a single pose ([`pose_answer`]), [`stability`] the stability of a cut, [`pendant`] compares a robot file with the display of its pendant, [`live`] answers the
//! queries of a page that shows a study while it is edited, [`program_out`] writes a path as a robot program. The robot
//! library and the example studies are embedded in the program ([`library`]); [`compliance_class`] assumes joint
//! compliances if none are known. [`robots`] and [`studies`] find what a user names, [`robot_answers`] and
//! [`materials`] report what is known of a robot or material, [`enclosed_links`] encloses its links by capsules, [`estimated_links`] estimates their masses, [`mod@new`] creates a study. [`joint_order`], [`joint_unit`],
//! [`number`] and [`uncertainty_words`] format numbers, [`naming`] and [`file_names`] names.
//!
//! Command line, Python and web return the same bytes.

pub mod analysis;
pub mod answer;
pub mod body_answers;
pub mod budget;
pub mod compliance_class;
pub mod enclosed_links;
pub mod error;
pub mod estimated_links;
pub mod exported_robot;
pub mod file;
pub mod file_names;
pub mod finished;
pub mod input;
pub mod joint_order;
pub mod joint_unit;
pub mod library;
pub mod link_meshes;
pub mod live;
pub mod materials;
pub mod measured;
pub mod model_words;
pub mod modes;
pub mod naming;
pub mod new;
pub mod number;
pub mod output;
pub mod pendant;
pub mod pose;
pub mod pose_answer;
pub mod program_out;
pub mod receptance;
pub mod robot_answers;
pub mod robots;
pub mod run;
pub mod stability;
pub mod structure_answers;
pub mod studies;
pub mod uncertainty_words;

pub use compliance_class::ComplianceClass;
pub use error::{ErrorKind, StudyError};
pub use file::resolve::Study;
pub use naming::{BASE_LINK, base_from_reference, branch_choice_of};

/// Joints required for any pose of a tool.
pub const ENOUGH_JOINTS: usize = 6;
