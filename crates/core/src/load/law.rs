//! Cutting force per chip width as a function of the chip thickness, for all laws: `dF = f(h; k) db`, `cov f = (df/dk)
//! S (df/dk)^T`.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `f` | tangential, radial and axial force of an edge per width of its chip | N/m |
//! | `h`, `db` | thickness and width of the chip | m |
//! | `k`, `S` | parameters of the law, at most six, and their covariance | as the law has them |

use nalgebra::{Matrix6, SMatrix, Vector3, Vector6};

use super::kienzle::Kienzle;
use super::mechanistic::Mechanistic;

/// Thinnest chip at which a power law is differentiated, m: below the radius of an edge no law of a sharp edge is valid.
const LEAST_CHIP: f64 = 1e-6;

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
    /// The same for edges of this rake (rad): Kienzle's law depends on it, mechanistic coefficients are valid for their
    /// own tool.
    #[must_use]
    pub fn with_rake(self, gamma: f64) -> CuttingLaw {
        match self {
            CuttingLaw::Mechanistic(_) => self,
            CuttingLaw::Kienzle(law) => CuttingLaw::Kienzle(law.with_rake(gamma)),
        }
    }

    /// The same law with all forces multiplied by `factor`, and their uncertainties as they are.
    #[must_use]
    pub fn scaled(self, factor: f64) -> CuttingLaw {
        match self {
            CuttingLaw::Mechanistic(law) => CuttingLaw::Mechanistic(law.scaled(factor)),
            CuttingLaw::Kienzle(law) => CuttingLaw::Kienzle(law.scaled(factor)),
        }
    }

    /// Tangential, radial and axial force per chip width (N/m) at the thickness `h` (m, not negative).
    pub fn force(&self, h: f64) -> Vector3<f64> {
        match self {
            CuttingLaw::Mechanistic(law) => law.force(h),
            CuttingLaw::Kienzle(law) => law.force(h),
        }
    }

    /// Derivative of [`CuttingLaw::force`] by the thickness `h`, Pa; of Kienzle's law below 1 um that at 1 um.
    pub fn by_thickness(&self, h: f64) -> Vector3<f64> {
        match self {
            CuttingLaw::Mechanistic(law) => law.coefficients().fixed_rows::<3>(0).into_owned(),
            CuttingLaw::Kienzle(law) => law.by_thickness(h.max(LEAST_CHIP)),
        }
    }

    /// The same law with its parameters changed by `change`, in the order of [`CuttingLaw::covariance`]; a law that would not be
    /// valid stays as it is.
    #[must_use]
    pub fn changed(&self, change: &Vector6<f64>) -> CuttingLaw {
        match self {
            CuttingLaw::Mechanistic(law) => CuttingLaw::Mechanistic(law.changed(change)),
            CuttingLaw::Kienzle(law) => CuttingLaw::Kienzle(law.changed(change)),
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
    pub fn covariance(&self) -> Matrix6<f64> {
        match self {
            CuttingLaw::Mechanistic(law) => *law.covariance(),
            CuttingLaw::Kienzle(law) => law.covariance(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{Estimate, KienzleValues};

    fn both() -> [CuttingLaw; 2] {
        let shear = Vector3::new(631e6, 99e6, 273e6);
        let edge = Vector3::new(13e3, 10e3, 2.8e3);
        let linear = Mechanistic::new(shear, edge).unwrap();
        let exact = |value| Estimate {
            value,
            standard_uncertainty: 0.1 * value,
        };
        let power = Kienzle::new(KienzleValues {
            specific_force: exact(800e6),
            exponent: exact(0.25),
            radial_ratio: exact(0.4),
            axial_ratio: exact(0.1),
        });
        [
            CuttingLaw::Mechanistic(linear.with_relative_uncertainty(0.2).unwrap()),
            CuttingLaw::Kienzle(power.unwrap()),
        ]
    }

    #[test]
    fn a_thicker_chip_takes_more_force_in_the_same_proportions_where_no_edge_ploughs() {
        for law in both() {
            let sizes = [1e-6, 1e-5, 1e-4, 1e-3].map(|h| law.force(h).norm());
            assert!(sizes.windows(2).all(|pair| pair[0] < pair[1]), "{sizes:?}");
            let more = law.scaled(1.25).force(1e-4);
            assert!((more - law.force(1e-4) * 1.25).norm() < 1e-12 * more.norm());
        }
        let [_, power] = both();
        let ratios = |h: f64| power.force(h) / power.force(h).x;
        assert!((ratios(1e-5) - ratios(1e-3)).norm() < 1e-14);
        assert_eq!(ratios(1e-4), Vector3::new(1.0, 0.4, 0.1));
    }

    #[test]
    fn derivatives_by_the_parameters_are_those_of_the_law_inside_and_their_number_is_that_of_the_covariance()
    {
        let h = 7e-5;
        let [linear, power] = both();
        // Linear in its coefficients: by them times themselves is the force again.
        let CuttingLaw::Mechanistic(law) = linear else {
            unreachable!()
        };
        assert!((linear.derivatives(h) * law.coefficients() - linear.force(h)).norm() < 1e-9);
        // Of a power law by kc1 it is the force over kc1; two columns stay empty.
        let by = power.derivatives(h);
        assert!((by.column(0) * 800e6 - power.force(h)).norm() < 1e-9);
        assert_eq!(by.columns(4, 2).amax(), 0.0);
        for law in both() {
            let of_force = law.derivatives(h) * law.covariance() * law.derivatives(h).transpose();
            assert!(of_force.symmetric_eigenvalues().min() >= -1e-9 * of_force.trace());
            assert!(of_force[(0, 0)].sqrt() > 0.05 * law.force(h).x);
        }
    }

    #[test]
    fn rake_reduces_the_force_of_the_power_law_only_and_is_applied_once() {
        let [linear, power] = both();
        let rake = 12_f64.to_radians();
        assert_eq!(linear.with_rake(rake), linear);
        let keen = power.with_rake(rake);
        assert!((keen.force(1e-4) / power.force(1e-4).x - Vector3::new(0.88, 0.352, 0.088)).norm() < 1e-12);
        assert_eq!(keen.with_rake(rake), keen);
        assert_eq!(keen.with_rake(0.0), power);
    }
}
