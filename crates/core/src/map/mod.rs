//! Deviation maps and path analyses: where the tolerance is met.
//!
//! [`plane`]: deviation over a plane; [`volume`]: in space; [`along`]: along a path; [`radial`]: radial deviation and
//! roundness of a circle; [`radial_parts`]: the part without load, and its uncertainty; [`backlash_geometry`]: effect
//! of backlash and geometry along a path; `worst`: the largest deviations of a path; `obstacles`: where the arm cannot
//! follow it; `spin_map`: the deviation over path and spin;
//! [`stock_clearance`]: clearance from the stock as it becomes while it is cut (`arm_near_stock`: of one posture); [`limits`]: permitted force and cut along a path (`point_limits`: at a point; `varied`: one cut with a
//! varied parameter; `vibrating`: what vibrates there), [`depth_by_feed`]: depth over feed; [`region`]: the part of a plane within the tolerance, its
//! area, boundary and inscribed shapes; [`certainty`]: its uncertainty.
//!
//! `inscribed`: inscribed shapes; `turns`: whole turns of joints along a path.

pub mod along;
mod arm_near_stock;
pub mod backlash_geometry;
pub mod certainty;
pub mod depth_by_feed;
mod inscribed;
pub mod limits;
mod obstacles;
pub mod plane;
mod point_limits;
pub mod radial;
pub mod radial_parts;
pub mod region;
mod spin_map;
pub mod stock_clearance;
mod turns;
mod varied;
mod vibrating;
pub mod volume;
mod worst;

pub(crate) use along::one_branch;
pub use along::{AlongPath, EquilibriumSummary, along_path, along_postures};
pub(crate) use arm_near_stock::ArmNearStock;
pub use backlash_geometry::BacklashGeometry;
pub use certainty::{COVERAGE, Certainty, probability_within};
pub use depth_by_feed::DepthByFeed;
pub use limits::{CutDemand, CutLimits, Permitted, ProgramLimits, program_limits};
pub use obstacles::{Obstacle, ObstacleKind, TurnsAlong, obstacles, turns_along};
pub use plane::{Counts, PlaneMap, plane_map};
pub use point_limits::{PermittedForces, PointLimits};
pub use radial::{RadialDeviation, radial_deviations};
pub use radial_parts::{WithoutLoad, radial_motion, radial_uncertainties, radial_without_load};
pub use region::{Region, region_within};
pub use spin_map::{MOST_EVALUATED, SpinCell, SpinMap, spin_map};
pub(crate) use stock_clearance::exclude_points_near_stock;
pub use stock_clearance::measure_stock_clearances;
pub use vibrating::Vibrating;
pub use volume::{BoxGrid, VolumeMap, volume_map};
pub use worst::worst_points;
