//! The tip of the tool: its path, and its position in the flange where that is not given.
//!
//! Of all points fixed to the flange the tip is the one whose moves are straightest: the sum of the squares of the distances from one line for each move is least.

use std::ops::Range;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Point3, Vector3, convert};
use armill_core::robot::Robot;
use armill_core::robot::forward::{Frames, forward_into};

use super::least_squares::{Parameter, least_squares};
use super::line::Line;

/// Samples of a move that are used.
const SAMPLES: usize = 80;
/// Part at each end of a move that is not used: rounded corners.
const ENDS: f64 = 0.15;
/// Shortest way of the flange in a move that is used, m.
const SHORTEST: f64 = 0.03;
/// Step of the derivatives, m.
const STEP: f64 = 1e-4;

/// The tip of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tool {
    /// From the flange, flange axes, m.
    pub tip: Vector3<f64>,
    /// Standard uncertainty of its coordinates, m, and distance of the moves from lines, m rms, if it was fitted.
    pub fitted: Option<([f64; 3], f64)>,
}

/// The flange in the base at each instant.
pub(super) fn flanges(robot: &Robot, positions: &[f64]) -> Vec<Isometry> {
    let mut frames = Frames::for_robot(robot);
    let rows = positions.chunks_exact(robot.joints().len());
    rows.map(|row| {
        forward_into(robot, row, &mut frames);
        convert(frames.base_from_flange)
    })
    .collect()
}

/// The tip in the base at each instant, m.
pub(super) fn tips(flanges: &[Isometry], tip: Vector3<f64>) -> Vec<Point3<f64>> {
    flanges.iter().map(|flange| flange * Point3::from(tip)).collect()
}

/// The tip that makes these moves straight; `None` of moves that are too short.
pub(super) fn straight_tool(flanges: &[Isometry], moves: &[Range<usize>]) -> Option<Tool> {
    let samples: Vec<Vec<Isometry>> = moves
        .iter()
        .filter_map(|range| middle(&flanges[range.clone()]))
        .collect();
    if samples.is_empty() {
        return None;
    }
    let parameter = Parameter {
        start: 0.0,
        step: STEP,
        least: f64::NEG_INFINITY,
    };
    let found = least_squares(&[parameter; 3], |p| {
        let tip = Vector3::new(p[0], p[1], p[2]);
        let offsets = samples.iter().flat_map(|flanges| {
            let points = tips(flanges, tip);
            let line = Line::through(&points);
            points
                .into_iter()
                .flat_map(move |point| {
                    let offset = line.map_or(Vector3::zeros(), |line| line.offset(&point));
                    [offset.x, offset.y, offset.z]
                })
                .collect::<Vec<f64>>()
        });
        offsets.collect()
    });
    let tip = Vector3::new(found.values[0], found.values[1], found.values[2]);
    // Three coordinates of each offset.
    let distance = found.rms * 3.0_f64.sqrt();
    Some(Tool {
        tip,
        fitted: Some(([found.u[0], found.u[1], found.u[2]], distance)),
    })
}

/// Samples of the middle of a move at even distances of the flange.
fn middle(flanges: &[Isometry]) -> Option<Vec<Isometry>> {
    let mut along = vec![0.0];
    for pair in flanges.windows(2) {
        let way = (pair[1].translation.vector - pair[0].translation.vector).norm();
        along.push(along[along.len() - 1] + way);
    }
    let length = along[along.len() - 1];
    if length < SHORTEST || flanges.is_empty() {
        return None;
    }
    let places = (0..SAMPLES).map(|k| length * (ENDS + (1.0 - 2.0 * ENDS) * k as f64 / (SAMPLES - 1) as f64));
    let mut indices: Vec<usize> = places
        .map(|place| along.partition_point(|at| *at < place).min(flanges.len() - 1))
        .collect();
    indices.dedup();
    (indices.len() > 5).then(|| indices.into_iter().map(|index| flanges[index]).collect())
}
