//! How far predicted displacements lie from measured ones: lengths of their differences over all tests.

use super::load_test::{LoadTest, Measured};

/// Errors of the displacements (m) over all tests that measured one: lengths of their residual vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Tests that count.
    pub tests: usize,
    /// Mean length, m.
    pub mean: f64,
    /// Root mean square of the lengths, m.
    pub rms: f64,
    /// Greatest length, m.
    pub largest: f64,
    /// Mean length over the mean length of what was measured.
    pub relative: f64,
}

/// The errors of displacements, given one list of residuals a test; `None` where no test measured a displacement.
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
