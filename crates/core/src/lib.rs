//! The mechanics of a machining robot: prediction of its machining errors.
//!
//! Pure mathematics: no files, no clock, no printing, no randomness. SI units throughout (m, N, N m, rad, s).
//!
//! Read [`predict`] first: it is the main idea in one function. Then, in the order of the computation:
//! [`frame`] and [`spatial`] (poses, twists, wrenches), `statistics` (medians), [`roundness`] (circles of measured points, without a
//! robot), [`marching_squares`] (level lines and areas on a grid), [`robot`] (chain, postures), [`compliance`],
//! [`dynamics`] (vibration), [`load`], [`stability`] (of a cut against chatter), [`source`] (sources of the deviation), [`workpiece`] and [`path`] (points), [`removal`] (the part that is left of the stock), [`motion`] (speed, time, rounded corners), [`kernel`] (many
//! points at once), [`sampling`] (samples of uncertain inputs), [`map`] (planes, sections, volumes, the region within a tolerance), [`machined`] (the part as it comes out),
//! [`optimize`] (the posture along a path), `least_squares`, [`form`] (form, size and location of measured features), [`identify`] (joint compliances from load tests), [`calibrate`] (geometry
//! from measured poses), [`learn`] (what calibration leaves), [`update`] (all measurements of an arm at once), [`measure`] (circular tests and repeated poses), [`budget`] (the error budget of
//! a milled circle), [`torsion`] (of a driven joint, from both encoders and the torque), [`motor_torque`] (friction and load from the torque of the motor).
//!
//! Symbols and conventions: `docs/notation.md`.

pub mod budget;
pub mod calibrate;
pub mod clearance;
pub mod compliance;
pub mod dynamics;
pub mod form;
pub mod frame;
pub mod identify;
pub mod kernel;
pub mod learn;
pub(crate) mod least_squares;
pub mod load;
pub mod machined;
pub mod map;
pub mod marching_squares;
pub mod measure;
pub mod motion;
pub mod motor_torque;
pub(crate) mod numbers;
pub mod optimize;
pub mod path;
pub mod predict;
pub mod removal;
pub mod robot;
pub mod roundness;
pub mod sampling;
pub mod source;
pub mod spatial;
pub mod stability;
pub(crate) mod statistics;
pub mod torsion;
pub mod units;
pub mod update;
pub mod watch;
pub mod workpiece;

/// Arms for tests, shared with the integration tests, which use this crate by its public name.
#[cfg(test)]
extern crate self as armill_core;
#[cfg(test)]
#[path = "../tests/arms/mod.rs"]
mod arms;

/// The linear algebra of the public types.
pub use nalgebra;
