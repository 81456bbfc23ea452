//! The commanded and the followed path next to one point: what a controller makes of a corner.

use nalgebra::Point3;

/// How far the detail reaches, relative to the distance of the followed path from the point.
const REACH: f64 = 8.0;
/// Least reach, m.
const LEAST_REACH: f64 = 2e-4;
/// Points of each path at most.
const MOST_POINTS: usize = 2000;

/// The motion next to one point of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionDetail {
    /// Index of the point.
    pub index: usize,
    /// Distance of the followed path from the point, m.
    pub distance: f64,
    /// How far from the point the detail reaches, m.
    pub reach: f64,
    /// The commanded path, m, base.
    pub commanded: Vec<Point3<f64>>,
    /// The followed path at the same times, m, base.
    pub followed: Vec<Point3<f64>>,
}

impl MotionDetail {
    /// The part of both paths around the point `at` with this index and distance, of which the command passes it at its point `passed`.
    pub(super) fn of(
        (index, at): (usize, Point3<f64>),
        distance: f64,
        passed: usize,
        [commanded, followed]: [&[Point3<f64>]; 2],
    ) -> MotionDetail {
        let reach = (REACH * distance).max(LEAST_REACH);
        let is_near = |k: &usize| (commanded[*k] - at).norm() <= reach || (followed[*k] - at).norm() <= reach;
        let before = (0..passed).rev().take_while(is_near).last().unwrap_or(passed);
        let after = (passed..commanded.len())
            .take_while(is_near)
            .last()
            .unwrap_or(passed);
        let stride = (after + 1 - before).div_ceil(MOST_POINTS).max(1);
        let part = |path: &[Point3<f64>]| path[before..=after].iter().step_by(stride).copied().collect();
        MotionDetail {
            index,
            distance,
            reach,
            commanded: part(commanded),
            followed: part(followed),
        }
    }
}
