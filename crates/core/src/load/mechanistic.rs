//! Mechanistic cutting law: six coefficients, three for shearing the chip and three for the edge that ploughs.
//!
//! ```text
//! dFt = (Ktc h + Kte) db     dFr = (Krc h + Kre) db     dFa = (Kac h + Kae) db
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `h`, `db` | chip thickness, chip width along the profile of the tool | m |
//! | `Ktc`, `Krc`, `Kac` | shear coefficients: tangential, radial, axial | Pa |
//! | `Kte`, `Kre`, `Kae` | edge coefficients | N/m |
//!
//! 1 N/mm2 is 1e6 Pa, 1 N/mm is 1e3 N/m. The axial force is positive as a right-hand helix makes it: it lifts the chip
//! and draws the tool to the part. Coefficients belong to a tool as much as to a material: published sets of one alloy
//! differ by a factor of two, so their covariance is an input.
//!
//! Source: Altintas, Manufacturing Automation \[recalled\]; its shear terms match a published mean force, see
//! `validation/milling-mean-force`.

use nalgebra::{Matrix6, SMatrix, Vector3, Vector6};

use super::error::{CuttingError, checked};

/// Largest valid coefficient, Pa or N/m: a hundred times that of the hardest alloys.
const MOST_COEFFICIENT: f64 = 1e12;
/// A covariance may miss symmetry by this much of its largest entry: rounding of a file.
const ASYMMETRY: f64 = 1e-9;

/// Six coefficients and their uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mechanistic {
    /// Ktc, Krc, Kac, Pa; Kte, Kre, Kae, N/m.
    coefficients: Vector6<f64>,
    covariance: Matrix6<f64>,
}

impl Mechanistic {
    /// The law of these coefficients (tangential, radial, axial; Pa and N/m), without uncertainty.
    ///
    /// # Errors
    /// Numbers that are not finite or beyond any material.
    pub fn new(shear: Vector3<f64>, edge: Vector3<f64>) -> Result<Mechanistic, CuttingError> {
        for value in shear.iter().chain(edge.iter()) {
            let most = MOST_COEFFICIENT;
            checked("cutting coefficient", *value, [-most, most], "Pa or N/m")?;
        }
        Ok(Mechanistic {
            coefficients: Vector6::new(shear.x, shear.y, shear.z, edge.x, edge.y, edge.z),
            covariance: Matrix6::zeros(),
        })
    }

    /// The same with this covariance, in the order Ktc, Krc, Kac, Kte, Kre, Kae.
    ///
    /// Not checked: whether it is positive semidefinite beyond its variances.
    ///
    /// # Errors
    /// A matrix that is not finite, not symmetric, or has a negative variance.
    pub fn with_covariance(mut self, covariance: Matrix6<f64>) -> Result<Mechanistic, CuttingError> {
        let what = "the covariance of the cutting coefficients";
        if covariance.iter().any(|entry| !entry.is_finite()) {
            return Err(CuttingError::NotFinite(what));
        }
        let scaled = ASYMMETRY * covariance.amax();
        let asymmetric = (covariance - covariance.transpose()).amax() > scaled;
        if asymmetric || covariance.diagonal().iter().any(|variance| *variance < 0.0) {
            return Err(CuttingError::NoCovariance(what));
        }
        self.covariance = covariance;
        Ok(self)
    }

    /// The same with each coefficient unsure by this fraction of itself, independent of the others.
    ///
    /// # Errors
    /// A fraction that is negative or beyond ten.
    pub fn with_relative_uncertainty(self, fraction: f64) -> Result<Mechanistic, CuttingError> {
        checked("relative uncertainty", fraction, [0.0, 10.0], "")?;
        let deviation = self.coefficients * fraction;
        self.with_covariance(Matrix6::from_diagonal(&deviation.component_mul(&deviation)))
    }

    /// The same with all forces multiplied by `factor`.
    #[must_use]
    pub(super) fn scaled(mut self, factor: f64) -> Mechanistic {
        self.coefficients *= factor;
        self
    }

    /// The same with its coefficients changed by `change`, in their order.
    #[must_use]
    pub(super) fn changed(mut self, change: &Vector6<f64>) -> Mechanistic {
        self.coefficients += change;
        self
    }

    /// Ktc, Krc, Kac (Pa), Kte, Kre, Kae (N/m).
    pub fn coefficients(&self) -> &Vector6<f64> {
        &self.coefficients
    }

    /// Covariance of the coefficients, in their order.
    pub fn covariance(&self) -> &Matrix6<f64> {
        &self.covariance
    }

    /// Tangential, radial and axial force per chip width (N/m) at the thickness `h` (m, not negative).
    pub fn force(&self, h: f64) -> Vector3<f64> {
        let k = &self.coefficients;
        Vector3::new(k[0] * h + k[3], k[1] * h + k[4], k[2] * h + k[5])
    }

    /// Derivatives of [`Mechanistic::force`] by the coefficients, 3 x 6.
    pub(super) fn derivatives(h: f64) -> SMatrix<f64, 3, 6> {
        let mut by = SMatrix::<f64, 3, 6>::zeros();
        for row in 0..3 {
            by[(row, row)] = h;
            by[(row, row + 3)] = 1.0;
        }
        by
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some() -> Mechanistic {
        Mechanistic::new(Vector3::new(631e6, 99e6, 273e6), Vector3::new(13e3, 10e3, 2.8e3)).unwrap()
    }

    #[test]
    fn force_is_the_sum_of_its_derivatives() {
        let law = some();
        let by = Mechanistic::derivatives(1e-4);
        assert!((by * law.coefficients() - law.force(1e-4)).norm() < 1e-10);
        // 631 N/mm2 x 0.1 mm + 13 N/mm = 76.1 N/mm
        assert!((law.force(1e-4).x - 76.1e3).abs() < 1e-9);
    }

    #[test]
    fn refuses_a_matrix_that_is_not_a_covariance() {
        let mut skew = Matrix6::identity();
        skew[(0, 1)] = 0.5;
        assert!(some().with_covariance(skew).is_err());
        assert!(some().with_covariance(-Matrix6::identity()).is_err());
        assert!(some().with_covariance(Matrix6::from_element(f64::NAN)).is_err());
        assert!(some().with_covariance(Matrix6::identity()).is_ok());
        assert!(Mechanistic::new(Vector3::new(f64::NAN, 0.0, 0.0), Vector3::zeros()).is_err());
    }

    #[test]
    fn a_relative_uncertainty_is_one_of_each_coefficient() {
        let law = some().with_relative_uncertainty(0.1).unwrap();
        for (variance, k) in law.covariance().diagonal().iter().zip(law.coefficients().iter()) {
            assert!((variance.sqrt() - 0.1 * k).abs() < 1e-12 * k);
        }
    }
}
