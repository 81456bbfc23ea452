//! Agreement of a measured curve with a predicted one.
//!
//! ```text
//! explained = 1 - <m - p, m - p> / <m, m>     1: all of it; 0: like no prediction; below: worse than no prediction
//! likeness  = <m, p> / (|m| |p|)              shape only: 1 equal, 0 unrelated, -1 opposite
//! gain      = <m, p> / <p, p>                 factor on p that explains most
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `m`, `p` | measured, predicted radial deviation, from the same datum | m |
//!
//! `explained` is at most `likeness^2`, and equals it where the gain is 1: shape and size must both be right.

use super::turn::{Turn, largest};

/// Agreement of one curve with another.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// Share of the measured mean square.
    pub explained: f64,
    /// Likeness of the shapes; none where nothing is predicted.
    pub likeness: Option<f64>,
    /// The factor on the prediction that explains most; none where nothing is predicted.
    pub gain: Option<f64>,
    /// Measured minus predicted, m.
    pub residual: Vec<f64>,
    /// Its root mean square, m.
    pub residual_rms: f64,
    /// The largest by size, and its index among the angles, m.
    pub residual_largest: (usize, f64),
}

/// A curve that is smaller than this is zero, m: a billionth of a micrometre.
const NOTHING: f64 = 1e-15;

/// How much of `measured` `predicted` explains; `None` where the measured curve is zero.
pub fn agreement(turn: &Turn, predicted: &[f64], measured: &[f64]) -> Option<Agreement> {
    let of = turn.rms(measured);
    if of < NOTHING {
        return None;
    }
    let residual: Vec<f64> = measured.iter().zip(predicted).map(|(m, p)| m - p).collect();
    let residual_rms = turn.rms(&residual);
    let size = turn.rms(predicted);
    let both = turn.product(measured, predicted);
    let is_there = size >= NOTHING;
    Some(Agreement {
        explained: 1.0 - (residual_rms / of).powi(2),
        likeness: is_there.then(|| (both / (of * size)).clamp(-1.0, 1.0)),
        gain: is_there.then(|| both / (size * size)),
        residual_largest: largest(&residual),
        residual,
        residual_rms,
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn turn() -> Turn {
        Turn::new((0..360).map(|deg| f64::from(deg).to_radians()).collect()).unwrap()
    }

    fn curve(of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..360).map(|deg| of(f64::from(deg).to_radians())).collect()
    }

    #[test]
    fn the_same_curve_explains_all_and_its_mirror_less_than_nothing() {
        let m = curve(|a| 1e-5 * (2.0 * a).cos() + 3e-6 * (5.0 * a).sin());
        let all = agreement(&turn(), &m, &m).unwrap();
        assert_eq!((all.explained, all.residual_rms), (1.0, 0.0));
        assert!((all.likeness.unwrap() - 1.0).abs() < 1e-12 && (all.gain.unwrap() - 1.0).abs() < 1e-12);
        let mirrored: Vec<f64> = m.iter().map(|x| -x).collect();
        let worse = agreement(&turn(), &mirrored, &m).unwrap();
        assert!((worse.explained + 3.0).abs() < 1e-12 && (worse.likeness.unwrap() + 1.0).abs() < 1e-12);
        let nothing = agreement(&turn(), &[0.0; 360], &m).unwrap();
        assert_eq!(
            (nothing.explained, nothing.likeness, nothing.gain),
            (0.0, None, None)
        );
        assert_eq!(agreement(&turn(), &m, &[0.0; 360]), None);
    }

    #[test]
    fn a_curve_of_the_right_size_at_the_wrong_angle_explains_nothing() {
        // Equal amplitudes are not sufficient: a quarter of a wave makes both amplitudes equal and all else wrong.
        let m = curve(|a| 2e-4 * (2.0 * a).cos());
        let p = curve(|a| 2e-4 * (2.0 * a).sin());
        let found = agreement(&turn(), &p, &m).unwrap();
        assert!((found.explained + 1.0).abs() < 1e-12 && found.likeness.unwrap().abs() < 1e-12);
    }

    #[test]
    fn half_of_the_curve_explains_three_quarters_and_the_gain_is_two() {
        let m = curve(|a| 1e-5 * (3.0 * a).cos());
        let half: Vec<f64> = m.iter().map(|x| x / 2.0).collect();
        let found = agreement(&turn(), &half, &m).unwrap();
        assert!((found.explained - 0.75).abs() < 1e-12 && (found.gain.unwrap() - 2.0).abs() < 1e-12);
        assert!((found.likeness.unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn scale_and_start_angle_have_no_effect() {
        let of = |a: f64| 1e-5 * (2.0 * a).cos() + 2e-6 * (7.0 * a).sin();
        let by = |a: f64| 0.8e-5 * (2.0 * a + 0.1).cos();
        let plain = agreement(&turn(), &curve(by), &curve(of)).unwrap();
        let shift = TAU * 37.0 / 360.0;
        for (scale, shift) in [(1e3, 0.0), (1.0, shift), (7.0, shift)] {
            let [p, m] = [curve(|a| scale * by(a + shift)), curve(|a| scale * of(a + shift))];
            let found = agreement(&turn(), &p, &m).unwrap();
            assert!((found.explained - plain.explained).abs() < 1e-12);
            assert!((found.gain.unwrap() - plain.gain.unwrap()).abs() < 1e-12);
        }
    }
}
