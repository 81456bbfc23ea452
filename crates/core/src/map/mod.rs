//! Where does the tolerance hold?
//!
//! [`plane`]: deviation over a plane; [`volume`]: in space; [`along`]: along a path; [`radial`]: what becomes of a circle,
//! [`radial_parts`]: without load, and how sure; [`unloaded`]: what moves the tool there beside its load; `worst` and `jumps`: where a path is worst, and where the arm jumps; [`limits`]: which force and cut a path permits
//! (`varied`: one cut, varied), [`depth_by_feed`]: over both; [`region`]: the part within a limit, its area, boundary and
//! what fits; [`certainty`]: how sure that is.
//!
//! `marching_squares`, `inscribed`: boundaries, and shapes inside them; `turns`: whole turns of joints along a path.

pub mod along;
pub mod certainty;
pub mod depth_by_feed;
mod inscribed;
mod jumps;
pub mod limits;
mod marching_squares;
pub mod plane;
pub mod radial;
pub mod radial_parts;
pub mod region;
mod turns;
pub mod unloaded;
mod varied;
pub mod volume;
mod worst;

pub use along::{AlongPath, Rested, along_path, along_postures};
pub use certainty::{COVERAGE, Certainty, probability_within};
pub use depth_by_feed::DepthByFeed;
pub use jumps::{Jump, jumps};
pub use limits::{CutLimits, Permitted, PermittedForces, PointLimits, ProgramLimits, program_limits};
pub use plane::{Counts, PlaneMap, plane_map};
pub use radial::{RadialDeviation, radial_deviations};
pub use radial_parts::{WithoutLoad, radial_doubts, radial_without_load};
pub use region::{Region, region_within};
pub use unloaded::Unloaded;
pub use volume::{BoxGrid, VolumeMap, volume_map};
pub use worst::worst_points;
