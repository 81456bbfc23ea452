//! Motors: the inertia of a rotor behind the gear of its joint.
//!
//! ```text
//! J_k = I N^2
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `I` | inertia of the rotor about its axis, brake and input shaft included | kg m^2 |
//! | `N` | turns of the rotor per turn of the joint (rad/m of a prismatic joint) | 1 (rad/m) |
//! | `J_k` | its inertia at the joint, which other programs call armature | kg m^2 (kg) |
//!
//! The mass of the motor and its inertia about other axes belong to the body that carries it. Neglected: the gyroscopic effect of
//! the rotor, and the other joints that turn it through couplings. Source: Featherstone, Rigid body dynamics algorithms, 9.6 (recalled).

/// The rotor of a motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Index of its joint.
    pub joint: usize,
    /// `I`, kg m^2.
    pub rotor_inertia: f64,
    /// `N`.
    pub ratio: f64,
}

impl Motor {
    /// `J_k`: the inertia at the joint, kg m^2 (kg).
    pub fn inertia_at_joint(&self) -> f64 {
        self.rotor_inertia * self.ratio * self.ratio
    }
}

/// Greatest inertia of a rotor at its joint, kg m^2 (kg).
pub const HEAVIEST_ROTOR: f64 = 1e9;
