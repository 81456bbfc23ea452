//! The part as it comes out: the stock cut by the tool where it will be, and the deviation of its surface.
//!
//! Read in this order: [`tip`] (displacement and rotation of the tool at each point of a path, by all sources), [`moves`] (the moves of the tool, as
//! programmed or displaced), [`faces`] (what made a surface, and its normals), [`surface`] (deviation normal to the nominal surface), `nearest` (the distance of a point from the surface of a part),
//! [`volumes`] (material left and removed too much), [`worst`] (the worst places, each from another part of the surface), [`directions`] (in which a displacement of the tool shows).
//!
//! ```text
//! path + deviations -> moves -> removal -> part
//! path              -> moves -> removal -> nominal part, or the one of a mesh       part, nominal part -> deviation of the surface
//! ```
//!
//! The nominal part and the part have the same raster, so their surfaces are compared along each dexel.

pub mod directions;
pub mod faces;
pub mod moves;
mod nearest;
pub mod surface;
pub mod tip;
pub mod volumes;
pub mod worst;

pub use directions::surface_directions;
pub use faces::{CutBy, MadePart};
pub use moves::{MachiningPath, PathTool, Stage};
pub use surface::{PartComparison, PointDeviation, SearchReach, SurfaceComparison, SurfaceDeviation};
pub use tip::{FollowedPath, TipDeviation};
pub use volumes::{MaterialDifference, material_difference};
pub use worst::worst_places;
