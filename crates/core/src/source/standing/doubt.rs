//! What is not known of load and tool, told as a displacement.
//!
//! Each unknown is taken off by its standard uncertainty, and the change of the displacement is its part: the numerical
//! form of the law of propagation (JCGM 100:2008, 5.1.3, note 2). It holds for every part of the model.

use nalgebra::{Point3, Vector3};

use super::Standing;
use crate::load::Doubt;
use crate::robot::forward::Frames;
use crate::source::Unstable;
use crate::spatial::Wrench;

/// Where an arm stands, and what it is loaded with there.
#[derive(Clone, Copy, Debug)]
pub struct AsItStands<'a> {
    /// Joint positions, rad (m).
    pub joints: &'a [f64],
    /// Its frames there.
    pub frames: &'a Frames,
    /// Tool centre point, m, base.
    pub tcp: Point3<f64>,
    /// Tool axis, unit, base.
    pub tool_axis: Vector3<f64>,
    /// On the tool at the TCP, base basis.
    pub wrench: &'a Wrench,
}

impl Standing<'_> {
    /// Variance (m^2) of the elastic displacement along the unit vector `along` that `doubt` makes. The arm stands as
    /// `standing` says, before and after; its last load is another one afterwards.
    ///
    /// # Errors
    /// [`Unstable`] where the arm finds no rest under a load that is off.
    pub fn variance_of_doubt(
        &mut self,
        doubt: &Doubt,
        standing: &AsItStands<'_>,
        along: &Vector3<f64>,
    ) -> Result<f64, Unstable> {
        let Wrench { force, moment } = *standing.wrench;
        let told = self.elastic(standing.wrench)?.linear.dot(along);
        let mut variance = 0.0;
        if doubt.relative > 0.0 {
            let off = *standing.wrench * (1.0 + doubt.relative);
            variance += (self.elastic(&off)?.linear.dot(along) - told).powi(2);
        }
        for u in doubt.forces.iter().filter(|u| **u != Vector3::zeros()) {
            let off = Wrench {
                force: force + u,
                moment,
            };
            variance += (self.elastic(&off)?.linear.dot(along) - told).powi(2);
        }
        if doubt.tool_length > 0.0 {
            let off = standing.tcp + standing.tool_axis * doubt.tool_length;
            self.stand_in(standing.joints, standing.frames, &off);
            let elsewhere = self.elastic(standing.wrench);
            self.stand_in(standing.joints, standing.frames, &standing.tcp);
            variance += (elsewhere?.linear.dot(along) - told).powi(2);
        }
        Ok(variance)
    }
}
