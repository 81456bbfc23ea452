//! Postures from aims, their limits and screws; and poses from postures.
//!
//! In reading order: `closed_form` (postures without angles), `limits` (joint limits by cosines), `positions` (joint
//! positions, and limits by them), `screws`, `stance` (all of these for one posture per point), `forward` (tool pose
//! and screws from joint positions).

mod closed_form;
mod forward;
mod limits;
mod positions;
mod screws;
mod stance;

pub use closed_form::flag;

pub(super) use closed_form::{Links, Postures, Reach, Solve, Solved};
pub(super) use forward::{Forward, POSE, SCREWS};
pub(super) use limits::LimitsByCosines;
pub(super) use positions::{Counting, LimitsByPositions, Position, Positions};
pub(super) use screws::Screws;
pub(super) use stance::{FindStances, Preference, Stances};
