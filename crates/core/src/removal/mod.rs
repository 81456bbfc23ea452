//! Material removal: the part that a tool leaves of its stock.
//!
//! Read in this order: [`tool_solid`] (convex solids of revolution), `conic` and `torus` (slices of them), `swept` (the part of a line
//! inside of a moving tool).

mod conic;
mod swept;
pub mod tool_solid;
mod torus;

pub use tool_solid::ToolSolid;
