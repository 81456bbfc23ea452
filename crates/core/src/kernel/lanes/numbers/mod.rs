//! The numbers that lanes compute with, and the instructions that do it.
//!
//! In reading order: `real` (a number of one lane), `vector` (three of them), `angle` (arc tangent, sine and cosine),
//! `block` (planes of numbers, one value per point), `backend` (the instruction set, chosen at run time).

mod angle;
mod backend;
mod block;
mod real;
mod vector;

pub use backend::{Backend, Precision};
pub use real::{Float, Real};

pub(super) use angle::{atan2, sin_cos};
pub(super) use backend::Work;
pub(super) use block::{BLOCK, Plane, Planes, fill, planes, put, vector};
pub(super) use real::lanes_of;
#[cfg(test)]
pub(super) use real::{Alone, Fused, Plain};
pub(super) use vector::Vector;
