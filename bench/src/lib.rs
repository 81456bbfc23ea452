//! Benchmarks of armill and of other libraries for the same work; called by `cargo xtask bench`.
//!
//! Every candidate works on the same poses in one run, round after round in turn, so that disturbances of the machine
//! affect all equally. Absolute rates are not comparable across machines; ratios to [`yardstick`] are.
//!
//! Read in this order: [`workload`] (arm, poses, loads), [`work`] (the work at a pose), [`clock`] (timing),
//! [`yardstick`] (plain Rust with trigonometry), [`lanes`], [`armill`], [`kinds`], [`paths`], [`placements`],
//! [`clearance`], [`cells`], [`removal`], [`peers`], [`agreement`] (all compute the same), [`files`] (input of the Python and C++ peers).

pub mod agreement;
pub mod armill;
pub mod cells;
pub mod clearance;
pub mod clock;
pub mod files;
pub mod kinds;
pub mod lanes;
pub mod paths;
pub mod peers;
pub mod placements;
pub mod removal;
pub mod work;
pub mod workload;
pub mod yardstick;
