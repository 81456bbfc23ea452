//! Tool paths: points, directions and cutting forces.
//!
//! [`program`]: the moves of a tool path program. [`sampler`]: those moves as points. [`shape`]: circles and lines on a
//! workpiece plane. [`sampled`]: the points of either. [`placing`] and [`track`]: position in the cell and turn of the
//! tool; [`spin_curve`]: a turn that changes along the path; `lean`: the tool leans from the programmed axis; `scallop`: what it leaves between passes. [`thinned`](mod@thinned): fewer points of a path. [`clock`]: time at each point; `passage`: how the ends of moves are passed. [`stock`], `sweep`, `pass`,
//! `strip` and [`engagement`]: engagement of the cutter; [`cutting`], [`drilled`]: its forces. [`remaining`],
//! [`stock_replay`]: distance of other bodies from the stock. [`feature`]: errors of
//! the circle, line, plane or hole produced. [`holes`]: single points.

pub mod clock;
pub mod cutting;
pub mod drilled;
pub mod engagement;
pub mod feature;
pub mod holes;
mod lean;
mod pass;
mod passage;
pub mod placing;
pub mod program;
pub mod remaining;
pub mod sampled;
pub mod sampler;
mod scallop;
pub mod shape;
pub mod spin_curve;
pub mod stock;
pub mod stock_replay;
mod strip;
mod sweep;
pub mod thinned;
pub mod track;

pub use crate::load::GreatestForce;
pub use clock::{Clock, NoTime, Speeds};
pub use cutting::{Cutting, CuttingForces, ForceSummary, NoForces, StockEngagement};
pub use drilled::Drill;
pub use engagement::{EngagementKind, PassEngagement};
pub use feature::{DeviatedPoint, FeatureErrors, FeatureKind, feature_errors};
pub use holes::{Hole, drilled_holes, path_of_holes};
pub use lean::{Lean, RoundedEnd};
pub use pass::Pass;
pub use passage::{MoveEnd, Passage};
pub use placing::{Placing, Spin};
pub use program::{Arc, Command, Course, DepthOfCut, GivenSpin, Move, Operation, Pace, Step};
pub use remaining::{BodyNearStock, NearestColumn, RemainingStock};
pub use sampled::{PathBuilder, PlacedCommand, Rapids, SampledPath, TooManyPoints};
pub use sampler::{PathPoint, Sampler, Sampling};
pub use scallop::scallop;
pub use shape::Shape;
pub use spin_curve::{NoSpinCurve, SpinCurve, SpinKnot};
pub use stock::{Stock, StockError};
pub use stock_replay::{CutStock, StockReplay};
pub use thinned::{Thinning, thinned};
pub use track::{LoadedStop, LoadedTrack, Parts, Stop, Track};
