//! The whole budget: contributions, their sums, and the comparison with the measured part.
//!
//! All curves are reduced to one datum first, each by its own centre and radius, as far as those are removed. The
//! known scatter limits the explained share of any prediction:
//!
//! ```text
//! explainable   = 1 - (<s, s> + u_m^2) / <m, m>
//! beyond        = root of (<e, e> - <s, s> - u_m^2 - u_b^2), 0 where that is negative         e = m - sum of b_i
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `s` | scatter of all contributions together | m |
//! | `u_m` | standard uncertainty of a measured point | m |
//! | `u_b` | of the biases together, round the circle | m |
//! | `e` | residual | m |

use super::agreement::{Agreement, agreement};
use super::contribution::{Contribution, Sums, bias_of};
use super::datum::{Datum, Removed};
use super::turn::Turn;
use super::waves::{WavePair, least_amplitude, pairs, turns_as_good};

/// Contributions, their sums, and the measured part.
#[derive(Clone, Debug, PartialEq)]
pub struct Balance {
    /// From their datum.
    pub contributions: Vec<Contribution>,
    /// The datum removed from each.
    pub datums: Vec<Datum>,
    /// Their sums.
    pub sums: Sums,
    /// The measured part; none where none was measured, or nothing remains of it without its datum.
    pub comparison: Option<Comparison>,
}

/// The measured part compared with the prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Measured, from its datum, m.
    pub measured: Vec<f64>,
    /// The datum removed from it.
    pub datum: Datum,
    /// Its root mean square, m.
    pub measured_rms: f64,
    /// Agreement with the sum of all contributions.
    pub together: Agreement,
    /// Agreement of each contribution.
    pub shares: Vec<Share>,
    /// Share that could be explained if all biases were known: the rest is scatter.
    pub explainable: f64,
    /// Root mean square of the residual beyond all known scatter and uncertainty, m.
    pub beyond_known: f64,
    /// Wave by wave.
    pub waves: Vec<WavePair>,
    /// Waves of less amplitude are not reported, m.
    pub least_wave: f64,
    /// Share of all rotations of the prediction with the same or a better agreement; none without waves.
    pub turns_as_good: Option<f64>,
}

/// Agreement of one contribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Of this contribution alone.
    pub alone: f64,
    /// Of all others without it.
    pub without: f64,
}

/// The budget of `contributions`, and its agreement with `measured` (its curve, and the standard uncertainty of a
/// point; m), waves up to `most`.
pub fn balance(
    turn: &Turn,
    contributions: Vec<Contribution>,
    measured: Option<(&[f64], f64)>,
    removed: Removed,
    most: usize,
) -> Balance {
    let removed_from = |one: Contribution| {
        let (datum, bias) = Datum::remove(turn, &one.bias, removed);
        (Contribution { bias, ..one }, datum)
    };
    let (contributions, datums): (Vec<_>, Vec<_>) = contributions.into_iter().map(removed_from).unzip();
    let sums = Sums::of(&contributions, turn.angle().len());
    let comparison = measured.and_then(|(curve, u)| {
        let (datum, curve) = Datum::remove(turn, curve, removed);
        let measured = MeasuredCurve { curve, datum, u };
        compare(turn, &contributions, &sums, measured, most)
    });
    Balance {
        contributions,
        datums,
        sums,
        comparison,
    }
}

/// A measured curve without its datum, m.
struct MeasuredCurve {
    curve: Vec<f64>,
    datum: Datum,
    /// Standard uncertainty of a point, m.
    u: f64,
}

fn compare(
    turn: &Turn,
    contributions: &[Contribution],
    sums: &Sums,
    measured: MeasuredCurve,
    most: usize,
) -> Option<Comparison> {
    let MeasuredCurve {
        curve: measured,
        datum,
        u,
    } = measured;
    let together = agreement(turn, &sums.bias, &measured)?;
    let measured_rms = turn.rms(&measured);
    let share = |index: usize| {
        let others = contributions
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != index);
        let without = bias_of(others.map(|(_, one)| one), measured.len());
        Some(Share {
            alone: agreement(turn, &contributions[index].bias, &measured)?.explained,
            without: agreement(turn, &without, &measured)?.explained,
        })
    };
    let scatter = turn.rms(&sums.scatter).powi(2) + u * u;
    let waves = pairs(turn, &sums.bias, &measured, most);
    Some(Comparison {
        shares: (0..contributions.len()).map(share).collect::<Option<_>>()?,
        explainable: 1.0 - scatter / measured_rms.powi(2),
        beyond_known: (together.residual_rms.powi(2) - scatter - sums.u.powi(2))
            .max(0.0)
            .sqrt(),
        least_wave: least_amplitude(&waves, scatter.sqrt(), measured.len()),
        turns_as_good: turns_as_good(&waves),
        waves,
        measured_rms,
        together,
        measured,
        datum,
    })
}

#[cfg(test)]
mod tests {
    use super::super::contribution::Origin;
    use super::*;

    const BOTH: Removed = Removed {
        centre: true,
        radius: true,
    };

    fn turn() -> Turn {
        Turn::new((0..720).map(|k| (f64::from(k) / 2.0).to_radians()).collect()).unwrap()
    }

    fn curve(of: impl Fn(f64) -> f64) -> Vec<f64> {
        turn().angle().iter().map(|a| of(*a)).collect()
    }

    fn one(origin: Origin, of: impl Fn(f64) -> f64, scatter: f64) -> Contribution {
        Contribution {
            name: "one".to_owned(),
            origin,
            bias: curve(of),
            scatter: vec![scatter; 720],
            u: None,
        }
    }

    fn load(a: f64) -> f64 {
        6e-5 * (2.0 * a).cos() + 1e-5 * a.cos()
    }

    fn path(a: f64) -> f64 {
        9e-5 * (2.0 * a - 1.0).sin() + 4e-5 * a.sin().signum() + 2e-5
    }

    fn parts(scatter: f64) -> Vec<Contribution> {
        vec![one(Origin::Load, load, 0.0), one(Origin::Unloaded, path, scatter)]
    }

    /// Random noise of standard deviation 1: sums of twelve numbers from 0 to 1, less 6.
    fn noise(seed: u64) -> Vec<f64> {
        let mut state = seed << 32;
        let mut next = || {
            // SplitMix64: neighbouring seeds are independent.
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..720)
            .map(|_| (0..12).map(|_| next()).sum::<f64>() - 6.0)
            .collect()
    }

    #[test]
    fn parts_that_sum_up_to_the_measurement_explain_all_of_it_whatever_the_centre() {
        let measured = curve(|a| load(a) + path(a) + 3e-4 * a.cos() - 2e-4 * a.sin() + 5e-5);
        let found = balance(&turn(), parts(0.0), Some((&measured, 0.0)), BOTH, 10);
        let given = found.comparison.unwrap();
        assert!((given.together.explained - 1.0).abs() < 1e-12 && given.together.residual_rms < 1e-12);
        assert!(given.explainable == 1.0 && given.beyond_known < 1e-12);
        for share in &given.shares {
            assert!(share.alone < 0.9 && share.without < 0.9);
        }
        // The share of one alone is the share that all others lack.
        assert_eq!(given.shares[0].alone, given.shares[1].without);
        let wave = given.waves[1];
        assert!(wave.phase_difference().abs() < 1e-9 && (wave.explained().unwrap() - 1.0).abs() < 1e-9);
        // If it is kept, the centre of the part is an error like any other.
        let none = Removed {
            centre: false,
            radius: false,
        };
        let kept = balance(&turn(), parts(0.0), Some((&measured, 0.0)), none, 10);
        assert!(kept.comparison.unwrap().together.explained < 0.2);
    }

    #[test]
    fn independent_noise_increases_the_residual_by_its_own_size() {
        let sigma = 3e-5;
        let (mut off, mut beyond) = (Vec::new(), Vec::new());
        for seed in 1..40 {
            let noise = noise(seed);
            let clean = curve(|a| load(a) + path(a));
            let measured: Vec<f64> = clean.iter().zip(&noise).map(|(c, n)| c + sigma * n).collect();
            let found = balance(&turn(), parts(sigma), Some((&measured, 0.0)), BOTH, 10);
            let given = found.comparison.unwrap();
            off.push(given.together.explained - given.explainable);
            beyond.push(given.beyond_known);
        }
        // 1 - sigma^2 / <m, m> in the mean. One turn of 720 points deviates by a twentieth of the rest, and by twice
        // the random correlation of noise and signal: together a fiftieth.
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        assert!(mean.abs() < 1e-2, "{mean}");
        assert!(off.iter().all(|off| off.abs() < 0.06), "{off:?}");
        assert!(beyond.iter().all(|beyond| *beyond < 0.5 * sigma), "{beyond:?}");
    }

    #[test]
    fn the_uncertainty_of_measured_points_is_scatter_too() {
        let measured = curve(|a| load(a) + path(a) + 1e-5 * (9.0 * a).cos());
        let [sharp, blurred] = [0.0, 1e-5].map(|u| {
            let found = balance(&turn(), parts(0.0), Some((&measured, u)), BOTH, 10);
            found.comparison.unwrap()
        });
        assert_eq!(sharp.together.explained, blurred.together.explained);
        assert!(blurred.explainable < sharp.explainable && blurred.beyond_known == 0.0);
        assert!((sharp.beyond_known - 1e-5 / 2.0_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn without_a_measured_form_there_is_no_comparison() {
        let found = balance(&turn(), parts(0.0), None, BOTH, 10);
        assert_eq!(found.comparison, None);
        // A shifted circle has no form.
        let shifted = curve(|a| 1e-4 * a.cos());
        assert_eq!(
            balance(&turn(), parts(0.0), Some((&shifted, 0.0)), BOTH, 10).comparison,
            None
        );
        let alone = balance(&turn(), Vec::new(), Some((&curve(load), 0.0)), BOTH, 10);
        assert_eq!(alone.comparison.unwrap().together.explained, 0.0);
    }
}
