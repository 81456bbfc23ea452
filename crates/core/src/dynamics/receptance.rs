//! Receptance at the tool: twist by a harmonic wrench.
//!
//! ```text
//! G(w) = sum of phi phi^T / (omega^2 - w^2 + 2 i zeta omega w)
//! ```
//!
//! Symbols as in [`super::mode`]; `w` is the angular frequency of the wrench, rad/s. At `w = 0` it is the compliance of the modes.

use nalgebra::{Complex, Matrix6, Vector3};

use super::mode::Mode;

/// Receptance of these modes at the angular frequency `w` (rad/s): 6x6, m/N, rad/N, m/(N m) and rad/(N m), symmetric.
pub fn receptance(modes: &[Mode], w: f64) -> Matrix6<Complex<f64>> {
    let mut sum = Matrix6::zeros();
    for mode in modes {
        let omega = mode.angular_frequency;
        let dynamic = Complex::new(omega * omega - w * w, 2.0 * mode.damping_ratio * omega * w).inv();
        let outer = mode.shape * mode.shape.transpose();
        sum += outer.map(|part| dynamic * part);
    }
    sum
}

/// Translation of the tool (m) by a harmonic force on it (N) at the angular frequency `w` (rad/s): `G(w) f`.
pub fn displacement(modes: &[Mode], w: f64, force: &Vector3<Complex<f64>>) -> Vector3<Complex<f64>> {
    let mut sum = Vector3::zeros();
    for mode in modes {
        let omega = mode.angular_frequency;
        let dynamic = Complex::new(omega * omega - w * w, 2.0 * mode.damping_ratio * omega * w).inv();
        let phi: Vector3<f64> = mode.shape.fixed_rows::<3>(0).into();
        let modal = force.x * phi.x + force.y * phi.y + force.z * phi.z;
        sum += phi.map(|part| dynamic * modal * part);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;

    #[test]
    fn at_zero_it_is_the_compliance_and_at_resonance_the_quality_times_it() {
        let shape = Vector6::new(0.1, 0.2, -0.3, 0.01, 0.0, 0.5);
        let mode = Mode {
            angular_frequency: 60.0,
            damping_ratio: 0.02,
            shape,
        };
        let still = shape * shape.transpose() / 3600.0;
        let at_zero = receptance(&[mode], 0.0);
        assert!((at_zero.map(|z| z.re) - still).norm() < 1e-15);
        assert!(at_zero.map(|z| z.im).norm() < 1e-15);
        let at_resonance = receptance(&[mode], 60.0);
        assert!((at_resonance.map(Complex::norm) - still.abs() / 0.04).norm() < 1e-12);
        assert!(at_resonance[(1, 1)].im < 0.0, "the displacement is late");
    }

    #[test]
    fn the_displacement_is_the_receptance_times_the_force() {
        let mode = |w: f64, shape: [f64; 6]| Mode {
            angular_frequency: w,
            damping_ratio: 0.05,
            shape: Vector6::from(shape),
        };
        let modes = [
            mode(60.0, [0.1, 0.2, -0.3, 0.01, 0.0, 0.5]),
            mode(300.0, [-0.2, 0.4, 0.1, 0.3, 0.2, 0.1]),
        ];
        let force = Vector3::new(
            Complex::new(3.0, -1.0),
            Complex::new(0.5, 2.0),
            Complex::new(-4.0, 0.1),
        );
        for w in [0.0, 59.0, 1000.0] {
            let expected = receptance(&modes, w).fixed_view::<3, 3>(0, 0) * force;
            let found = displacement(&modes, w, &force);
            assert!(
                (found - expected).norm() < 1e-13 * expected.norm(),
                "{found} {expected}"
            );
        }
    }
}
