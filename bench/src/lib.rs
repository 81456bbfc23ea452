//! How fast is armill, and how fast are others at the same work? `cargo xtask bench` asks.
//!
//! Every candidate works on the same poses in one run, round after round in turn, so that what disturbs the
//! machine disturbs all alike. Absolute rates mean nothing across machines; ratios to [`yardstick`] do.
//!
//! Read in this order: [`workload`] (arm, poses, loads), [`work`] (what is done at a pose), [`clock`] (how it is
//! timed), [`yardstick`] (plain Rust with trigonometry), [`lanes`], [`armill`], [`kinds`], [`paths`], [`placements`], [`peers`], [`agreement`] (all compute the
//! same), [`files`] (what the Python and C++ peers read).

pub mod agreement;
pub mod armill;
pub mod clock;
pub mod files;
pub mod kinds;
pub mod lanes;
pub mod paths;
pub mod placements;
pub mod peers;
pub mod work;
pub mod workload;
pub mod yardstick;
