//! Optimisation: placement of the part, posture along the path, compensation of the commanded path.
//!
//! - [`posture`]: spin and lean of the tool, external axes and branch along a path.
//! - [`holes`]: the same at single points (holes).
//! - [`placement`]: score of a placement of the part; `tool_turn`: how the tool turns with it; `free_path`: a quick score where it leans.
//! - [`compensation`]: the commanded path for which the tool follows the nominal path.
//! - [`nodes`]: the same with few targets and straight moves between them.
//! - [`gain`](fn@gain): decrease of an objective by a change, with its uncertainty; [`sensitivity`](fn@sensitivity): the same
//!   of two robots.
//! - [`reversals`](fn@reversals): number of reversals of each joint.
//!
//! Of the search along a path, in reading order: `steps`, `freedoms` and `posture_search`: what may be chosen, and what was; `window`: the settings that are
//! tried at a point; `grid`: which are neighbours; `ground_spin`: spins where a positioner turns the part; `column_at`: their postures; `clear_of_stock`: those too near to the stock; `links`: transitions between neighbouring
//! points; `heading`: directions of the joints; `winding`: their whole turns; `chain`: the chain of postures with the
//! lowest cost; `walk`: one pass along the path; `refined`: one after the other; `smooth`: settings without steps; `lost`: what that loses;
//! `lattice`: data for pictures. `rank_by`: uncertainty of the cost of a placement.

mod chain;
mod clear_of_stock;
mod column_at;
pub mod compensation;
mod free_path;
mod freedoms;
mod gain;
mod grid;
mod ground_spin;
mod heading;
pub mod holes;
mod lattice;
mod links;
mod lost;
pub mod nodes;
pub mod placement;
pub mod posture;
mod posture_search;
mod rank_by;
mod refined;
mod reversals;
mod sensitivity;
mod smooth;
mod steps;
mod tool_turn;
mod walk;
mod winding;
mod window;

pub use compensation::{Compensated, Compensation, compensated, compensated_along, residual_of};
pub use free_path::FreePath;
pub use freedoms::{LeanRange, MOST_MOVING, MovingAxis};
pub use gain::{FollowedTrack, Gain, LeastGain, gain, gain_along};
pub use holes::{HolesFound, hole_postures};
pub use lattice::Lattice;
pub use nodes::{Shares, fitted};
pub use placement::{Placeable, PlacementEvaluation, PlacementObjective, PostureSelection, Score, on_part};
pub use posture::{postures_along, postures_in_stock};
pub use posture_search::{Component, Objective, PostureFound, PostureSearch, SearchedPath};
pub use rank_by::RankBy;
pub use reversals::reversals;
pub use sensitivity::{InputKind, Sensitivity, SharedInputs, sensitivity};
pub use steps::Steps;
pub use tool_turn::ToolTurn;
