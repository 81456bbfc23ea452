//! Radial deviation and roundness of a circle on a plane, from the deviation along it.

use nalgebra::{Point2, Vector2, Vector3};

use crate::kernel::Answers;
use crate::path::Track;
use crate::roundness::{ReferenceCircle, least_squares};

/// Deviations of a circle under one load case. m.
#[derive(Clone, Debug)]
pub struct RadialDeviation {
    /// Outward part of the deviation at each point.
    pub outward: Vec<f64>,
    /// The least-squares circle of the deviated points and their roundness about it, path axes.
    pub roundness: ReferenceCircle,
    /// Displacement of its centre, path x and y.
    pub centre_shift: Vector2<f64>,
}

/// Deviations of the circle about `centre` (m, path x and y) that `track` follows, under each load case; empty where a
/// point of it is not reached, or its points are not a circle.
pub fn radial_deviations(track: &Track, answers: &Answers, centre: Point2<f64>) -> Vec<RadialDeviation> {
    if answers.points.iter().any(Result::is_err) {
        return Vec::new();
    }
    let points = &track.path.points;
    let nominal: Vec<Point2<f64>> = points.iter().map(|point| point.at.xy()).collect();
    let mean = nominal.iter().fold(Vector2::zeros(), |sum, at| sum + at.coords) / nominal.len().max(1) as f64;
    let path_from_base = track.placing.base_from_path.rotation.inverse();
    let of_case = |case: usize| {
        let moved = |i: usize| -> Vector3<f64> { path_from_base * answers.deviations_at(i)[case] };
        let all = || nominal.iter().enumerate().map(|(i, at)| (*at, moved(i).xy()));
        let deviated: Vec<Point2<f64>> = all().map(|(at, by)| at + by).collect();
        let roundness = least_squares(&deviated)?;
        Some(RadialDeviation {
            outward: all().map(|(at, by)| (at - centre).normalize().dot(&by)).collect(),
            centre_shift: roundness.centre.coords - mean,
            roundness,
        })
    };
    (0..answers.case_count).filter_map(of_case).collect()
}
