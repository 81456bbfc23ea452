//! The numbers that lanes compute with, and the instructions that do it. Lanes are points of a block in the kernel; in
//! the inverse kinematics they are the eight branches of one pose, or descents to it.
//!
//! In reading order: `real` (a number of one lane), `vector` (three of them), `angle` (arc tangent, sine and cosine),
//! `gram` (a damped normal matrix), `block` (planes of numbers, one value per point), `lanes` (a few numbers at once),
//! `backend` (the instruction set, chosen at run time).

mod angle;
mod backend;
mod block;
mod gram;
mod lanes;
mod real;
mod vector;

pub use backend::{Backend, Precision};
pub use real::{Float, Real};

pub(crate) use angle::{atan2, sin_cos};
pub(crate) use backend::Work;
pub(crate) use block::{BLOCK, Plane, Planes, fill, planes, put, vector};
pub(crate) use gram::Gram;
pub(crate) use lanes::{Eight, Lanes, put_in_lane, vector_in_lane};
pub(crate) use real::lanes_of;
#[cfg(test)]
pub(crate) use real::{Alone, Fused, Plain};
pub(crate) use vector::Vector;
