//! Thins a path: the points needed so that straight moves between them stay within a tolerance of all points.
//!
//! Between two kept points a robot moves straight and turns evenly. Points are compared at the same fraction of the
//! way: `|p_i - (p_a + t (p_b - p_a))|` and the angle between the orientations, `t` the fraction of the way at point
//! `i`. Source: Ramer (1972), Douglas and Peucker (1973), by the fraction of the way instead of the nearest point.

use crate::frame::Isometry;

/// Tolerance of a straight move at the points between its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thinning {
    /// m
    pub place: f64,
    /// rad
    pub turn: f64,
}

/// Maximum number of points of a move: in the worst case the effort grows with its square.
const MOST_POINTS: usize = 2000;

/// Indices of the kept poses, with the first and the last, in order; `along` is the distance along the path of each
/// pose, ascending (m).
///
/// # Panics
/// If the two differ in length.
pub fn thinned(poses: &[Isometry], along: &[f64], within: Thinning) -> Vec<usize> {
    assert_eq!(poses.len(), along.len(), "one distance per pose");
    let mut kept = Vec::new();
    let Some(last) = poses.len().checked_sub(1) else {
        return kept;
    };
    kept.push(0);
    let mut stack: Vec<(usize, usize)> = Vec::new();
    let mut start = 0;
    while start < last {
        let end = (start + MOST_POINTS).min(last);
        stack.push((start, end));
        while let Some((from, to)) = stack.pop() {
            match farthest(poses, along, from, to, within) {
                // The first half is processed first: the result is in order.
                Some(middle) => stack.extend([(middle, to), (from, middle)]),
                None => kept.push(to),
            }
        }
        start = end;
    }
    kept
}

/// The point with the largest error of a move between two points, if it exceeds the tolerance.
fn farthest(poses: &[Isometry], along: &[f64], from: usize, to: usize, within: Thinning) -> Option<usize> {
    let way = along[to] - along[from];
    let mut worst: Option<(f64, usize)> = None;
    for index in from + 1..to {
        let part = if way > 0.0 {
            (along[index] - along[from]) / way
        } else {
            0.5
        };
        let (a, b) = (&poses[from], &poses[to]);
        let place = a.translation.vector.lerp(&b.translation.vector, part);
        let leaves = (poses[index].translation.vector - place).norm() / within.place;
        // Between two orientations half a turn apart no direction is shorter.
        let turned = a.rotation.try_slerp(&b.rotation, part, 1e-9);
        let turn = turned.map_or(f64::INFINITY, |turned| poses[index].rotation.angle_to(&turned));
        let leaves = leaves.max(turn / within.turn);
        if leaves > 1.0 && worst.is_none_or(|(most, _)| leaves > most) {
            worst = Some((leaves, index));
        }
    }
    worst.map(|(_, index)| index)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use nalgebra::{Translation3, UnitQuaternion, Vector3};

    use super::*;

    const WITHIN: Thinning = Thinning {
        place: 1e-5,
        turn: 1e-3,
    };

    /// Poses along a path, each at this distance from the one before.
    fn poses(
        count: usize,
        step: f64,
        at: impl Fn(f64) -> (Vector3<f64>, Vector3<f64>),
    ) -> (Vec<Isometry>, Vec<f64>) {
        let along: Vec<f64> = (0..count).map(|i| i as f64 * step).collect();
        let pose = |along: &f64| {
            let (place, turn) = at(*along);
            Isometry::from_parts(Translation3::from(place), UnitQuaternion::from_scaled_axis(turn))
        };
        (along.iter().map(pose).collect(), along)
    }

    /// Largest error of the moves between kept points, relative to the tolerance.
    fn left(poses: &[Isometry], along: &[f64], kept: &[usize]) -> f64 {
        let of = |pair: &[usize]| {
            let (from, to) = (pair[0], pair[1]);
            (from..=to)
                .map(|i| {
                    let part = (along[i] - along[from]) / (along[to] - along[from]);
                    let there = poses[from].lerp_slerp(&poses[to], part);
                    let place =
                        (there.translation.vector - poses[i].translation.vector).norm() / WITHIN.place;
                    place.max(there.rotation.angle_to(&poses[i].rotation) / WITHIN.turn)
                })
                .fold(0.0, f64::max)
        };
        kept.windows(2).map(of).fold(0.0, f64::max)
    }

    #[test]
    fn a_straight_path_with_an_even_turn_needs_only_its_ends() {
        let turned = |s: f64| (Vector3::new(s, -0.5 * s, 0.0), Vector3::new(0.0, s, 0.0));
        let (poses, along) = poses(1500, 1e-3, turned);
        assert_eq!(thinned(&poses, &along, WITHIN), [0, 1499]);
    }

    #[test]
    fn a_circle_keeps_as_many_chords_as_its_sagitta_requires() {
        let radius = 0.1;
        let round = |s: f64| {
            let (sin, cos) = (s / radius).sin_cos();
            (Vector3::new(radius * cos, radius * sin, 0.0), Vector3::zeros())
        };
        let (poses, along) = poses(6284, TAU * radius / 6283.0, round);
        let kept = thinned(&poses, &along, WITHIN);
        assert!(left(&poses, &along, &kept) <= 1.0);
        // r (1 - cos(phi / 2)) = 10 um: chords of 0.0283 rad, 222 of them; halves of halves have up to twice as many.
        let least = PI / (1.0 - WITHIN.place / radius).acos();
        let count = kept.len() as f64 - 1.0;
        assert!(
            count >= least.floor() && count < 2.2 * least,
            "{count} of {least}"
        );
    }

    #[test]
    fn a_pure_turn_keeps_points_and_a_corner_is_kept() {
        let nods = |s: f64| {
            (
                Vector3::new(s, 0.0, 0.0),
                Vector3::new(0.0, 0.2 * (20.0 * s).sin(), 0.0),
            )
        };
        let (nodding, along) = poses(2000, 5e-4, nods);
        let kept = thinned(&nodding, &along, WITHIN);
        assert!(kept.len() > 20 && left(&nodding, &along, &kept) <= 1.0);
        let corner = |s: f64| {
            (
                Vector3::new(s.min(0.3), (s - 0.3).max(0.0), 0.0),
                Vector3::zeros(),
            )
        };
        let (cornered, along) = poses(1001, 1e-3, corner);
        let kept = thinned(&cornered, &along, WITHIN);
        assert!(kept.contains(&300) && kept.len() < 8, "{kept:?}");
    }

    #[test]
    fn kept_points_are_in_order_and_short_paths_are_kept_whole() {
        let spiral = |s: f64| (Vector3::new(s.cos(), s.sin(), 0.1 * s) * s, Vector3::zeros());
        let (poses, along) = poses(7000, 1e-3, spiral);
        let kept = thinned(&poses, &along, WITHIN);
        assert!(kept.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!((kept.first(), kept.last()), (Some(&0), Some(&6999)));
        assert_eq!(thinned(&poses[..2], &along[..2], WITHIN), [0, 1]);
        assert_eq!(thinned(&poses[..1], &along[..1], WITHIN), [0]);
        assert_eq!(thinned(&[], &[], WITHIN), Vec::<usize>::new());
    }
}
