//! Reversals of the joints on a circle.
//!
//! ```text
//! theta'(a) = 0        theta' by five points, fourth order; its zero by a cubic through four
//! ```
//!
//! Only the geometry decides: a joint reverses at the same angle in both directions.

use std::f64::consts::TAU;

use super::along::{JointAlong, between_numbers};

/// A reversal of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointReversal {
    /// Index of the joint.
    pub joint: usize,
    /// Angle on the circle, 0 to below a turn, rad.
    pub angle: f64,
}

/// A speed below this part of the greatest is rounding.
const ROUNDING: f64 = 1e-9;
/// Maximum number of halvings for a zero: beyond rounding.
const HALVINGS: usize = 50;

/// All of them, by joint, then by angle.
pub(super) fn reversals(joints: &[JointAlong]) -> Vec<JointReversal> {
    let of = |(joint, along): (usize, &JointAlong)| {
        zeros(&speeds(along))
            .into_iter()
            .map(move |angle| JointReversal { joint, angle })
    };
    joints.iter().enumerate().flat_map(of).collect()
}

/// `theta'` times the pitch, at each station.
fn speeds(along: &JointAlong) -> Vec<f64> {
    let count = along.theta.len();
    // Of the second turn, so that there are stations before.
    let apart = |index: usize, by: usize| along.at(count + index + by) - along.at(count + index - by);
    let speed = |index: usize| (8.0 * apart(index, 1) - apart(index, 2)) / 12.0;
    (0..count).map(speed).collect()
}

/// Angles at which a periodic function changes its sign.
fn zeros(values: &[f64]) -> Vec<f64> {
    let count = values.len();
    let greatest = values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let sign = |index: usize| {
        let value = values[index % count];
        let counts = value.abs() > ROUNDING * greatest;
        counts.then_some(value > 0.0)
    };
    // From a station with a nonzero value on, so that a stretch of zeros has both its ends.
    let Some(first) = (0..count).find(|index| sign(*index).is_some()) else {
        return Vec::new();
    };
    let (mut before, mut found) = (first, Vec::new());
    for index in first + 1..=first + count {
        let Some(rises) = sign(index) else { continue };
        if Some(rises) != sign(before) {
            let pitch = TAU / count as f64;
            let mut ends = [before as f64 * pitch, index as f64 * pitch];
            for _ in 0..HALVINGS {
                let middle = 0.5 * (ends[0] + ends[1]);
                let is_behind = (between_numbers(values, middle) > 0.0) == rises;
                ends[usize::from(is_behind)] = middle;
            }
            let angle = (0.5 * (ends[0] + ends[1])).rem_euclid(TAU);
            // A tiny negative angle is rounded to a whole turn.
            found.push(if angle < TAU { angle } else { 0.0 });
        }
        before = index;
    }
    found.sort_by(f64::total_cmp);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_of_a_wave_are_found_on_stations_and_between() {
        for shift in [0.0, 0.3, -1e-12] {
            let values: Vec<f64> = (0..360)
                .map(|k| (2.0 * (f64::from(k).to_radians() - shift)).sin())
                .collect();
            let found = zeros(&values);
            assert_eq!(found.len(), 4, "{found:?}");
            for angle in found {
                assert!((2.0 * (angle - shift)).sin().abs() < 1e-8, "{angle}");
            }
        }
        assert_eq!(zeros(&[0.0; 30]), []);
        assert_eq!(zeros(&[1.0; 30]), []);
    }
}
