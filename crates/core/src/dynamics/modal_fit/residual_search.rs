//! Weak modes: a search in what the modes found so far leave over, until nothing but noise is left.
//!
//! ```text
//! g(omega, zeta) = sum_k (q . r_k)^2 / (s_k |q|)^2 -> most      the candidate: sums over the lines near its peak
//! sum_k n_k / v_k ln( |r_k|^2 / |r'_k|^2 )  >  2 (2 + K) ln( sum n_k )      it is a mode
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `q` | weighted term of a pole at `omega` with `zeta` ([`super::model`]) |
//! | `r_k`, `r'_k` | weighted residuals of FRF k without and with the candidate, all poles refined together |
//! | `s_k`, `n_k`, `K` | as in `refine` and `selection` |
//! | `v_k` | `(1 + rho)/(1 - rho)`, `rho` the correlation of neighbouring `r'_k`, at least 0: `n_k / v_k` values are independent |
//!
//! The limit is twice the penalty of `selection`: the candidate is the best of some thousand, so that noise alone would now and then exceed the simple
//! one. Near a mode, within [`NEAR`] of its half widths, what is left over is an error of its shape (nonlinearity, damping that is not viscous) and no
//! candidate. Weights are those of the coherence, so that lines with little coherence decide little.

use super::denominator::Pole;
use super::frf::Frf;
use super::model::dynamic;
use super::refine::{Refined, refine, squares};
use super::selection::is_physical;

/// Damping ratios that are tried.
const DAMPING: [f64; 4] = [0.003, 0.01, 0.03, 0.08];
/// Frequencies that are tried at most.
const MOST_TRIED: usize = 400;
/// Half widths of the peak of a mode within which there are no further candidates.
const NEAR: f64 = 2.0;
/// Lines near the peak of a candidate, in its half widths, and how many of them are used at most.
const WINDOW: f64 = 10.0;
const MOST_LINES: usize = 400;
/// Modes that are added at most.
const MOST_ADDED: usize = 10;

/// The modes with those that are found in the residuals, up to `most` in all.
pub(super) fn with_weak_modes(frfs: &[Frf], band: [f64; 2], refined: Refined, most: usize) -> Refined {
    let mut current = refined;
    for _ in 0..MOST_ADDED {
        if current.poles.len() >= most {
            break;
        }
        let next = candidate(frfs, band, &current).and_then(|pole| {
            let poles: Vec<Pole> = current.poles.iter().copied().chain([pole]).collect();
            let found = refine(frfs, &poles)?;
            let is_mode = found.poles.iter().all(|pole| is_physical(pole, band))
                && !has_neighbours(&found.poles)
                && gain(frfs, &current, &found) > limit(frfs);
            is_mode.then_some(found)
        });
        match next {
            Some(found) => current = found,
            None => break,
        }
    }
    current
}

/// The pole that would describe most of the residuals; `None` if there is no place for one.
fn candidate(frfs: &[Frf], band: [f64; 2], current: &Refined) -> Option<Pole> {
    let all = &frfs
        .iter()
        .max_by_key(|frf| frf.angular_frequencies.len())?
        .angular_frequencies;
    let stride = all.len().div_ceil(MOST_TRIED);
    let mut best: Option<(f64, Pole)> = None;
    for angular_frequency in all.iter().step_by(stride).copied() {
        for damping_ratio in DAMPING {
            let pole = Pole {
                angular_frequency,
                damping_ratio,
            };
            let is_free =
                is_physical(&pole, band) && current.poles.iter().all(|other| !is_near(other, &pole));
            if !is_free {
                continue;
            }
            let score: f64 = (0..frfs.len())
                .map(|k| described(&frfs[k], current, k, &pole))
                .sum();
            if score.is_finite() && best.is_none_or(|(most, _)| score > most) {
                best = Some((score, pole));
            }
        }
    }
    best.map(|(_, pole)| pole)
}

/// What a pole describes of the residuals of FRF `k` near its peak, in variances.
fn described(frf: &Frf, current: &Refined, k: usize, pole: &Pole) -> f64 {
    let half = WINDOW * pole.damping_ratio * pole.angular_frequency;
    let place = |w: f64| frf.angular_frequencies.partition_point(|own| *own < w);
    let (first, last) = (
        place(pole.angular_frequency - half),
        place(pole.angular_frequency + half),
    );
    let stride = (last - first).div_ceil(MOST_LINES).max(1);
    let residuals = &current.solved[k].residuals;
    let (mut along, mut square) = (0.0, 0.0);
    for line in (first..last).step_by(stride) {
        let term = dynamic(pole, frf.angular_frequencies[line]) * frf.weights[line];
        along += term.re * residuals[2 * line] + term.im * residuals[2 * line + 1];
        square += term.norm_sqr();
    }
    stride as f64 * (along / current.deviations[k]).powi(2) / square
}

/// Whether the other is within the peak of a mode.
fn is_near(mode: &Pole, other: &Pole) -> bool {
    let half = mode.damping_ratio * mode.angular_frequency;
    (mode.angular_frequency - other.angular_frequency).abs() < NEAR * half
}

/// Whether the last mode moved into the peak of another, or so wide that another is in its own.
fn has_neighbours(poles: &[Pole]) -> bool {
    let Some((last, others)) = poles.split_last() else {
        return false;
    };
    others
        .iter()
        .any(|other| is_near(other, last) || is_near(last, other))
}

/// Decrease of the logarithm of the residuals, in independent values.
fn gain(frfs: &[Frf], before: &Refined, after: &Refined) -> f64 {
    let each = (frfs.iter().zip(&before.solved)).zip(&after.solved);
    each.map(|((frf, before), after)| {
        let residuals = &after.residuals;
        let ahead: f64 = (2..residuals.len())
            .map(|k| residuals[k] * residuals[k - 2])
            .sum();
        let rho = (ahead / residuals.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 0.99);
        let independent = residuals.len() as f64 * (1.0 - rho) / (1.0 + rho);
        independent * (squares(frf, before) / squares(frf, after)).ln()
    })
    .sum()
}

/// The least gain of a mode.
fn limit(frfs: &[Frf]) -> f64 {
    let values: usize = frfs.iter().map(|frf| 2 * frf.receptance.len()).sum();
    2.0 * (2.0 + frfs.len() as f64) * (values as f64).ln()
}
