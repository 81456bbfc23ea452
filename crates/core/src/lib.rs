//! The mechanics of a machining robot: how far from the drawing will it cut, and why?
//!
//! Pure mathematics: no files, no clock, no printing, no randomness. SI units throughout (m, N, N m, rad, s).
//!
//! Read [`predict`] first: it is the whole idea in one function. Then, in the order in which a number comes
//! about: [`frame`] and [`spatial`] (poses, twists, wrenches), [`roundness`] (circles of measured points, which need no
//! robot), [`robot`] (chain, postures), [`compliance`],
//! [`load`], [`source`] (what moves the tool), [`workpiece`] and [`path`] (which points), [`kernel`] (many
//! points at once), [`map`] (planes, sections, volumes, the region within a tolerance),
//! [`optimize`] (the posture along a path), [`identify`] (the springs of an arm from load tests), [`calibrate`] (its
//! geometry from measured poses), [`measure`] (what circular tests and repeated poses show), [`budget`] (what the error of
//! a cut circle is made of).
//!
//! Symbols and conventions: `docs/notation.md`.

pub mod budget;
pub mod calibrate;
pub mod compliance;
pub mod frame;
pub mod identify;
pub mod kernel;
pub mod load;
pub mod map;
pub mod measure;
pub mod optimize;
pub mod path;
pub mod predict;
pub mod robot;
pub mod roundness;
pub mod source;
pub mod spatial;
pub mod watch;
pub mod workpiece;

/// Arms for tests, those of the integration tests: they name this crate as its users do.
#[cfg(test)]
extern crate self as armill_core;
#[cfg(test)]
#[path = "../tests/arms/mod.rs"]
mod arms;

/// The linear algebra that the public types are made of.
pub use nalgebra;
