//! Distance of the path that is followed from the one that is commanded.
//!
//! ```text
//! e_i = p(t) - P_i    at the time t with    (p(t) - P_i) . d_i = 0
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `P_i`, `d_i` | a commanded point and the direction of the path there | m, - |
//! | `p(t)` | the tip as it follows, straight between the points | m |
//! | `e_i` | distance of the path that is followed, across the direction | m |
//!
//! That the tip is late along the path is no error of the part: the same points are passed later.

use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

/// Points that a thread computes at once.
const AT_ONCE: usize = 1024;

/// Points nearer to each other than this have no direction, m.
const SAME: f64 = 1e-12;

/// Distance of the `followed` path from each commanded point, m; `followed[i]` is where the tip is when the command is at point i, at the time `times[i]`, s, which do not
/// fall. It is looked for up to `longest`, s, after the command; where the tip does not come by in that time, as where the path turns back, the error is the distance of its
/// nearest point.
///
/// # Panics
/// If the numbers of points differ.
pub fn contour_errors(
    commanded: &[Point3<f64>],
    followed: &[Point3<f64>],
    times: &[f64],
    longest: f64,
) -> Vec<Vector3<f64>> {
    assert!(
        commanded.len() == followed.len() && commanded.len() == times.len(),
        "a point and a time for a point"
    );
    let last = commanded.len().saturating_sub(1);
    let error = |index: usize| -> Vector3<f64> {
        let at = commanded[index];
        let [before, after] = [
            commanded[index.saturating_sub(1)],
            commanded[(index + 1).min(last)],
        ];
        // Where the path turns back, the direction of the way there.
        let direction = (after - before)
            .try_normalize(SAME)
            .or((at - before).try_normalize(SAME));
        let Some(direction) = direction else {
            return Vector3::zeros();
        };
        let mut before = followed[index] - at;
        let mut nearest = before;
        for passed in index..=last {
            let here = followed[passed] - at;
            let (behind, ahead) = (before.dot(&direction), here.dot(&direction));
            if ahead >= 0.0 {
                let part = if behind < 0.0 {
                    -behind / (ahead - behind)
                } else {
                    1.0
                };
                let across = before + (here - before) * part;
                return across - direction * across.dot(&direction);
            }
            if here.norm() < nearest.norm() {
                nearest = here;
            }
            if times[passed] > times[index] + longest {
                break;
            }
            before = here;
        }
        nearest
    };
    (0..commanded.len())
        .into_par_iter()
        .with_min_len(AT_ONCE)
        .map(error)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point every millisecond.
    fn times(count: u32) -> Vec<f64> {
        (0..count).map(|i| f64::from(i) * 1e-3).collect()
    }

    #[test]
    fn where_the_path_turns_back_the_tip_stays_behind() {
        // 30 mm forth and back, and the tip turns 2 mm before.
        let forth = |turn: f64| -> Vec<Point3<f64>> {
            (0..61)
                .map(|i| Point3::new(turn - (f64::from(i) * 1e-3 - 0.03).abs(), 0.0, 0.0))
                .collect()
        };
        let errors = contour_errors(&forth(0.03), &forth(0.028), &times(61), 0.01);
        assert!((errors[30].norm() - 0.002).abs() < 1e-12, "{}", errors[30]);
        assert!(errors[..28].iter().all(|error| error.norm() < 1e-12));
    }

    #[test]
    fn a_tip_that_is_late_on_a_line_is_on_it_and_on_a_circle_inside() {
        let line: Vec<Point3<f64>> = (0..100)
            .map(|i| Point3::new(f64::from(i) * 1e-3, 0.0, 0.0))
            .collect();
        let late: Vec<Point3<f64>> = line
            .iter()
            .map(|at| at - Vector3::new(0.0123, 0.0, 0.0))
            .collect();
        let errors = contour_errors(&line, &late, &times(100), 0.1);
        assert!(errors[..87].iter().all(|error| error.norm() < 1e-15));
        let circle = |radius: f64, late: f64| -> Vec<Point3<f64>> {
            let angles = (0..4000).map(|i| f64::from(i) * 1e-3 - late);
            angles
                .map(|phi| Point3::new(radius * phi.cos(), radius * phi.sin(), 0.0))
                .collect()
        };
        let commanded = circle(0.1, 0.0);
        for (index, error) in contour_errors(&commanded, &circle(0.099, 0.05), &times(4000), 0.1)
            .iter()
            .enumerate()
            .take(3900)
            .skip(1)
        {
            let inwards = -commanded[index].coords.normalize();
            assert!((error - inwards * 1e-3).norm() < 1e-7, "{index}: {error}");
        }
    }

    #[test]
    fn a_shifted_path_is_off_by_the_shift_across_it() {
        let line: Vec<Point3<f64>> = (0..50)
            .map(|i| Point3::new(f64::from(i) * 1e-3, 0.0, 0.0))
            .collect();
        let off: Vec<Point3<f64>> = line
            .iter()
            .map(|at| at + Vector3::new(0.0004, 0.002, -0.001))
            .collect();
        for error in contour_errors(&line, &off, &times(50), 0.1) {
            assert!(
                (error - Vector3::new(0.0, 0.002, -0.001)).norm() < 1e-15,
                "{error}"
            );
        }
    }
}
