//! How much force a chip of some thickness takes, by whichever law.

use nalgebra::{Matrix6, SMatrix, Vector3};

use super::kienzle::Kienzle;
use super::mechanistic::Mechanistic;

/// Force of an edge over the thickness of its chip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "a law is copied once a cut; a box would cost more than its covariance"
)]
pub enum CuttingLaw {
    /// Linear in the chip, with a force of the edge.
    Mechanistic(Mechanistic),
    /// A power of the chip.
    Kienzle(Kienzle),
}

impl CuttingLaw {
    /// The same for edges of this rake (rad): Kienzle's law turns with it, mechanistic sets hold for their own tool.
    #[must_use]
    pub fn with_rake(self, gamma: f64) -> CuttingLaw {
        match self {
            CuttingLaw::Mechanistic(_) => self,
            CuttingLaw::Kienzle(law) => CuttingLaw::Kienzle(law.with_rake(gamma)),
        }
    }

    /// Tangential, radial and axial force per chip width (N/m) at the thickness `h` (m, not negative).
    pub fn force(&self, h: f64) -> Vector3<f64> {
        match self {
            CuttingLaw::Mechanistic(law) => law.force(h),
            CuttingLaw::Kienzle(law) => law.force(h),
        }
    }

    /// Derivatives of [`CuttingLaw::force`] by the parameters of the law, at most six.
    pub(super) fn derivatives(&self, h: f64) -> SMatrix<f64, 3, 6> {
        match self {
            CuttingLaw::Mechanistic(_) => Mechanistic::derivatives(h),
            CuttingLaw::Kienzle(law) => law.derivatives(h),
        }
    }

    /// Covariance of these parameters.
    pub(super) fn covariance(&self) -> Matrix6<f64> {
        match self {
            CuttingLaw::Mechanistic(law) => *law.covariance(),
            CuttingLaw::Kienzle(law) => law.covariance(),
        }
    }
}
