//! What is known of the damping of an arm.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `zeta` | damping ratio of every mode | - |
//! | `d_k` | viscous damping of drive k | N m s/rad (N s/m) |

/// Damping of the vibration of an arm.
#[derive(Clone, Debug, PartialEq)]
pub enum Damping {
    /// `zeta`: the same ratio for every mode.
    Ratio(f64),
    /// `d_k` by joint; zero of joints beyond the list. Springs are without damping.
    Joints(Vec<f64>),
}

/// A damping ratio is below this: at 1 nothing vibrates.
pub const CRITICAL: f64 = 1.0;

/// Greatest viscous damping of a joint, N m s/rad (N s/m).
pub const STRONGEST_DAMPER: f64 = 1e12;
