//! Least squares with some unknowns bounded below by zero.
//!
//! `min |A x - b|` with `x_j >= 0` where `bounded[j]`. Lawson & Hanson 1974, *Solving Least Squares Problems*,
//! algorithm NNLS, with unknowns that are free from the start. Each set of unknowns is solved by Householder QR of
//! columns scaled to length one.

use nalgebra::{DMatrix, DVector};

/// A column whose part beyond the others is smaller than this share of it is dependent on them.
const DEPENDENT: f64 = 1e-9;

/// The solution; `None` where free unknowns depend on each other.
pub(super) fn solve(a: &DMatrix<f64>, b: &DVector<f64>, bounded: &[bool]) -> Option<DVector<f64>> {
    let count = a.ncols();
    let lengths: Vec<f64> = (0..count)
        .map(|j| a.column(j).norm())
        .map(|length| if length > 0.0 { length } else { 1.0 })
        .collect();
    let scaled = DMatrix::from_fn(a.nrows(), count, |i, j| a[(i, j)] / lengths[j]);
    let mut used: Vec<bool> = bounded.iter().map(|bound| !bound).collect();
    let mut refused = vec![false; count];
    let mut x = least_squares(&scaled, b, &used)?;
    // What rounding leaves of a gradient that is zero.
    let zero = b.norm() * f64::EPSILON * (a.nrows() as f64);
    // Each round adds one unknown; by their finite number it ends, this is only a fence.
    for _ in 0..3 * count + 3 {
        let gradient = scaled.tr_mul(&(b - &scaled * &x));
        let candidate = (0..count)
            .filter(|j| !used[*j] && !refused[*j] && gradient[*j] > zero)
            .max_by(|i, j| gradient[*i].total_cmp(&gradient[*j]));
        let Some(entering) = candidate else { break };
        used[entering] = true;
        match step(&scaled, b, bounded, &mut used, &x) {
            // An unknown that enters and leaves at once would enter again for ever.
            Some(next) => {
                refused[entering] = !used[entering];
                if !refused[entering] {
                    refused.fill(false);
                }
                x = next;
            }
            None => {
                used[entering] = false;
                refused[entering] = true;
            }
        }
    }
    Some(DVector::from_fn(count, |j, _| x[j] / lengths[j]))
}

/// From `x` towards the solution of the used unknowns; those that reach zero on the way are dropped.
fn step(
    a: &DMatrix<f64>,
    b: &DVector<f64>,
    bounded: &[bool],
    used: &mut [bool],
    x: &DVector<f64>,
) -> Option<DVector<f64>> {
    let mut x = x.clone();
    loop {
        let target = least_squares(a, b, used)?;
        let negative = |j: &usize| used[*j] && bounded[*j] && target[*j] <= 0.0;
        let part = (0..x.len())
            .filter(negative)
            .map(|j| (x[j] / (x[j] - target[j])).clamp(0.0, 1.0))
            .min_by(f64::total_cmp);
        let Some(part) = part.filter(|part| part.is_finite()) else {
            return Some(target.map_with_location(|j, _, value| if used[j] { value } else { 0.0 }));
        };
        let next = &x + (&target - &x) * part;
        let least = (0..x.len())
            .filter(negative)
            .min_by(|i, j| next[*i].total_cmp(&next[*j]));
        for j in 0..x.len() {
            if used[j] && bounded[j] && (next[j] <= 0.0 || least == Some(j)) {
                used[j] = false;
            }
        }
        x = next.map_with_location(|j, _, value| if used[j] { value } else { 0.0 });
    }
}

/// Plain least squares over the used columns; zero elsewhere. `None` where these depend on each other.
fn least_squares(a: &DMatrix<f64>, b: &DVector<f64>, used: &[bool]) -> Option<DVector<f64>> {
    let columns: Vec<usize> = (0..a.ncols()).filter(|j| used[*j]).collect();
    let mut x = DVector::zeros(a.ncols());
    if columns.is_empty() {
        return Some(x);
    }
    if columns.len() > a.nrows() {
        return None;
    }
    let qr = a.select_columns(&columns).qr();
    let r = qr.r();
    if r.diagonal().iter().any(|d| d.abs() < DEPENDENT) {
        return None;
    }
    let mut right = b.clone();
    qr.q_tr_mul(&mut right);
    let solved = r.solve_upper_triangular(&right.rows(0, columns.len()).into_owned())?;
    for (place, j) in columns.into_iter().enumerate() {
        x[j] = solved[place];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(rows: usize, columns: usize, seed: u64) -> DMatrix<f64> {
        // SplitMix64, in -1..1.
        let mut state = seed;
        DMatrix::from_fn(rows, columns, |_, _| {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
    }

    #[test]
    fn the_solution_meets_the_conditions_of_karush_kuhn_and_tucker() {
        for seed in 0..300 {
            let a = numbers(20, 9, seed);
            let b = numbers(20, 1, seed + 1000).column(0).into_owned();
            let bounded: Vec<bool> = (0..9).map(|j| j != 2 && j != 5).collect();
            let x = solve(&a, &b, &bounded).unwrap();
            let gradient = a.tr_mul(&(&b - &a * &x));
            for j in 0..9 {
                let where_ = format!("seed {seed}, unknown {j}: {} with gradient {}", x[j], gradient[j]);
                if bounded[j] && x[j] == 0.0 {
                    assert!(gradient[j] < 1e-12, "{where_}");
                } else {
                    assert!(gradient[j].abs() < 1e-12, "{where_}");
                    assert!(!bounded[j] || x[j] > 0.0, "{where_}");
                }
            }
        }
    }

    #[test]
    fn no_other_combination_of_columns_is_nearer() {
        let a = numbers(12, 4, 7);
        let b = numbers(12, 1, 8).column(0).into_owned();
        let x = solve(&a, &b, &[true; 4]).unwrap();
        let best = (&a * &x - &b).norm();
        for seed in 0..500 {
            let other = numbers(4, 1, 50 + seed).column(0).map(f64::abs);
            assert!((&a * other - &b).norm() >= best - 1e-12);
        }
    }

    #[test]
    fn equal_columns_do_not_confuse_it() {
        let mut a = numbers(10, 3, 3);
        let first = a.column(0).into_owned();
        a.set_column(2, &first);
        let b = &first * 2.0 + a.column(1) * 0.5;
        let x = solve(&a, &b, &[true; 3]).unwrap();
        assert!((&a * x - b).norm() < 1e-12);
    }

    #[test]
    fn dependent_free_unknowns_are_reported() {
        let mut a = numbers(10, 2, 3);
        let first = a.column(0).into_owned();
        a.set_column(1, &first);
        assert_eq!(solve(&a, &first, &[false, false]), None);
    }
}
