//! One joint along a circle: its position and lever at stations evenly round, and cubics between them.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use crate::robot::BacklashSide;

/// One joint along the circle.
#[derive(Clone, Debug)]
pub(super) struct JointAlong {
    /// `theta` at each station.
    pub theta: Vec<f64>,
    /// Whether it moves only by rounding: then its backlash has no effect.
    pub at_standstill: bool,
    /// Change of its position over a whole turn.
    pub winding: f64,
    /// `l` at each station.
    pub lever: Vec<Vector3<f64>>,
    /// Torque of gravity on its link at each station, N m (N).
    pub torque: Vec<f64>,
    /// Its side of the backlash is decided by this.
    pub side: BacklashSide,
}

impl JointAlong {
    /// `theta` at a station of the first turn or the second.
    pub fn at(&self, index: usize) -> f64 {
        let count = self.theta.len();
        self.theta[index % count] + self.winding * (index / count) as f64
    }

    /// `theta` at an angle of the first turn.
    pub fn theta_at(&self, angle: f64) -> f64 {
        if self.at_standstill {
            return self.theta[0];
        }
        let count = self.theta.len();
        let (four, weights) = cubic(angle, count);
        // Stations are numbered from one turn before.
        let of = |k: usize| self.at(four + k) - self.winding;
        (0..4).map(|k| weights[k] * of(k)).sum()
    }
}

/// Outwards at an angle, along the axes of the circle.
pub(super) fn outwards(angle: f64) -> Vector3<f64> {
    Vector3::new(angle.cos(), angle.sin(), 0.0)
}

/// Interpolation at `angle` (rad) of values at even stations of a turn.
pub(super) fn between(values: &[Vector3<f64>], angle: f64) -> Vector3<f64> {
    let (four, weights) = cubic(angle, values.len());
    let of = |k: usize| values[(four + k) % values.len()];
    (0..4).map(|k| of(k) * weights[k]).sum()
}

/// The same for plain numbers.
pub(super) fn between_numbers(values: &[f64], angle: f64) -> f64 {
    let (four, weights) = cubic(angle, values.len());
    (0..4)
        .map(|k| values[(four + k) % values.len()] * weights[k])
        .sum()
}

/// The first of four stations about an angle of a turn, numbered from one turn before, and their weights.
fn cubic(angle: f64, count: usize) -> (usize, [f64; 4]) {
    let place = angle.rem_euclid(TAU) / TAU * count as f64;
    let before = place.floor();
    let t = place - before;
    let weights = [
        -t * (t - 1.0) * (t - 2.0) / 6.0,
        (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
        -(t + 1.0) * t * (t - 2.0) / 2.0,
        (t + 1.0) * t * (t - 1.0) / 6.0,
    ];
    (before as usize + count - 1, weights)
}
