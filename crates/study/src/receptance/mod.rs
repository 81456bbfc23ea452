//! Receptance at the tip of a tool, from the modes of an arm and beams of holder and cutter.
//!
//! [`mod@machine`]: what the tool assembly is attached to; [`mod@evaluate`]: receptance over the frequencies and modes of the tip, by the core;
//! [`mod@answer`]: the values for people; [`mod@files`]: table, picture and file of modal data.
//!
//! ```text
//! robot + posture, or modal data of the nose | tool assembly | frequencies -> Question -> evaluate -> Evaluation -> ReceptanceAnswer, files
//! ```

pub mod answer;
pub mod evaluate;
pub mod files;
pub mod machine;

pub use answer::{ReceptanceAnswer, answer};
pub use evaluate::{Evaluation, Question, assembly_of, evaluate};
pub use files::{modal_file, picture, table};
pub use machine::{ArmAtNose, Machine};
