//! The Gaussian profile filter of a closed profile: its waves below a number of undulations per revolution (UPR).
//!
//! The transmission of `k` waves per turn is one half at the cut-off `f`:
//!
//! ```text
//! G(k) = exp(-ln 2 (k / f)^2)
//! dR_filtered(theta) = sum over k of G(k) (a_k cos k theta + b_k sin k theta)
//! a_k, b_k = 1/pi sum over points of w dR (cos k theta, sin k theta)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `dR` | deviation from the least-squares circle | m |
//! | `w` | angle weight of a point: half the distance to each neighbour | rad |
//! | `k`, `f` | waves per turn, cut-off | UPR |
//!
//! Many points and many waves are instead weighted over their neighbours, as far as `s` is significant:
//!
//! ```text
//! dR_filtered(theta) = sum over points of w dR s(theta_i - theta),    s(x) = exp(-pi (x / al)^2) / al,    al = sqrt(ln 2 / pi) 2 pi / f
//! ```
//!
//! That is the convolution with the Gaussian weight round the circle, exact for even angles; for uneven ones the sums
//! are accurate to the square of the step. Steps may be a seventh of a wave of the cut-off at most: a wave of 3.5 times
//! the cut-off, which still passes by 1/5000, then has two points. Source: ISO 16610-21 (weight and cut-off), ISO
//! 12181-2 (seven points a wave) \[recalled\].

use std::f64::consts::{LN_2, PI, TAU};

use nalgebra::Complex;
use rayon::prelude::*;

use super::RoundnessError;
use super::harmonics::wave_sums;
use super::polar::Polar;

/// Points per wave at the cut-off.
const POINTS_PER_WAVE: f64 = 7.0;
/// Waves with less transmission are neglected.
const LEAST_TRANSMISSION: f64 = 1e-17;
/// Neighbours whose weight is a smaller part of the largest are neglected.
const LEAST_WEIGHT: f64 = 1e-17;
/// Sums of up to this many steps are made through waves, whatever is shorter.
const FEW_STEPS: f64 = 1e7;

impl Polar {
    /// The deviations of the points after the Gaussian filter of cut-off `upr`.
    ///
    /// # Errors
    /// A cut-off below one wave per turn; steps between points too large for it, among them the gap of an arc.
    pub fn filtered(&self, upr: f64) -> Result<Vec<f64>, RoundnessError> {
        // Not `<`: NaN is refused too.
        if !(upr >= 1.0 && upr.is_finite()) {
            return Err(RoundnessError::CutOff { upr });
        }
        let most = TAU / (POINTS_PER_WAVE * upr);
        // Even steps exceed a whole part of a turn by rounding.
        if self.gap.width > most * (1.0 + 1e-9) {
            return Err(RoundnessError::Sparse {
                gap_deg: self.gap.width.to_degrees(),
                most_deg: most.to_degrees(),
                upr,
                least_points: (POINTS_PER_WAVE * upr).ceil() as usize,
            });
        }
        let passing = (upr * (-LEAST_TRANSMISSION.ln() / LN_2).sqrt()).floor();
        let waves = passing.min(self.most_waves()) as usize;
        let weighed = self.deviations.iter().zip(self.weights_by_angle());
        let weighed: Vec<f64> = weighed.map(|(by, width)| by * width).collect();
        let by_waves = self.angles.len() as f64 * waves as f64;
        if by_waves > FEW_STEPS {
            let width = (LN_2 / PI).sqrt() * TAU / upr;
            let sorted: Vec<f64> = self.order.iter().map(|i| self.angles[*i]).collect();
            if pairs_within(&sorted, reach(width)) < by_waves {
                return Ok(self.moved_round(&weighed, &sorted, width));
            }
        }
        Ok(self.through_waves(&weighed, waves, upr))
    }

    /// The filter by the waves of `weighed`: deviation times the angle weight of a point.
    fn through_waves(&self, weighed: &[f64], waves: usize, upr: f64) -> Vec<f64> {
        let mut parts = wave_sums(&self.angles, weighed, waves);
        for (k, part) in parts.iter_mut().enumerate() {
            let both_ways = if k == 0 { 0.5 } else { 1.0 };
            *part = part.conj() * (both_ways / PI * (-LN_2 * (k as f64 / upr).powi(2)).exp());
        }
        // Horner's rule in the turn by one angle: a0 + t (a1 + t (a2 + ...)).
        let at = |angle: &f64| {
            let turn = Complex::from_polar(1.0, *angle);
            let sum = parts
                .iter()
                .rev()
                .fold(Complex::new(0.0, 0.0), |sum, part| sum * turn + part);
            sum.re
        };
        self.angles.par_iter().map(at).collect()
    }

    /// The filter by the weight function of this width (rad), moved round the circle; `sorted` are the angles in their
    /// order.
    fn moved_round(&self, weighed: &[f64], sorted: &[f64], width: f64) -> Vec<f64> {
        let (count, reach) = (sorted.len(), reach(width));
        let at = |place: usize| {
            let near = |next: usize, by: usize| {
                let apart = (sorted[next] - sorted[place]).abs();
                let apart = apart.min(TAU - apart);
                let is_near = apart <= reach && by < count;
                is_near.then(|| weighed[self.order[next]] * (-PI * (apart / width).powi(2)).exp())
            };
            let behind = (0..).map_while(|by| near((place + by) % count, by));
            let before = (1..).map_while(|by| near((place + count - by % count) % count, by));
            (behind.sum::<f64>() + before.sum::<f64>()) / width
        };
        let found: Vec<f64> = (0..count).into_par_iter().map(at).collect();
        let mut filtered = vec![0.0; count];
        for (index, value) in self.order.iter().zip(found) {
            filtered[*index] = value;
        }
        filtered
    }

    /// The most waves per turn that the steps between the points resolve: at least two points per wave.
    pub fn most_waves(&self) -> f64 {
        ((PI / self.gap.width) * (1.0 + 1e-9)).ceil() - 1.0
    }

    /// The angle weight of each point: half the distance to both neighbours; the sum is a turn.
    fn weights_by_angle(&self) -> Vec<f64> {
        let count = self.order.len();
        let mut weights_by_angle = vec![0.0; count];
        for place in 0..count {
            let (at, next) = (self.order[place], self.order[(place + 1) % count]);
            let round = if place + 1 == count { TAU } else { 0.0 };
            let half = (self.angles[next] + round - self.angles[at]) / 2.0;
            weights_by_angle[at] += half;
            weights_by_angle[next] += half;
        }
        weights_by_angle
    }
}

/// Range of a weight function of this width, rad.
fn reach(width: f64) -> f64 {
    width * (-LEAST_WEIGHT.ln() / PI).sqrt()
}

/// Number of pairs of neighbours within `reach` (rad), each from both sides; infinite where that is half a turn.
fn pairs_within(sorted: &[f64], reach: f64) -> f64 {
    let count = sorted.len();
    if reach >= 0.5 * PI {
        return f64::INFINITY;
    }
    let (mut end, mut pairs) = (0, 0.0);
    for (place, angle) in sorted.iter().enumerate() {
        let turned = |next: usize| sorted[next % count] + TAU * (next / count) as f64;
        while end < place + count && turned(end) - angle <= reach {
            end += 1;
        }
        pairs += 2.0 * (end - place) as f64;
    }
    pairs
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point2, Vector2};

    use super::super::Profile;
    use super::*;

    /// `count` points with `waves` of 5 um, at even angles or displaced by a part of the step.
    fn wavy(count: usize, waves: f64, unevenness: f64) -> Polar {
        let at = |i: usize| {
            let even = TAU * i as f64 / count as f64;
            let angle = even + unevenness * TAU / count as f64 * (11.0 * even).sin();
            Point2::from(Vector2::new(angle.cos(), angle.sin()) * (0.05 + 5e-6 * (waves * angle).cos()))
        };
        Profile::new((0..count).map(at).collect()).unwrap().polar()
    }

    fn largest(deviations: &[f64]) -> f64 {
        deviations.iter().fold(0.0, |most, by| by.abs().max(most))
    }

    #[test]
    fn a_wave_of_the_cut_off_is_halved_and_others_follow_the_gaussian() {
        for waves in [2.0, 7.0, 15.0, 20.0, 30.0, 45.0] {
            let filtered = wavy(720, waves, 0.0).filtered(15.0).unwrap();
            let transmission = (-LN_2 * (waves / 15.0_f64).powi(2)).exp();
            assert!((largest(&filtered) - 5e-6 * transmission).abs() < 1e-9, "{waves}");
        }
        let halved = wavy(720, 15.0, 0.0).filtered(15.0).unwrap();
        assert!((largest(&halved) - 2.5e-6).abs() < 1e-12);
    }

    #[test]
    fn the_filter_is_the_gaussian_weight_moved_round_the_circle() {
        // ISO 16610-21: s(x) = 1/(a l) exp(-pi (x/(a l))^2) with a = sqrt(ln 2 / pi) and l the cut-off, here an angle.
        let (count, upr) = (400, 20.0);
        let mut polar = wavy(count, 3.0, 0.0);
        polar.deviations[17] += 40e-6;
        polar.deviations[300] -= 15e-6;
        let filtered = polar.filtered(upr).unwrap();
        let step = TAU / count as f64;
        let width = (LN_2 / PI).sqrt() * TAU / upr;
        for (at, filtered) in filtered.iter().enumerate() {
            let weighed = (0..count).map(|i| {
                let apart = (at.abs_diff(i)).min(count - at.abs_diff(i)) as f64 * step;
                polar.deviations[i] * (-PI * (apart / width).powi(2)).exp() / width * step
            });
            // Sums over steps differ from the integral by the transmission of as many waves as there are points.
            assert!((weighed.sum::<f64>() - filtered).abs() < 1e-15, "{at}");
        }
    }

    #[test]
    fn many_points_and_waves_are_filtered_over_neighbours_as_through_waves() {
        for unevenness in [0.0, 0.5] {
            let polar = wavy(3000, 110.0, unevenness);
            let weighed = polar.deviations.iter().zip(polar.weights_by_angle());
            let weighed: Vec<f64> = weighed.map(|(by, width)| by * width).collect();
            let width = (LN_2 / PI).sqrt() * TAU / 100.0;
            let sorted: Vec<f64> = polar.order.iter().map(|i| polar.angles[*i]).collect();
            let near = polar.moved_round(&weighed, &sorted, width);
            // 7.5 waves of the cut-off: beyond it the transmission is negligible.
            let through = polar.through_waves(&weighed, 751, 100.0);
            for (one, other) in near.iter().zip(&through) {
                assert!((one - other).abs() < 1e-17, "{unevenness}: {one} {other}");
            }
            assert_eq!(pairs_within(&sorted, reach(TAU)), f64::INFINITY);
        }
        let sorted: Vec<f64> = (0..360).map(|deg| f64::from(deg).to_radians()).collect();
        // Each with itself from either side, and two neighbours on each.
        assert_eq!(pairs_within(&sorted, 2.5_f64.to_radians()), 360.0 * 6.0);
        // As many as a scanner gives, at the finest cut-off: through waves these are 1e11 steps.
        let dense = wavy(300_000, 15_000.0, 0.0);
        let halved = dense.filtered(15_000.0).unwrap();
        assert!((largest(&halved) - 2.5e-6).abs() < 1e-9);
    }

    #[test]
    fn uneven_angles_are_filtered_like_even_ones() {
        let uneven = wavy(360, 15.0, 0.5);
        let filtered = uneven.filtered(15.0).unwrap();
        for (angle, by) in uneven.angles.iter().zip(&filtered) {
            // By the square of the largest step over the wave, times their unevenness.
            assert!(
                (by - 2.5e-6 * (15.0 * angle).cos()).abs() < 0.03e-6,
                "{angle}: {by}"
            );
        }
    }

    #[test]
    fn refuses_sparse_points_arcs_and_invalid_cut_offs() {
        // 72 points, every five degrees, are too few for 15 UPR.
        let refused = wavy(72, 3.0, 0.0).filtered(15.0).unwrap_err();
        assert!(
            matches!(
                refused,
                RoundnessError::Sparse {
                    least_points: 105,
                    ..
                }
            ),
            "{refused}"
        );
        assert!(refused.to_string().contains("5.000 deg") && refused.to_string().contains("3.429 deg"));
        assert!(wavy(105, 3.0, 0.0).filtered(15.0).is_ok());
        assert!(wavy(104, 3.0, 0.0).filtered(15.0).is_err());
        let mut arc = wavy(1000, 3.0, 0.0).with(&wavy(1000, 3.0, 0.0).deviations);
        arc.truncate(800);
        assert!(Profile::new(arc).unwrap().polar().filtered(2.0).is_err());
        for upr in [0.0, 0.5, -3.0, f64::NAN, f64::INFINITY] {
            let refused = wavy(720, 3.0, 0.0).filtered(upr).unwrap_err();
            assert!(matches!(refused, RoundnessError::CutOff { .. }), "{upr}");
        }
    }
}
