//! What vibrates at a point of a program: the modes at the tip, and the speed of the spindle.
//!
//! ```text
//! b(cut) > a                  stable: its limit of the depth is deeper than its depth
//! d = max |u - mean u|        largest distance across the tool of the tip from its mean position, in a period of the teeth
//! ```
//!
//! The limit is that of mean directional factors ([`crate::stability::lobes`]), the vibration the linear response to the force of the
//! rigid cut ([`crate::stability::forced`]). SI units. Theory: `docs/theory/stability.md`.

use crate::dynamics::Mode;
use crate::load::Milling;
use crate::stability::{CutOfAnyDepth, Forced, StabilityLobes};

/// Modes at the tip, and the speed of the spindle.
#[derive(Clone, Debug, PartialEq)]
pub struct Vibrating {
    /// Modes of arm and tool; their shapes in the feed frame.
    pub modes: Vec<Mode>,
    /// rad/s
    pub spindle: f64,
}

impl Vibrating {
    /// Whether this cut is stable; not if it is no cut.
    pub fn is_stable(&self, milling: &Milling) -> bool {
        let depth = milling.cut().depth;
        let lobes = StabilityLobes::new(&self.modes, &CutOfAnyDepth::new(milling), depth);
        let limit = lobes.map(|lobes| lobes.at_speed(self.spindle));
        limit.is_ok_and(|limit| limit.is_none_or(|limit| limit.depth > depth))
    }

    /// Largest distance across the tool of the tip from its mean position, m; `None` if it is no cut.
    pub fn amplitude(&self, milling: &Milling) -> Option<f64> {
        let forced = Forced::new(&self.modes, milling, self.spindle).ok()?;
        Some(forced.largest_in_plane())
    }
}
