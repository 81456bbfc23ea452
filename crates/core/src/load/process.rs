//! A milling process: the force from cutter, law, cut, feed and spindle speed.
//!
//! ```text
//! rise = asin(feed . z)          c = c_f cos(rise),  c_z = c_f sin(rise)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | x, y, z | feed frame: along the feed, to its left, from part to spindle ([`crate::path::placing`]) | - |
//! | `rise` | angle of the feed to the plane across the tool axis, positive towards the spindle | rad |
//! | `c_f` | feed per tooth | m |
//!
//! A dive steeper than 30 deg is refused: the edges on the bottom cut then, and they are
//! not modelled; a straight plunge of a drill is [`super::drilling`]. The force acts at the TCP; the moment that the
//! spindle's torque causes, and the lever of the depth of cut, are neglected.

use nalgebra::{Unit, Vector3};

use super::cut::Cut;
use super::cutter::Cutter;
use super::engagement::{Engagement, feed_per_tooth};
use super::error::CuttingError;
use super::law::CuttingLaw;
use super::lean::LeanInCut;
use super::mean::MeanForce;
use super::milling::Milling;

/// The tool and its cutting data. Not checked until a force is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Process {
    /// The tool.
    pub cutter: Cutter,
    /// Force of a chip.
    pub law: CuttingLaw,
    /// Axial depth of cut, m.
    pub depth: f64,
    /// Engagement of the tool.
    pub engagement: Engagement,
    /// Feed speed, m/s.
    pub feed: f64,
    /// Spindle speed, rad/s; clockwise seen from the spindle.
    pub spindle: f64,
}

/// Which way a tool advances, against its own axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Advance {
    /// Across its axis.
    Level,
    /// Out of the plane across its axis by this angle (rad), positive towards the spindle, negative into the part.
    Ramp(f64),
    /// Along its axis into the part.
    Plunge,
    /// Along its axis away from the part.
    Withdrawal,
}

/// Force on the tool, feed frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CuttingForce {
    /// Mean over a revolution.
    pub mean: MeanForce,
    /// Greatest of a revolution, N.
    pub peak: Vector3<f64>,
}

/// Steepest dive, rad.
const STEEPEST_DIVE: f64 = std::f64::consts::FRAC_PI_6;
/// Sine of the rise below which a feed is treated as level: 1 nm in a metre, far below any path.
const LEVEL: f64 = 1e-9;
/// Part of the feed across the axis below which its direction there is not defined.
const ALONG_AXIS: f64 = 1e-6;
/// Steps of one period at which the peak is sought.
const PEAK_STEPS: u32 = 360;

impl Process {
    /// The cut that the tool makes when it advances so.
    ///
    /// # Errors
    /// Inputs outside what can be; a plunge, a withdrawal.
    pub fn milling(&self, advance: Advance) -> Result<Milling, CuttingError> {
        let rise = match advance {
            Advance::Level => 0.0,
            Advance::Ramp(rise) if rise.is_nan() => return Err(CuttingError::NotFinite("rise of the feed")),
            Advance::Ramp(rise) if rise >= -STEEPEST_DIVE => rise,
            Advance::Ramp(rise) => return Err(plunge(-rise)),
            Advance::Plunge => return Err(plunge(std::f64::consts::FRAC_PI_2)),
            Advance::Withdrawal => return Err(CuttingError::Withdrawal),
        };
        let per_tooth = feed_per_tooth(self.feed, self.spindle, self.cutter.flutes())?;
        let cut = Cut {
            depth: self.depth,
            engagement: self.engagement,
            feed: per_tooth * rise.cos(),
            rise: per_tooth * rise.sin(),
            lean: LeanInCut::default(),
        };
        Milling::new(self.cutter, self.law, cut)
    }

    /// The same with depth and edges of the engagement rounded to multiples of `part` of the diameter: cuts that are
    /// alike become one.
    #[must_use]
    pub fn rounded(&self, part: f64) -> Process {
        let diameter = self.cutter.diameter();
        let step = part * diameter;
        Process {
            depth: (self.depth / step).round().max(1.0) * step,
            engagement: self.engagement.rounded(step, diameter / 2.0),
            ..*self
        }
    }

    /// Mean and peak.
    ///
    /// # Errors
    /// As [`Process::milling`].
    pub fn force(&self, advance: Advance) -> Result<CuttingForce, CuttingError> {
        let milling = self.milling(advance)?;
        Ok(CuttingForce {
            mean: milling.mean(),
            peak: milling.peak(PEAK_STEPS),
        })
    }
}

fn plunge(dive: f64) -> CuttingError {
    CuttingError::Plunge {
        angle_deg: dive.to_degrees(),
        most_deg: STEEPEST_DIVE.to_degrees(),
    }
}

impl Advance {
    /// The advance of a tool that moves along `feed`, with the direction `spindle` from its tip; the same axes for
    /// both.
    pub fn of(feed: &Unit<Vector3<f64>>, spindle: &Unit<Vector3<f64>>) -> Advance {
        let up = feed.dot(spindle);
        let across = (feed.into_inner() - spindle.into_inner() * up).norm();
        if across < ALONG_AXIS {
            return if up < 0.0 {
                Advance::Plunge
            } else {
                Advance::Withdrawal
            };
        }
        if up.abs() < LEVEL {
            Advance::Level
        } else {
            Advance::Ramp(up.atan2(across))
        }
    }
}

#[cfg(test)]
mod tests;
