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

/// A commanded path in time with points so near in time that joints that follow late move evenly between them.
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
        for index in 0..path.points.len() {
            if let Some(before) = index.checked_sub(1) {
                let time = times[index] - times[before];
                let pieces = ((time / step).ceil() as usize).clamp(1, MOST_PIECES);
                for piece in 1..pieces {
                    let part = piece as f64 / pieces as f64;
                    fine.times.push(times[before] + time * part);
                    fine.points
                        .push(path.points[before] + (path.points[index] - path.points[before]) * part);
                    let both = at(before).iter().zip(at(index));
                    fine.positions
                        .extend(both.map(|(from, to)| from + (to - from) * part));
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
