//! Gauss-Legendre quadrature with 16 nodes: exact for polynomials up to degree 31.
//!
//! Source: roots of the Legendre polynomial of degree 16 by Newton's method in 40 digits, rounded.

/// Nodes in (0, 1) and their weights on (-1, 1); the other eight are their mirror images.
const NODES_AND_WEIGHTS: [[f64; 2]; 8] = [
    [0.989_400_934_991_649_9, 0.027_152_459_411_754_093],
    [0.944_575_023_073_232_6, 0.062_253_523_938_647_894],
    [0.865_631_202_387_831_8, 0.095_158_511_682_492_79],
    [0.755_404_408_355_003, 0.124_628_971_255_533_88],
    [0.617_876_244_402_643_8, 0.149_595_988_816_576_74],
    [0.458_016_777_657_227_37, 0.169_156_519_395_002_54],
    [0.281_603_550_779_258_9, 0.182_603_415_044_923_58],
    [0.095_012_509_837_637_44, 0.189_450_610_455_068_5],
];

/// Nodes and weights on (0, 1).
pub(super) fn unit_nodes() -> impl Iterator<Item = (f64, f64)> {
    NODES_AND_WEIGHTS
        .iter()
        .flat_map(|[x, w]| [(0.5 * (1.0 - x), 0.5 * w), (0.5 * (1.0 + x), 0.5 * w)])
}

/// Nodes and weights on (`from`, `to`), for functions that begin like a square root at `from`.
pub(super) fn nodes_from_root(from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    // x = from + (to - from) t^2 makes a root of x - from a polynomial of t.
    unit_nodes().map(move |(t, w)| (from + (to - from) * t * t, (to - from) * 2.0 * t * w))
}

/// Nodes and weights on (`from`, `to`), for functions that begin or end like a power.
pub(super) fn nodes_between_powers(from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    // t^2 (3 - 2 t) comes in and goes out level, which smooths either end.
    unit_nodes().map(move |(t, w)| {
        let s = t * t * (3.0 - 2.0 * t);
        (from + (to - from) * s, (to - from) * 6.0 * t * (1.0 - t) * w)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_degree_31_are_exact() {
        for degree in 0..=31 {
            let sum: f64 = unit_nodes().map(|(t, w)| w * t.powi(degree)).sum();
            let exact = 1.0 / f64::from(degree + 1);
            // Sixteen terms, each rounded.
            assert!((sum - exact).abs() < 16.0 * f64::EPSILON, "degree {degree}");
        }
        let sum: f64 = unit_nodes().map(|(t, w)| w * t.powi(34)).sum();
        assert_ne!(sum, 1.0 / 35.0, "nodes of sixteen cannot be exact there");
    }

    #[test]
    fn roots_and_powers_at_the_ends_lose_nothing() {
        let root: f64 = nodes_from_root(1.0, 3.0).map(|(x, w)| w * (x - 1.0).sqrt()).sum();
        // The integral is 2/3 2^1.5; in t the integrand is a polynomial.
        assert!((root - 2.0 / 3.0 * 8_f64.sqrt()).abs() < 1e-14);
        let power: f64 = nodes_between_powers(0.0, 1.0)
            .map(|(x, w)| w * x.powf(0.75))
            .sum();
        // In t the integrand begins like t^2.5: the error falls with the seventh power of 16 nodes, here twice that.
        assert!((power - 1.0 / 1.75).abs() < 3.0 * 16_f64.powi(-7), "{power}");
    }
}
