//! Engagement of the cutter with the stock: angles, depth and width.
//!
//! The strip of material ahead is given as [`Engagement`]; its documentation defines the angles.
//!
//! Not modelled: the bottom of the cutter on a dive (except in the volume), teeth behind the axis, runout, trochoids.
//! Material on the way of a step longer than two pitches is included only in its volume. For a spindle that turns
//! counterclockwise left and right are exchanged: up-milling is down-milling.

use nalgebra::{Unit, Vector3};

use super::pass::Pass;
use super::stock::{Stock, StockError, checked_place};
use super::strip::{Heading, LEAST_HEIGHT, StripAhead, strip_ahead};
use crate::load::{EndMillBody, Engagement};

/// Kind of engagement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EngagementKind {
    /// No material ahead.
    Air,
    /// Material on one side, or a strip narrower than the cutter.
    Strip,
    /// Material over the whole width of the cutter, to a pitch.
    Slot,
    /// Down, steeper than along: the bottom cuts all round.
    Plunge,
}

/// Engagement of the cutter on one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassEngagement {
    /// Kind of engagement.
    pub kind: EngagementKind,
    /// The strip of material ahead, of several the one with the longest arc; `None` in air and in a plunge.
    ///
    /// A strip that reaches the rim of the cutter at the height of the material continues beyond it.
    pub strip: Option<Engagement>,
    /// Its width across the feed at the height of the material, m; of a plunge the diameter.
    pub width: f64,
    /// Largest depth along the tool axis, m; in a plunge the largest removed height.
    pub depth: f64,
    /// Volume removed by the step, m^3.
    pub volume: f64,
}

/// Largest tilt of a tool that is treated as upright, rad: it lifts the rim of a cutter of 10 mm by 5 um.
const UPRIGHT: f64 = 1e-3;

/// Angle of a tool from the path's z, rad; not a number where its direction is none.
fn tilt(axis: &Unit<Vector3<f64>>) -> f64 {
    axis.xy().norm().atan2(axis.z)
}

/// Whether a tool of this direction, from the tip towards the spindle, is treated as upright.
pub(super) fn is_upright(axis: &Unit<Vector3<f64>>) -> bool {
    tilt(axis) <= UPRIGHT
}

impl Stock {
    /// Engagement of the cutter on `pass`; removes the material.
    ///
    /// # Errors
    /// A tool that is tilted from the path's z, or a number that is not finite; no material is removed then.
    pub fn cut(&mut self, pass: &Pass, cutter: &EndMillBody) -> Result<PassEngagement, StockError> {
        checked_place("a point of the path", &pass.from)?;
        checked_place("a point of the path", &pass.to)?;
        if !pass.direction.iter().all(|value| value.is_finite()) {
            return Err(StockError::NotFinite("a direction of the path"));
        }
        if !is_upright(&pass.axis) {
            let angle_deg = tilt(&pass.axis).to_degrees();
            return Err(StockError::Tilted { angle_deg });
        }
        let heading = Heading::of(pass);
        let ahead = strip_ahead(self, &heading, cutter);
        let removal = self.remove(pass.from, pass.to, cutter);
        let (kind, strip, [width, depth]) = match ahead {
            _ if heading.dives() && removal.depth > LEAST_HEIGHT => {
                (EngagementKind::Plunge, None, [cutter.diameter(), removal.depth])
            }
            None => (EngagementKind::Air, None, [0.0; 2]),
            Some(StripAhead {
                strip,
                width,
                depth,
                is_slot,
            }) => {
                let kind = if is_slot {
                    EngagementKind::Slot
                } else {
                    EngagementKind::Strip
                };
                (kind, Some(strip), [width, depth])
            }
        };
        Ok(PassEngagement {
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
