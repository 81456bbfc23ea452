//! Derivatives of samples at uneven times: least-squares parabolas over a window of time.
//!
//! ```text
//! x(t_i + u) = c0 + c1 u + c2 u^2,  |u| <= h        dx/dt = c1,  d2x/dt2 = 2 c2
//! ```
//!
//! A window has five samples at least. Source: Savitzky and Golay 1964, here for uneven times.

use std::ops::Range;

use armill_core::nalgebra::{Matrix3, Vector3};

/// Fewest samples of a window.
const FEWEST: usize = 5;

/// The weights of all windows of a log.
#[derive(Clone, Debug)]
pub(super) struct Differentiator {
    windows: Vec<Range<usize>>,
    values: Vec<Vec<f64>>,
    slopes: Vec<Vec<f64>>,
    curvatures: Vec<Vec<f64>>,
}

impl Differentiator {
    /// For samples at these times, s, which rise, and half of the window, s.
    pub(super) fn new(times: &[f64], half: f64) -> Differentiator {
        let count = times.len();
        let mut found = Differentiator {
            windows: Vec::with_capacity(count),
            values: Vec::with_capacity(count),
            slopes: Vec::with_capacity(count),
            curvatures: Vec::with_capacity(count),
        };
        for at in times {
            let mut first = times.partition_point(|time| *time < at - half);
            let mut end = times.partition_point(|time| *time <= at + half);
            while end - first < FEWEST.min(count) {
                first = first.saturating_sub(1);
                end = (end + 1).min(count);
            }
            let window = &times[first..end];
            let widest = window.iter().map(|time| (time - at).abs()).fold(half, f64::max);
            let row = |time: &f64| {
                let u = (time - at) / widest;
                Vector3::new(1.0, u, u * u)
            };
            let normal = window
                .iter()
                .map(row)
                .map(|row| row * row.transpose())
                .sum::<Matrix3<f64>>();
            let inverse = normal.try_inverse().unwrap_or_else(Matrix3::zeros);
            let weights: Vec<Vector3<f64>> = window.iter().map(|time| inverse * row(time)).collect();
            found.windows.push(first..end);
            found.values.push(weights.iter().map(|w| w.x).collect());
            found.slopes.push(weights.iter().map(|w| w.y / widest).collect());
            found
                .curvatures
                .push(weights.iter().map(|w| 2.0 * w.z / (widest * widest)).collect());
        }
        found
    }

    /// The parabolas themselves at their instants: smoothed values.
    pub(super) fn values(&self, values: &[f64], columns: usize) -> Vec<f64> {
        self.apply(&self.values, values, columns)
    }

    /// First derivatives of `values`, `columns` of them a sample, sample after sample.
    pub(super) fn slopes(&self, values: &[f64], columns: usize) -> Vec<f64> {
        self.apply(&self.slopes, values, columns)
    }

    /// Second derivatives.
    pub(super) fn curvatures(&self, values: &[f64], columns: usize) -> Vec<f64> {
        self.apply(&self.curvatures, values, columns)
    }

    fn apply(&self, weights: &[Vec<f64>], values: &[f64], columns: usize) -> Vec<f64> {
        let mut found = vec![0.0; values.len()];
        for (index, (window, weights)) in self.windows.iter().zip(weights).enumerate() {
            for (sample, weight) in window.clone().zip(weights) {
                for column in 0..columns {
                    found[index * columns + column] += weight * values[sample * columns + column];
                }
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_of_a_parabola_are_exact_at_uneven_times() {
        let times: Vec<f64> = (0..60)
            .map(|i| f64::from(i) * 0.004 + 0.001 * f64::from(i % 3))
            .collect();
        let values: Vec<f64> = times
            .iter()
            .flat_map(|t| [1.0 + 3.0 * t - 2.0 * t * t, 5.0])
            .collect();
        let by = Differentiator::new(&times, 0.014);
        let (slopes, curvatures) = (by.slopes(&values, 2), by.curvatures(&values, 2));
        let smoothed = by.values(&values, 2);
        for (index, t) in times.iter().enumerate() {
            assert!((slopes[2 * index] - (3.0 - 4.0 * t)).abs() < 1e-9);
            assert!((curvatures[2 * index] + 4.0).abs() < 1e-6);
            assert!(slopes[2 * index + 1].abs() < 1e-9);
            assert!((smoothed[2 * index] - values[2 * index]).abs() < 1e-9);
        }
    }

    #[test]
    fn few_samples_do_not_stop_it() {
        for count in 1..5 {
            let times: Vec<f64> = (0..count).map(f64::from).collect();
            let by = Differentiator::new(&times, 0.01);
            assert!(by.slopes(&times, 1).iter().all(|slope| slope.is_finite()));
        }
    }
}
