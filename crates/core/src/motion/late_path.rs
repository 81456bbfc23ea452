//! The path that joints follow late, and its distance from the commanded one.

use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use super::contour::contour_errors;
use super::lag::Lag;
use super::rounded::Rounded;

/// How long after its command a joint is looked for, relative to its lag: `e^-8` of a step remain then.
const LONGEST: f64 = 8.0;

/// Points that a thread computes at once.
const AT_ONCE: usize = 1024;

/// Points in a lag, for joints that follow late: between them a lag bends by 1/32 of its way at most.
const PER_LAG: f64 = 4.0;
/// Pieces of a step at most.
const MOST_PIECES: usize = 64;

/// The path that joints follow late.
pub(super) struct LatePath {
    /// The commanded path.
    pub commanded: Fine,
    /// The tip at the same times, m.
    pub followed: Vec<Point3<f64>>,
    /// Its distance from each point of the rounded path, m.
    pub errors: Vec<Vector3<f64>>,
}

impl LatePath {
    /// The path that is followed by joints with these lags, rounded and commanded at these times, s; `tip` gives the tip at joint positions.
    pub fn of(
        path: &Rounded,
        times: &[f64],
        lags: &[Lag],
        tip: &(dyn Fn(&[f64]) -> Point3<f64> + Sync),
    ) -> LatePath {
        let longest = lags.iter().map(|lag| lag.time).fold(0.0, f64::max);
        if longest <= 0.0 {
            let fine = Fine::of(path, times, f64::INFINITY);
            return LatePath {
                followed: fine.points.clone(),
                errors: vec![Vector3::zeros(); path.points.len()],
                commanded: fine,
            };
        }
        let fine = Fine::of(path, times, longest / PER_LAG);
        let joints = lags.len();
        let late: Vec<Vec<f64>> = (lags.par_iter().enumerate())
            .map(|(joint, lag)| {
                let of_joint: Vec<f64> = fine
                    .positions
                    .iter()
                    .skip(joint)
                    .step_by(joints)
                    .copied()
                    .collect();
                lag.followed(&fine.times, &of_joint)
            })
            .collect();
        let followed = fine.points.par_iter().with_min_len(AT_ONCE).enumerate();
        let followed = followed.map_init(
            || vec![0.0; joints],
            |here, (index, at)| {
                let there = &fine.positions[index * joints..][..joints];
                for (position, late) in here.iter_mut().zip(&late) {
                    *position = late[index];
                }
                at + (tip(here) - tip(there))
            },
        );
        let followed: Vec<Point3<f64>> = followed.collect();
        drop(late);
        let errors = contour_errors(&fine.points, &followed, &fine.times, longest * LONGEST);
        LatePath {
            errors: fine.given.iter().map(|index| errors[*index]).collect(),
            followed,
            commanded: fine,
        }
    }
}

/// A commanded path in time with points so near in time that joints that follow late move evenly between them. The points of a move are joined by cubics: arcs are
/// not the polygons of their points, whose corners would be followed late. Corners between moves are rounded before.
#[derive(Default)]
pub(super) struct Fine {
    pub points: Vec<Point3<f64>>,
    positions: Vec<f64>,
    times: Vec<f64>,
    /// Index of each point of the path among these.
    pub given: Vec<usize>,
}

impl Fine {
    fn of(path: &Rounded, times: &[f64], step: f64) -> Fine {
        let joints = path.positions.len() / path.points.len();
        let at = |index: usize| &path.positions[index * joints..][..joints];
        let mut fine = Fine::default();
        let mut of_joints: Vec<[f64; 2]> = Vec::with_capacity(joints);
        for index in 0..path.points.len() {
            if let Some(before) = index.checked_sub(1) {
                let time = times[index] - times[before];
                let pieces = ((time / step).ceil() as usize).clamp(1, MOST_PIECES);
                // Slopes at both points, of the coordinates of the tip and of the joints.
                let slopes = |of: &dyn Fn(usize) -> f64| [before, index].map(|k| slope(times, k, of));
                let of_tip: [[f64; 2]; 3] = match pieces {
                    1 => [[0.0; 2]; 3],
                    _ => std::array::from_fn(|axis| slopes(&|k| path.points[k][axis])),
                };
                of_joints.clear();
                if pieces > 1 {
                    of_joints.extend((0..joints).map(|joint| slopes(&|k| at(k)[joint])));
                }
                for piece in 1..pieces {
                    let part = piece as f64 / pieces as f64;
                    let between = |ends: [f64; 2], slopes: [f64; 2]| cubic(ends, slopes, time, part);
                    fine.times.push(times[before] + time * part);
                    let tip = [0, 1, 2].map(|axis| {
                        between(
                            [path.points[before][axis], path.points[index][axis]],
                            of_tip[axis],
                        )
                    });
                    fine.points.push(Point3::from(tip));
                    let all = at(before).iter().zip(at(index)).zip(&of_joints);
                    fine.positions
                        .extend(all.map(|((from, to), slopes)| between([*from, *to], *slopes)));
                }
            }
            fine.given.push(fine.times.len());
            fine.times.push(times[index]);
            fine.points.push(path.points[index]);
            fine.positions.extend_from_slice(at(index));
        }
        fine
    }
}

/// Change per time of a value at point `k`: of the parabola through it and its neighbours, or of the step at an end; zero between equal times.
fn slope(times: &[f64], k: usize, value: &dyn Fn(usize) -> f64) -> f64 {
    let step = |from: usize| {
        let time = times[from + 1] - times[from];
        let change = value(from + 1) - value(from);
        (time, if time > 0.0 { change / time } else { 0.0 })
    };
    let last = times.len() - 1;
    if k == 0 || k == last {
        return step(k.min(last - 1)).1;
    }
    let [(h, before), (g, after)] = [step(k - 1), step(k)];
    if h + g > 0.0 {
        (g * before + h * after) / (h + g)
    } else {
        0.0
    }
}

/// The cubic between two values with these slopes, a time apart, at a part of that time.
fn cubic([from, to]: [f64; 2], [leaving, arriving]: [f64; 2], time: f64, part: f64) -> f64 {
    let rest = 1.0 - part;
    from + (to - from) * part * part * (3.0 - 2.0 * part)
        + time * part * rest * (leaving * rest - arriving * part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coarse_circle_is_followed_like_a_fine_one() {
        // Radius 100 mm, 50 mm/s, 36 points a turn; two slides that are 15 ms late.
        let (radius, turn_rate, lag) = (0.1, 0.5, 0.015);
        let count = 73;
        let angles: Vec<f64> = (0..count).map(|k| 10f64.to_radians() * f64::from(k)).collect();
        let points: Vec<Point3<f64>> = angles
            .iter()
            .map(|a| Point3::new(radius * a.cos(), radius * a.sin(), 0.0))
            .collect();
        let mut path = Rounded::default();
        path.positions = points.iter().flat_map(|at| [at.x, at.y]).collect();
        path.points = points;
        let times: Vec<f64> = angles.iter().map(|a| a / turn_rate).collect();
        let lags = [Lag {
            time: lag,
            feed_forward: 0.0,
        }; 2];
        let late = LatePath::of(&path, &times, &lags, &|q| Point3::new(q[0], q[1], 0.0));
        let expected = radius * (1.0 - 1.0 / (turn_rate * lag).hypot(1.0));
        for (k, error) in late.errors.iter().enumerate().take(60).skip(10) {
            // 2.8 um; at the corners of a polygon tens of um.
            assert!((error.norm() / expected - 1.0).abs() < 0.1, "{k}: {error}");
        }
    }

    #[test]
    fn a_cubic_has_its_ends_and_slopes() {
        let at = |part| cubic([1.0, 2.0], [3.0, -1.0], 0.5, part);
        assert_eq!((at(0.0), at(1.0)), (1.0, 2.0));
        let step = 1e-6;
        assert!(((at(step) - at(0.0)) / (0.5 * step) - 3.0).abs() < 1e-4);
        assert!(((at(1.0) - at(1.0 - step)) / (0.5 * step) + 1.0).abs() < 1e-4);
    }
}
