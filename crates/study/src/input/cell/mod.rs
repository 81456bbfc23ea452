//! The bodies of a cell: what is in the way of the arm, and what moves with it.
//!
//! [`tables`]: obstacles, bodies of the tool, the part, as written; `shape`: their shapes, with meshes read from files;
//! `links`: bodies of the robot; [`bodies`]: what the study gives to all analyses; [`placed`]: the cell of an analysis, with its tool
//! and the part on its plane.
//!
//! | body | frame of its coordinates |
//! |---|---|
//! | link | attachment of the robot file; of a URDF the link |
//! | `[[tool.body]]` | flange |
//! | `[[obstacle]]` | reference frame of the study |
//! | `[part]` | part: centre and axes of the plane |

pub mod bodies;
mod links;
pub mod placed;
mod shape;
pub mod tables;

pub use bodies::CellBodies;
pub use placed::AnalysisCell;
