//! Which points does the tool pass, and in which direction?
//!
//! [`shape`]: circles and lines on a workpiece plane. [`program`]: what a tool path program tells, move after move.
//! [`sampler`]: those moves as points. [`placing`]: where they lie in the cell and how the tool is turned.
//! [`stock`], `sweep`, `front` and [`bite`]: what the cutter meets on its way; [`cutting`], [`drilled`]: what that pushes with; [`clock`]: when. [`roundness`](mod@roundness) and
//! [`feature`]: the circle, line, plane or hole that comes out.

pub mod bite;
pub mod clock;
pub mod cutting;
pub mod drilled;
pub mod feature;
mod front;
pub mod placing;
pub mod program;
pub mod roundness;
pub mod sampler;
pub mod shape;
pub mod stock;
mod sweep;

pub use crate::load::Greatest;
pub use bite::{Bite, BiteKind, Pass};
pub use clock::{Clock, NoTime, Speeds};
pub use cutting::{Cutting, CuttingForces, ForcesTold, Met, NoForces};
pub use drilled::Drill;
pub use feature::{Became, FeatureKind, Strayed, became};
pub use placing::{Placing, Spin};
pub use program::{Arc, Course, DepthOfCut, Move, Operation, Pace, Step};
pub use roundness::{Roundness, roundness};
pub use sampler::{PathPoint, Sampler, Sampling};
pub use shape::{Sample, Shape};
pub use stock::{Stock, StockError};
