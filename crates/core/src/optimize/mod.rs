//! Where should the part lie, how should the arm hold the tool, what path should the program say?
//!
//! - [`posture`]: turn of the tool and branch along a path.
//! - [`holes`]: the same at points that no path joins.
//! - [`placement`]: what a place of the part is worth.
//! - [`compensation`]: the path to be commanded so that the tool goes where it is drawn.
//! - [`nodes`]: the same by a few targets with straight moves between them.
//! - [`reversals`](fn@reversals): how often each joint turns back.
//!
//! `chain`: the cheapest way through columns of postures; `links`: what leads from one to the next; `heading`: which way joints
//! went there; `lattice`: what a picture shows of them; `smooth`: turns without steps; `sureness`: how sure
//! the cost of a place is.

mod chain;
pub mod compensation;
mod heading;
pub mod holes;
mod lattice;
mod links;
pub mod nodes;
pub mod placement;
pub mod posture;
mod reversals;
mod smooth;
mod sureness;

pub use compensation::{Compensated, Compensation, compensated, left_by};
pub use holes::{HolesFound, holes_held};
pub use lattice::Lattice;
pub use nodes::{Shares, fitted};
pub use placement::{PlacementEvaluation, Holding, Score, Placeable, PlacementObjective, ToolTurn, on_part};
pub use posture::{Component, Objective, PostureFound, PostureSearch, Spins, postures_along};
pub use reversals::reversals;
pub use sureness::RankBy;
