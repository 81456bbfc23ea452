//! The angles at which curves are compared, each with its weight.
//!
//! ```text
//! <f, g> = sum of w_k f(a_k) g(a_k)        w_k: half of the way to both neighbours, over all; sum of w_k = 1
//! ```
//!
//! Angles may be uneven: a densely probed stretch has no more weight than any other. Across a gap wider than
//! that of a ball-bar's profile nothing is known, and its ends get the weight of half such a gap.

use std::f64::consts::TAU;

use crate::measure::ballbar::profile::{GAP, is_gap};

/// Angles round a circle, and their weights.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    angle: Vec<f64>,
    weight: Vec<f64>,
    arc: f64,
}

/// Why angles are not a valid turn.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TurnError {
    /// Too few.
    #[error("{0} angles are not sufficient for a comparison: at least {least} are needed", least = Turn::LEAST)]
    TooFew(usize),
    /// Too short an arc.
    #[error("{:.1} deg of the circle are measured without a gap: at least a third of a turn is needed", .0.to_degrees())]
    TooShort(f64),
}

impl Turn {
    /// Minimum number of angles.
    pub const LEAST: usize = 12;

    /// At these angles (rad): rising, from 0 to below a turn, each once.
    ///
    /// # Errors
    /// Too few; an arc too short for a centre.
    pub fn new(angle: Vec<f64>) -> Result<Turn, TurnError> {
        let count = angle.len();
        if count < Turn::LEAST {
            return Err(TurnError::TooFew(count));
        }
        let gap = |k: usize| match k + 1 {
            next if next < count => angle[next] - angle[k],
            _ => angle[0] + TAU - angle[k],
        };
        let known = |k: usize| if is_gap(gap(k)) { 0.0 } else { gap(k) };
        let arc: f64 = (0..count).map(known).sum();
        if arc < TAU / 3.0 {
            return Err(TurnError::TooShort(arc));
        }
        let reach = |k: usize| if is_gap(gap(k)) { GAP } else { gap(k) };
        let reach: Vec<f64> = (0..count).map(reach).collect();
        let all: f64 = reach.iter().sum();
        let weight = (0..count).map(|k| (reach[k] + reach[(k + count - 1) % count]) / (2.0 * all));
        Ok(Turn {
            weight: weight.collect(),
            angle,
            arc,
        })
    }

    /// The angles, rad.
    pub fn angle(&self) -> &[f64] {
        &self.angle
    }

    /// Measured part of a turn, rad.
    pub fn arc(&self) -> f64 {
        self.arc
    }

    /// A curve at these angles, by linear interpolation of its values at even angles from 0 on; zeros of none.
    pub fn of_even(&self, values: &[f64]) -> Vec<f64> {
        let count = values.len();
        let at = |angle: &f64| {
            let place = angle / TAU * count as f64;
            let before = place.floor();
            let (one, share) = (before as usize % count, place - before);
            values[one] * (1.0 - share) + values[(one + 1) % count] * share
        };
        match count {
            0 => vec![0.0; self.angle.len()],
            _ => self.angle.iter().map(at).collect(),
        }
    }

    /// The mean over the turn of the product of two curves.
    pub fn product(&self, one: &[f64], other: &[f64]) -> f64 {
        let both = one.iter().zip(other);
        self.weight.iter().zip(both).map(|(w, (f, g))| w * f * g).sum()
    }

    /// The mean over the turn of a curve.
    pub fn mean(&self, curve: &[f64]) -> f64 {
        self.weight.iter().zip(curve).map(|(w, f)| w * f).sum()
    }

    /// The root of the mean square of a curve.
    pub fn rms(&self, curve: &[f64]) -> f64 {
        self.product(curve, curve).sqrt()
    }
}

/// The largest of a curve by size, and its index; 0 of none.
pub fn largest(curve: &[f64]) -> (usize, f64) {
    let sizes = curve.iter().map(|value| value.abs()).enumerate();
    sizes.fold(
        (0, 0.0),
        |before, here| if here.1 > before.1 { here } else { before },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn even(count: usize) -> Vec<f64> {
        (0..count).map(|k| TAU * k as f64 / count as f64).collect()
    }

    #[test]
    fn uneven_angles_give_the_mean_of_the_turn_and_not_of_the_samples() {
        // A quarter of the turn probed ten times as closely.
        let mut angle = even(72);
        angle.extend((1..180).map(|k| f64::from(k).to_radians() / 2.0 + 1e-4));
        angle.sort_by(f64::total_cmp);
        let turn = Turn::new(angle.clone()).unwrap();
        let wave: Vec<f64> = angle.iter().map(|a| a.sin()).collect();
        assert!(turn.mean(&wave).abs() < 2e-3);
        assert!((turn.rms(&wave) - 0.5_f64.sqrt()).abs() < 2e-3);
        assert!((turn.mean(&vec![1.0; angle.len()]) - 1.0).abs() < 1e-14);
        assert!((turn.arc() - TAU).abs() < 1e-12);
    }

    #[test]
    fn too_few_angles_and_short_arcs_are_refused() {
        assert_eq!(Turn::new(even(11)), Err(TurnError::TooFew(11)));
        let arc: Vec<f64> = (0..100).map(|k| f64::from(k).to_radians()).collect();
        let refused = Turn::new(arc).unwrap_err();
        assert!(refused.to_string().starts_with("99.0 deg of the circle"));
        // Samples every 20 degrees are all gaps.
        assert_eq!(Turn::new(even(18)), Err(TurnError::TooShort(0.0)));
        // Every 15 degrees is sufficient.
        assert!(Turn::new(even(24)).is_ok());
    }

    #[test]
    fn a_curve_of_even_angles_is_straight_between_them_and_across_the_end_of_the_turn() {
        let turn = Turn::new((0..720).map(|k| (f64::from(k) / 2.0).to_radians()).collect()).unwrap();
        let given = turn.of_even(&[0.0, 1.0, 4.0, 2.0]);
        for (half_deg, value) in [(0, 0.0), (90, 0.5), (180, 1.0), (450, 3.0), (630, 1.0)] {
            assert!((given[half_deg] - value).abs() < 1e-12, "{half_deg}");
        }
        assert_eq!(turn.of_even(&[]), vec![0.0; 720]);
    }

    #[test]
    fn the_largest_is_that_of_the_absolute_values() {
        assert_eq!(largest(&[1.0, -3.0, 2.0]), (1, 3.0));
        assert_eq!(largest(&[]), (0, 0.0));
    }
}
