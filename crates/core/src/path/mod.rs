//! Which points does the tool pass, and in which direction?
//!
//! [`program`]: what a tool path program tells, move after move. [`sampler`]: those moves as points. [`shape`]: circles and
//! lines on a workpiece plane. [`sampled`]: the points of either. [`placing`] and [`track`]: where they lie in the cell and
//! how the tool is turned. [`thinned`](mod@thinned): fewer points of a path. [`clock`]: when the tip is where. [`stock`], `sweep`, `front` and [`bite`]: what the cutter meets
//! on its way; [`cutting`], [`drilled`]: what that pushes with. [`feature`]: the circle, line, plane or hole that comes
//! out. [`holes`]: points that no path joins.

pub mod engagement;
pub mod clock;
pub mod cutting;
pub mod drilled;
pub mod feature;
mod front;
pub mod holes;
pub mod placing;
pub mod program;
pub mod sampled;
pub mod sampler;
pub mod shape;
pub mod stock;
mod sweep;
pub mod thinned;
pub mod track;

pub use crate::load::Greatest;
pub use engagement::{Bite, EngagementKind, Pass};
pub use clock::{Clock, NoTime, Speeds};
pub use cutting::{Cutting, CuttingForces, ForcesTold, Met, NoForces};
pub use drilled::Drill;
pub use feature::{Became, FeatureKind, Strayed, became};
pub use holes::{Hole, drilled_holes, path_of_holes};
pub use placing::{Placing, Spin};
pub use program::{Arc, Course, DepthOfCut, Move, Operation, Pace, Step, ToldSpin};
pub use sampled::{PathBuilder, SampledPath, TooManyPoints};
pub use sampler::{PathPoint, Sampler, Sampling};
pub use shape::Shape;
pub use stock::{Stock, StockError};
pub use thinned::{Thinning, thinned};
pub use track::{LoadedStop, Parts, Stop, Track};
