//! What the way along a path adds to the deviation at one of its points.

use crate::source::MotionDisplacement;

/// What the way along a path adds at one of its points.
#[derive(Clone, Copy, Debug, Default)]
pub struct OnPath<'a> {
    /// Offset of each link in its backlash as friction keeps it, rad (m), see [`BacklashGeometry`](crate::map::BacklashGeometry). Without it those
    /// are used that give the largest in-plane deviation, as in [`evaluate`](super::evaluate).
    pub link_offsets: Option<&'a [f64]>,
    /// Displacement by the motion; its parts are the last shares.
    pub motion: Option<MotionDisplacement>,
}

impl<'a> OnPath<'a> {
    /// Known offsets of the links in their backlash, rad (m), one per joint, and no motion.
    pub fn with_link_offsets(link_offsets: &'a [f64]) -> OnPath<'a> {
        OnPath {
            link_offsets: Some(link_offsets),
            motion: None,
        }
    }
}
