//! The least value of a smooth function of few unknowns.
//!
//! Quasi-Newton steps with the update of Broyden, Fletcher, Goldfarb and Shanno, shortened until the function decreases in
//! proportion to its slope (Armijo). Source: Nocedal and Wright, Numerical Optimization, 2006, algorithms 3.1 and 6.1.

use nalgebra::{DMatrix, DVector};

/// Maximum number of steps.
const MOST_STEPS: usize = 100;
/// Slope at which the search ends.
const FLAT: f64 = 1e-4;
/// Longest step.
const LONGEST_STEP: f64 = 1.0;
/// Least decrease, as a fraction of what the slope promises.
const DECREASE: f64 = 1e-4;
/// Shortest fraction of a step.
const SHORTEST: f64 = 1e-8;

/// From `start`, the place of the least value found, with the value; `None` where the function has none at `start`.
pub(super) fn minimum(
    function: impl Fn(&DVector<f64>) -> Option<(f64, DVector<f64>)>,
    start: &DVector<f64>,
) -> Option<(DVector<f64>, f64)> {
    let mut at = start.clone();
    let (mut value, mut slope) = function(&at)?;
    let count = at.len();
    let mut inverse = DMatrix::identity(count, count);
    for _ in 0..MOST_STEPS {
        if slope.amax() < FLAT {
            break;
        }
        let mut step = -(&inverse * &slope);
        if step.dot(&slope) >= 0.0 {
            inverse = DMatrix::identity(count, count);
            step = -slope.clone();
        }
        step *= (LONGEST_STEP / step.norm()).min(1.0);
        let promised = step.dot(&slope);
        let mut part = 1.0;
        let next = loop {
            let there = &at + &step * part;
            let found = function(&there).filter(|(found, _)| *found <= value + DECREASE * part * promised);
            if let Some((found, slope)) = found {
                break Some((there, found, slope));
            }
            part *= 0.5;
            if part < SHORTEST {
                break None;
            }
        };
        let Some((there, found, new_slope)) = next else {
            break;
        };
        update(&mut inverse, &(&there - &at), &(&new_slope - &slope));
        (at, value, slope) = (there, found, new_slope);
    }
    Some((at, value))
}

/// The inverse of the matrix of second derivatives after the step `s` has changed the slope by `y`.
fn update(inverse: &mut DMatrix<f64>, s: &DVector<f64>, y: &DVector<f64>) {
    let curvature = s.dot(y);
    // Without curvature along the step the matrix would not stay positive definite.
    if curvature <= 1e-12 * s.norm() * y.norm() {
        return;
    }
    let identity = DMatrix::identity(s.len(), s.len());
    let left = identity - s * y.transpose() / curvature;
    *inverse = &left * &*inverse * left.transpose() + s * s.transpose() / curvature;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_minimum_of_rosenbrock() {
        let rosenbrock = |x: &DVector<f64>| {
            let [a, b] = [1.0 - x[0], x[1] - x[0] * x[0]];
            let slope = DVector::from_vec(vec![-2.0 * a - 400.0 * x[0] * b, 200.0 * b]);
            Some((a * a + 100.0 * b * b, slope))
        };
        let (at, value) = minimum(rosenbrock, &DVector::from_vec(vec![-1.2, 1.0])).unwrap();
        assert!((at - DVector::from_element(2, 1.0)).norm() < 1e-4 && value < 1e-9);
    }

    #[test]
    fn stays_where_the_function_has_values() {
        // Beyond 1 it has none: the least value is at the end.
        let bounded = |x: &DVector<f64>| (x[0] < 1.0).then(|| (-x[0], DVector::from_element(1, -1.0)));
        let (at, _) = minimum(bounded, &DVector::from_element(1, 0.0)).unwrap();
        assert!((at[0] - 1.0).abs() < 1e-6, "{at}");
        assert!(minimum(bounded, &DVector::from_element(1, 2.0)).is_none());
    }
}
