use super::*;
use crate::arms::Stream;

/// Rows and right-hand side that the script of the witness computes too.
fn wavy() -> (Vec<[f64; 3]>, Vec<f64>) {
    let row = |i: i32| {
        let i = f64::from(i);
        [1.0, (0.37 * i).sin(), (0.11 * i * i).cos()]
    };
    let right = |i: i32| 3.0 * (0.9 * f64::from(i) + 0.2).sin() + 0.05 * f64::from(i);
    ((0..60).map(row).collect(), (0..60).map(right).collect())
}

/// Checks both sides of the proof against the rows themselves.
fn prove<const M: usize>(rows: &[[f64; M]], right: &[f64], found: &Minimax<M>) {
    let scale = right.iter().fold(0.0_f64, |most, b| most.max(b.abs()));
    let total: f64 = found.support.iter().map(|s| s.multiplier).sum();
    let by_rows: f64 = (found.support.iter())
        .map(|s| s.multiplier * s.sign * right[s.row])
        .sum();
    assert!(found.support.iter().all(|s| s.multiplier >= 0.0));
    assert!(
        (total - 1.0).abs() < 1e-9 && (by_rows - found.proven).abs() < 1e-9 * scale,
        "{found:?}"
    );
    for k in 0..M {
        let column: f64 = (found.support.iter())
            .map(|s| s.multiplier * s.sign * rows[s.row][k])
            .sum();
        let largest = rows.iter().fold(0.0_f64, |most, row| most.max(row[k].abs()));
        assert!(column.abs() < 1e-9 * largest, "{k}: {column}");
    }
    assert!((found.level - found.proven).abs() < 1e-12 * scale, "{found:?}");
}

/// Witness: scipy.optimize.linprog (HiGHS) on the same rows, tolerance 1e-7 of its own, digits as printed.
#[test]
fn the_optimum_is_that_of_another_solver() {
    let (rows, right) = wavy();
    let found = minimax(&rows, &right, ResidualSide::Both).unwrap();
    let theirs = [
        1.678_400_074_106_096_3,
        -0.196_458_581_874_689_92,
        0.421_936_113_614_455_8,
    ];
    for (own, theirs) in found.unknowns.iter().zip(theirs) {
        assert!((own - theirs).abs() < 1e-9, "{found:?}");
    }
    assert!((found.level - 3.849_322_530_195_790_3).abs() < 1e-9);
    prove(&rows, &right, &found);
    let one_sided: Vec<[f64; 2]> = rows.iter().map(|row| [row[1], row[2]]).collect();
    let found = minimax(&one_sided, &right, ResidualSide::Above).unwrap();
    let theirs = [0.188_395_130_006_241_72, 0.249_616_943_095_874_23];
    for (own, theirs) in found.unknowns.iter().zip(theirs) {
        assert!((own - theirs).abs() < 1e-9, "{found:?}");
    }
    assert!((found.level - 5.351_882_095_734_239).abs() < 1e-9);
    prove(&one_sided, &right, &found);
}

/// Chebyshev: of polynomials of degree n - 1, the best for t^n on [-1, 1] is off by 2^(1 - n), at n + 1 points.
#[test]
fn the_best_polynomial_leaves_the_chebyshev_polynomial() {
    let at = |k: i32| (std::f64::consts::PI * f64::from(k) / 3000.0).cos();
    let rows: Vec<[f64; 5]> = (0..=3000)
        .map(|k| std::array::from_fn(|power| at(k).powi(power as i32)))
        .collect();
    let right: Vec<f64> = (0..=3000).map(|k| at(k).powi(5)).collect();
    let found = minimax(&rows, &right, ResidualSide::Both).unwrap();
    assert!((found.level - 1.0 / 16.0).abs() < 1e-13, "{found:?}");
    prove(&rows, &right, &found);
}

/// Four points of which three are on a line give a multiplier of 0: on a grid nearly every exchange is like this.
#[test]
fn grids_with_many_equal_values_end_with_a_proof() {
    for levels in [1, 2, 3, 7] {
        let mut stream = Stream(levels);
        let (mut rows, mut right) = (Vec::new(), Vec::new());
        for i in 0..30 {
            for j in 0..30 {
                rows.push([1.0, f64::from(i), f64::from(j)]);
                right.push((stream.next() * levels as f64).round());
            }
        }
        let found = minimax(&rows, &right, ResidualSide::Both).unwrap();
        prove(&rows, &right, &found);
        assert!(found.exchanges < 200, "{levels}: {}", found.exchanges);
    }
}

#[test]
fn random_rows_of_seven_unknowns_are_proven_and_scaling_scales() {
    for seed in 0..20 {
        let mut stream = Stream(seed);
        let rows: Vec<[f64; 7]> = (0..400)
            .map(|_| std::array::from_fn(|_| stream.normal()))
            .collect();
        let right: Vec<f64> = (0..400).map(|_| stream.normal()).collect();
        let found = minimax(&rows, &right, ResidualSide::Both).unwrap();
        prove(&rows, &right, &found);
        let scaled: Vec<[f64; 7]> = rows
            .iter()
            .map(|row| std::array::from_fn(|k| row[k] * 10f64.powi(k as i32)))
            .collect();
        let small: Vec<f64> = right.iter().map(|b| b * 1e-6).collect();
        let other = minimax(&scaled, &small, ResidualSide::Both).unwrap();
        assert!((other.level * 1e6 - found.level).abs() < 1e-10, "{seed}");
    }
}

#[test]
fn exact_rows_have_the_level_zero() {
    let rows: Vec<[f64; 2]> = (0..9).map(|i| [1.0, f64::from(i)]).collect();
    let right: Vec<f64> = (0..9).map(|i| 2.0 + 3.0 * f64::from(i)).collect();
    let found = minimax(&rows, &right, ResidualSide::Both).unwrap();
    assert!(
        found.level < 1e-13 && (found.unknowns[1] - 3.0).abs() < 1e-13,
        "{found:?}"
    );
    let none = minimax(&rows, &[0.0; 9], ResidualSide::Both).unwrap();
    assert_eq!((none.level, none.unknowns), (0.0, [0.0; 2]));
}

#[test]
fn rows_without_a_solution_are_refused() {
    let line: Vec<[f64; 2]> = (0..9).map(|i| [1.0, f64::from(i)]).collect();
    let both = |rows: &[[f64; 2]], right: &[f64]| minimax(rows, right, ResidualSide::Both).unwrap_err();
    assert_eq!(both(&line, &[0.0; 8]), FormError::Lengths { needed: 9, given: 8 });
    assert_eq!(
        both(&line[..1], &[0.0]),
        FormError::TooFew { needed: 2, given: 1 }
    );
    let mut right = [1.0; 9];
    right[4] = f64::NAN;
    assert_eq!(both(&line, &right), FormError::NotFinite { index: 4 });
    let same = [[1.0, 2.0]; 9];
    assert_eq!(
        both(&same, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]),
        FormError::Undetermined
    );
    // With a constant, one-sided residuals fall without limit.
    let right: Vec<f64> = (0..9).map(|i| f64::from(i % 3)).collect();
    assert_eq!(
        minimax(&line, &right, ResidualSide::Above).unwrap_err(),
        FormError::OneSided
    );
}

#[test]
fn many_rows_need_few_exchanges() {
    let mut stream = Stream(9);
    let rows: Vec<[f64; 3]> = (0..200_000)
        .map(|_| [1.0, stream.between(-1.0, 1.0), stream.between(-1.0, 1.0)])
        .collect();
    let right: Vec<f64> = rows
        .iter()
        .map(|row| 1e-6 * stream.normal() + 1e-5 * row[1] * row[2])
        .collect();
    let found = minimax(&rows, &right, ResidualSide::Both).unwrap();
    prove(&rows, &right, &found);
    assert!(found.exchanges < 60, "{}", found.exchanges);
}
