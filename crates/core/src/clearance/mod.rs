//! Clearance: how near the arm and its tool come to what is in the way, and to themselves.
//!
//! Read in this order: [`nearest`] (segments and triangles, in closed form), [`convex`] (boxes and cylinders), [`bounds`] (lower
//! bounds), [`enclosing`] (capsules around points), [`mesh`], [`shape`] (two shapes of any kind), [`field`] (many capsules against bodies that stand still),
//! `decided` (whether a distance is kept), [`floor`] (a plane),
//! [`cell`] (all bodies of a cell), [`state`] (with the arm in a posture), [`pairs`] (which are checked), [`demanded`] (the check of a
//! posture), [`swept`] (a joint move), [`along`] (many postures near each other). [`solid`] estimates masses from the bodies of links.
//!
//! Distances are exact but for rounding, well below a micrometre. They are those of the bodies as given: a capsule around a link
//! is larger than the link.

pub mod along;
pub mod bounds;
pub mod cell;
pub mod convex;
mod decided;
pub mod demanded;
pub mod enclosing;
pub mod field;
pub mod floor;
pub mod mesh;
pub mod nearest;
pub mod pairs;
pub mod shape;
pub mod solid;
pub mod state;
pub mod swept;

pub use along::ClearanceAlong;
pub use bounds::{Bounds, Capsule};
pub use cell::{ArmBody, Cell, Clearance, FixedBody, PlacedCell, Role};
pub use demanded::{ClearanceCheck, Conflict, DemandedClearance};
pub use floor::Floor;
pub use mesh::{Mesh, MeshPoint};
pub use nearest::{Nearest, Segment, Triangle};
pub use shape::Shape;
pub use state::CellState;
