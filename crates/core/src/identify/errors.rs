//! Errors of predicted displacements: lengths of their differences from the measured ones over all tests.

use super::load_test::{LoadTest, Measured};

/// Errors of the displacements (m) over all tests that measured one: lengths of their residual vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Number of tests included.
    pub tests: usize,
    /// Mean length, m.
    pub mean: f64,
    /// Root mean square of the lengths, m.
    pub rms: f64,
    /// Greatest length, m.
    pub largest: f64,
    /// Mean length over the mean length of the measured displacements.
    pub relative: f64,
}

/// The errors of displacements, given one list of residuals per test; `None` where no test measured a displacement.
pub fn displacement_errors<'a>(
    tests: &[LoadTest],
    residuals: impl Iterator<Item = &'a Vec<f64>>,
) -> Option<Errors> {
    let mut errors = Errors {
        tests: 0,
        mean: 0.0,
        rms: 0.0,
        largest: 0.0,
        relative: 0.0,
    };
    let mut measured = 0.0;
    for (test, residuals) in tests.iter().zip(residuals) {
        let mut squares = [0.0; 2];
        let mut any = false;
        for (reading, residual) in test.readings.iter().zip(residuals) {
            if let Measured::Displacement(_) = reading.what {
                squares[0] += residual * residual;
                squares[1] += reading.value * reading.value;
                any = true;
            }
        }
        if any {
            let length = squares[0].sqrt();
            errors.tests += 1;
            errors.mean += length;
            errors.rms += squares[0];
            errors.largest = errors.largest.max(length);
            measured += squares[1].sqrt();
        }
    }
    if errors.tests == 0 {
        return None;
    }
    let count = errors.tests as f64;
    errors.relative = errors.mean / measured;
    errors.mean /= count;
    errors.rms = (errors.rms / count).sqrt();
    Some(errors)
}

#[cfg(test)]
mod tests {
    use super::super::load_test::Reading;
    use super::*;
    use crate::robot::chain::Axis;
    use crate::spatial::Wrench;
    use nalgebra::Vector3;

    fn test(readings: &[(Measured, f64)]) -> LoadTest {
        let reading = |(what, value): &(Measured, f64)| Reading {
            what: *what,
            value: *value,
            standard_uncertainty: 1e-5,
        };
        LoadTest {
            joints: vec![0.0],
            wrench: Wrench::from_force(Vector3::x()),
            force_point: Vector3::zeros(),
            measured_point: Vector3::zeros(),
            readings: readings.iter().map(reading).collect(),
        }
    }

    #[test]
    fn errors_are_lengths_over_all_tests_that_measured_a_displacement() {
        let (x, y) = (Measured::Displacement(Axis::X), Measured::Displacement(Axis::Y));
        let turn = Measured::Turn(0);
        let tests = [
            test(&[(x, 3e-3), (y, 4e-3)]),
            // A rotation is not a displacement, whatever its error.
            test(&[(turn, 9.0), (x, 5e-3)]),
            test(&[(turn, 1.0)]),
        ];
        let residuals = [vec![0.3e-3, -0.4e-3], vec![7.0, 1.2e-3], vec![4.0]];
        let errors = displacement_errors(&tests, residuals.iter()).unwrap();
        assert_eq!(errors.tests, 2);
        let expected = [
            0.85e-3,
            (0.5 * (0.25 + 1.44_f64)).sqrt() * 1e-3,
            1.2e-3,
            1.7 / 10.0,
        ];
        let found = [errors.mean, errors.rms, errors.largest, errors.relative];
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-12, "{errors:?}");
        }
        assert_eq!(displacement_errors(&tests[2..], residuals[2..].iter()), None);
        assert_eq!(displacement_errors(&[], residuals.iter()), None);
    }
}
