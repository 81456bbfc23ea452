//! Which points does the tool pass, and in which direction?
//!
//! [`shape`]: circles and lines on a workpiece plane. [`program`]: what a tool path program tells, move after move.
//! [`sampler`]: those moves as points. [`roundness`](mod@roundness): the circle that comes out.

pub mod program;
pub mod roundness;
pub mod sampler;
pub mod shape;

pub use program::{Arc, Course, Engagement, Move, Operation, Pace, Program, Step};
pub use roundness::{Roundness, roundness};
pub use sampler::{PathPoint, Sampler, Sampling};
pub use shape::{Sample, Shape};
