//! How many modes the FRFs determine.
//!
//! ```text
//! BIC = sum_k n_k ln( |r_k|^2 ) + p ln( sum n_k )        p = N (2 + K) + 2 K
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `n_k`, `r_k` | weighted real and imaginary parts of FRF k, their residuals |
//! | `N`, `K`, `p` | modes, FRFs, parameters |
//!
//! All candidates are fitted; then the mode whose removal increases the criterion least is removed, as long as this lowers the criterion, or
//! until the requested number is reached. A mode that is left must lower it relative to no mode. Source: Schwarz 1978 (recalled).

use super::denominator::Pole;
use super::frf::Frf;
use super::model::{Solved, columns, solve};
use super::refine::{Refined, refine, squares};
use super::stable::LARGEST_DAMPING;

/// The selected modes, refined together; `None` if no set of them can be fitted.
pub(super) fn select(
    frfs: &[Frf],
    band: [f64; 2],
    candidates: &[Pole],
    requested: Option<usize>,
) -> Option<Refined> {
    let mut poles = candidates.to_vec();
    let mut current = loop {
        if poles.is_empty() {
            return None;
        }
        match refine(frfs, &poles) {
            Some(found) if found.poles.iter().all(|pole| is_physical(pole, band)) => break found,
            Some(found) => {
                // A pole that left its range describes noise or a residual.
                let kept = found.poles.iter().zip(&poles);
                poles = kept
                    .filter(|(pole, _)| is_physical(pole, band))
                    .map(|(_, start)| *start)
                    .collect();
            }
            None => {
                poles.pop()?;
            }
        }
    };
    let least = requested.unwrap_or(1).max(1);
    while current.poles.len() > least {
        let without = (0..current.poles.len()).filter_map(|left_out| {
            let mut fewer = current.poles.clone();
            fewer.remove(left_out);
            let found = refine(frfs, &fewer)?;
            let is_valid = found.poles.iter().all(|pole| is_physical(pole, band));
            is_valid.then(|| (criterion(frfs, &found), found))
        });
        let Some((least_criterion, fewer)) = without.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            break;
        };
        if requested.is_none() && least_criterion >= criterion(frfs, &current) {
            break;
        }
        current = fewer;
    }
    let is_something = requested.is_some() || criterion(frfs, &current) < criterion_without_modes(frfs)?;
    is_something.then_some(current)
}

/// The criterion of the residual terms alone; `None` if the FRFs do not determine them.
fn criterion_without_modes(frfs: &[Frf]) -> Option<f64> {
    let solved: Option<Vec<Solved>> = frfs.iter().map(|frf| solve(frf, &columns(frf, &[]))).collect();
    Some(criterion_of(frfs, &solved?, 0))
}

/// Whether a pole is inside the band, and vibrates.
pub(super) fn is_physical(pole: &Pole, band: [f64; 2]) -> bool {
    (band[0]..=band[1]).contains(&pole.angular_frequency) && pole.damping_ratio < LARGEST_DAMPING
}

fn criterion(frfs: &[Frf], refined: &Refined) -> f64 {
    criterion_of(frfs, &refined.solved, refined.poles.len())
}

fn criterion_of(frfs: &[Frf], solved: &[Solved], modes: usize) -> f64 {
    let (mut sum, mut values) = (0.0, 0.0);
    for (frf, solved) in frfs.iter().zip(solved) {
        let count = solved.residuals.len() as f64;
        sum += count * squares(frf, solved).ln();
        values += count;
    }
    let (modes, count) = (modes as f64, frfs.len() as f64);
    sum + (modes * (2.0 + count) + 2.0 * count) * values.ln()
}
