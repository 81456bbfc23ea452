//! The bodies of a cell: what is in the way of the arm, and what moves with it.
//!
//! [`tables`]: obstacles, bodies of the tool, the part, as written; `shape`: their shapes, with meshes read from files;
//! [`links`]: bodies of the robot; [`named_shape`]: a body with its position; [`carried`]: what carries the arm or rides with it; [`bodies`]: what the study gives to all analyses; [`analysis_cell`]: the cell of an analysis,
//! and [`placed`]: how it is made, with its tool and the part on its plane; [`permanent`]: what no posture avoids.
//!
//! | body | frame of its coordinates |
//! |---|---|
//! | link | attachment of the robot file; of a URDF the link |
//! | `[[tool.body]]` | flange; with a part in the hand the mount of the tool |
//! | `[[obstacle]]`, `[pedestal]`, `[floor]` | reference frame of the study, joints in front of the arm at 0; `base_link` with a part in the hand |
//! | `[part]` | part: centre and axes of the plane |

pub mod analysis_cell;
pub mod bodies;
pub mod carried;
pub mod links;
pub mod named_shape;
pub mod permanent;
pub mod placed;
pub(crate) mod shape;
pub mod tables;

pub use analysis_cell::AnalysisCell;
pub use bodies::CellBodies;
