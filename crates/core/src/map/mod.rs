//! Where does the tolerance hold?
//!
//! [`plane`]: deviation over a plane; [`volume`]: in space; [`along`]: along a path on a plane, with radial
//! deviation and roundness on a circle; [`program`]: along a tool path program; [`limits`]: which force and cut it permits; [`depth_by_feed`]: over both;
//! [`region`]: the part within a limit, its area, boundary and what fits;
//! [`certainty`]: how sure that is.

pub mod along;
pub mod certainty;
pub mod depth_by_feed;
mod inscribed;
pub mod limits;
mod marching_squares;
pub mod plane;
pub mod program;
pub mod region;
mod turns;
mod varied;
pub mod volume;

pub use along::{PathAnswer, RadialDeviation, along_path};
pub use certainty::{COVERAGE, Certainty, probability_within};
pub use depth_by_feed::DepthByFeed;
pub use limits::{CutLimits, Permitted, PermittedForces, PointLimits, ProgramLimits, program_limits};
pub use plane::{Counts, PlaneMap, plane_map};
pub use program::{Parts, ProgramAnswer, Rested, Track, along_program};
pub use region::{Region, region_within};
pub use volume::{BoxGrid, VolumeMap, volume_map};
