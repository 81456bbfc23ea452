//! What the cutter bites into: where round it the teeth meet material, how deep, how wide.
//!
//! The strip of material ahead is told as [`Engagement`] has it; its page has the angles.
//!
//! Not modelled: the bottom of the cutter on a dive (but in the volume), teeth behind the axis, runout, trochoids. What a
//! step longer than two pitches met on its way is in its volume alone. For a spindle that turns counterclockwise left is
//! right: up-milling is down-milling.

use nalgebra::{Point3, Unit, Vector3};

use super::front::{Front, Heading, LEAST_HEIGHT, front};
use super::stock::{Stock, StockError, checked_place};
use crate::load::{EndMillBody, Engagement};

/// A straight step of a cut: a rapid would cut as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pass {
    /// Where the tip was before, m, frame of the path; `to` itself where a cut begins.
    pub from: Point3<f64>,
    /// Where it goes, m.
    pub to: Point3<f64>,
    /// Where it is going when it arrives.
    pub direction: Unit<Vector3<f64>>,
    /// The tool, from the tip towards the spindle.
    pub axis: Unit<Vector3<f64>>,
}

/// How the cutter meets the material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EngagementKind {
    /// Nothing ahead.
    Air,
    /// Material on one side, or a strip narrower than the cutter.
    Strip,
    /// Material over the whole width of the cutter, to a pitch.
    Slot,
    /// Down, steeper than along: the bottom cuts all round.
    Plunge,
}

/// What the cutter bites into at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bite {
    /// How it meets the material.
    pub kind: EngagementKind,
    /// The strip of material ahead, of several the one that is met over the longest arc; `None` in the air and of a plunge.
    ///
    /// What reaches the rim of the cutter at the height of the material goes on beyond it.
    pub strip: Option<Engagement>,
    /// Its width across the feed at the height of the material, m; of a plunge the diameter.
    pub width: f64,
    /// Depth along the tool axis where it is largest, m; of a plunge what the step takes off where it takes most.
    pub depth: f64,
    /// Taken away by the step, m^3.
    pub volume: f64,
}

/// How far a tool may lean and pass for upright, rad: it lifts the rim of a cutter of 10 mm by 5 um.
const UPRIGHT: f64 = 1e-3;

impl Stock {
    /// What the cutter bites into on `pass`, which takes it away.
    ///
    /// # Errors
    /// A tool that leans from the path's z, a number that is not finite; nothing is taken away then.
    pub fn cut(&mut self, pass: &Pass, cutter: &EndMillBody) -> Result<Bite, StockError> {
        checked_place("a point of the path", &pass.from)?;
        checked_place("a point of the path", &pass.to)?;
        if !pass.direction.iter().all(|value| value.is_finite()) {
            return Err(StockError::NotFinite("a direction of the path"));
        }
        let lean = pass.axis.xy().norm().atan2(pass.axis.z);
        if lean.is_nan() || lean > UPRIGHT {
            let angle_deg = lean.to_degrees();
            return Err(StockError::Tilted { angle_deg });
        }
        let heading = Heading::of(pass);
        let ahead = front(self, &heading, cutter);
        let removal = self.remove(pass.from, pass.to, cutter);
        let (kind, strip, [width, depth]) = match ahead {
            _ if heading.dives() && removal.depth > LEAST_HEIGHT => {
                (EngagementKind::Plunge, None, [cutter.diameter(), removal.depth])
            }
            None => (EngagementKind::Air, None, [0.0; 2]),
            Some(Front {
                strip,
                width,
                depth,
                is_slot,
            }) => {
                let kind = if is_slot { EngagementKind::Slot } else { EngagementKind::Strip };
                (kind, Some(strip), [width, depth])
            }
        };
        Ok(Bite {
            kind,
            strip,
            width,
            depth,
            volume: removal.volume,
        })
    }
}

#[cfg(test)]
mod tests;
