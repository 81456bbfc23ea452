//! Stability of the cut of a study: lobes, limits of the depth, uncertainty, vibration under the teeth.
//!
//! [`arm_modes`](mod@arm_modes): modes of the arm at a point; [`given_cut`]: a cut without a study; [`question`]: the cut of a path and the modes, with options; [`evaluate`](mod@evaluate): all of it from the core; [`mod@answer`]: the values for
//! people, with the verdict; [`mod@picture`]: the lobes.
//!
//! ```text
//! study [cut] + modal data + spindle speed -> Question -> evaluate -> Evaluation -> StabilityAnswer, picture
//! ```

pub mod answer;
pub mod arm_modes;
pub mod evaluate;
pub mod given_cut;
pub mod picture;
pub mod question;

pub use answer::{StabilityAnswer, answer};
pub use arm_modes::ArmPosture;
pub use evaluate::{Evaluation, evaluate};
pub use given_cut::GivenCut;
pub use picture::picture;
pub use question::{GivenModes, Options, Question};

pub use crate::input::vibration::modes_of;
