//! `armill frf`: modes of a tool or an arm from measured frequency response functions (FRFs).
//!
//! ```text
//! files -> FRFs -> sets that share points -> modes of each set -> shape at the tip -> FrfModesAnswer, file of modal data, picture
//! ```
//!
//! [`axes`] (directions of the measured axes), [`question`] (settings, reading), [`fitted`] (modes of all sets), [`answer`](mod@answer) (the result as one JSON value), [`modal_file`](mod@modal_file) (for
//! `armill stability --modes`), [`mod@picture`].

pub mod answer;
pub mod axes;
pub mod fitted;
pub mod modal_file;
pub mod picture;
pub mod question;

pub use answer::{FrfModesAnswer, answer};
pub use axes::Axes;
pub use fitted::{Fitted, fit_all};
pub use modal_file::modal_file;
pub use picture::picture;
pub use question::{FrfQuestion, ReadFrfs, read};
