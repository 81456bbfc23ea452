//! The bodies of a cell: what is in the way of the arm, and what moves with it.
//!
//! [`tables`]: obstacles, bodies of the tool, the part, as written; `shape`: their shapes, with meshes read from files;
//! `links`: bodies of the robot; [`bodies`]: what the study gives to all analyses; [`analysis_cell`]: the cell of an analysis,
//! and [`placed`]: how it is made, with its tool and the part on its plane.
//!
//! | body | frame of its coordinates |
//! |---|---|
//! | link | attachment of the robot file; of a URDF the link |
//! | `[[tool.body]]` | flange |
//! | `[[obstacle]]` | reference frame of the study |
//! | `[part]` | part: centre and axes of the plane |

pub mod analysis_cell;
pub mod bodies;
mod links;
pub mod placed;
mod shape;
pub mod tables;

pub use analysis_cell::AnalysisCell;
pub use bodies::CellBodies;
