//! Limits of a motion.

/// Limits of one joint, rad (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLimits {
    /// Largest speed, rad/s (m/s); infinite where it is not known.
    pub speed: f64,
    /// Largest acceleration, rad/s^2 (m/s^2); infinite where it is not known.
    pub acceleration: f64,
}

/// Limits of a motion along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionLimits {
    /// Of each joint.
    pub joints: Vec<JointLimits>,
    /// Largest acceleration along the path, m/s^2; infinite where it is not known.
    pub acceleration: f64,
}

/// What limits the speed at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limiting {
    /// The programmed feed.
    Feed,
    /// The speed of a joint.
    JointSpeed(usize),
    /// The acceleration of a joint.
    JointAcceleration(usize),
    /// The acceleration along the path.
    PathAcceleration,
    /// A stop.
    Stop,
}
