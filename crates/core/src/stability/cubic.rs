//! Reciprocals of the roots of complex polynomials of degree 2 and 3.
//!
//! ```text
//! mu^2 - c_1 mu + c_0 = 0        mu^3 - c_2 mu^2 + c_1 mu - c_0 = 0        x = 1/mu
//! ```
//!
//! A root that is zero up to rounding gives the bound `absent` in place of its reciprocal. The quadratic is solved with the root of
//! larger modulus first, so that no digits cancel; the cubic by Cardano's formula and two steps of Newton's method.

use nalgebra::Complex;

/// Modulus of a root over the largest below which it is zero.
const ZERO: f64 = 1e-14;

/// Reciprocals of the roots of `mu^2 - sum mu + product`, the smaller first.
pub(super) fn roots_of_quadratic(sum: Complex<f64>, product: Complex<f64>, absent: f64) -> [Complex<f64>; 2] {
    let root = (sum * sum - product * 4.0).sqrt();
    // Of both signs the one that adds moduli.
    let aligned = if (sum.conj() * root).re >= 0.0 {
        root
    } else {
        -root
    };
    let large = (sum + aligned) * 0.5;
    if large.norm_sqr() == 0.0 {
        return [Complex::new(absent, 0.0); 2];
    }
    let small = product / large;
    let is_zero = small.norm_sqr() <= (ZERO * ZERO) * large.norm_sqr();
    let second = if is_zero {
        Complex::new(absent, 0.0)
    } else {
        small.inv()
    };
    [large.inv(), second]
}

/// Reciprocals of the roots of `mu^3 - c2 mu^2 + c1 mu - c0`, given `[c2, c1, c0]`.
pub(super) fn roots_of_cubic([c2, c1, c0]: [Complex<f64>; 3], absent: f64) -> [Complex<f64>; 3] {
    let third = c2 / 3.0;
    // mu = third + t:  t^3 + p t + q = 0
    let p = c1 - c2 * c2 / 3.0;
    let q = -(c2 * c2 * c2) * (2.0 / 27.0) + c2 * c1 / 3.0 - c0;
    let root = (q * q * 0.25 + p * p * p / 27.0).sqrt();
    let aligned = if (q.conj() * root).re <= 0.0 { root } else { -root };
    let s = (-q * 0.5 + aligned).cbrt_principal();
    let turn = Complex::new(-0.5, 3.0_f64.sqrt() * 0.5);
    let mut turned = s;
    let found = [0, 1, 2].map(|_| {
        let t = if turned.norm_sqr() == 0.0 {
            turned
        } else {
            turned - p / (turned * 3.0)
        };
        turned *= turn;
        let mut mu = third + t;
        for _ in 0..2 {
            let value = ((mu - c2) * mu + c1) * mu - c0;
            let slope = (mu * 3.0 - c2 * 2.0) * mu + c1;
            if slope.norm_sqr() > 0.0 {
                mu -= value / slope;
            }
        }
        mu
    });
    let largest = found.iter().map(Complex::norm_sqr).fold(0.0, f64::max);
    found.map(|mu| {
        if mu.norm_sqr() <= ZERO * ZERO * largest || mu.norm_sqr() == 0.0 || !mu.is_finite() {
            Complex::new(absent, 0.0)
        } else {
            mu.inv()
        }
    })
}

/// One complex cube root.
trait CubeRoot {
    fn cbrt_principal(self) -> Self;
}

impl CubeRoot for Complex<f64> {
    fn cbrt_principal(self) -> Self {
        let (modulus, angle) = self.to_polar();
        Complex::from_polar(modulus.cbrt(), angle / 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn c(re: f64, im: f64) -> Complex<f64> {
        Complex::new(re, im)
    }

    #[test]
    fn roots_come_back_from_the_coefficients_that_they_make() {
        for roots in [
            [c(1.0, 2.0), c(-3.0, 0.5), c(0.2, -0.1)],
            [c(1.0, 0.0), c(-1.0, 0.0), c(0.0, 1.0)],
            [c(5.0, 1.0), c(5.001, 1.0), c(-2.0, 3.0)],
            [c(1e-9, 2e-9), c(3e-9, 0.0), c(-1e-9, 1e-9)],
        ] {
            let [a, b, d] = roots;
            let found = roots_of_cubic([a + b + d, a * b + a * d + b * d, a * b * d], 1e30);
            for root in roots {
                let nearest = found
                    .iter()
                    .map(|x| (x.inv() - root).norm())
                    .fold(f64::INFINITY, f64::min);
                // Two roots that differ by 1/5000 lose half of the digits that this takes.
                assert!(nearest < 1e-9 * root.norm(), "{root} {found:?}");
            }
            let [first, second] = roots_of_quadratic(a + b, a * b, 1e30).map(|x| x.inv());
            assert!((first + second - a - b).norm() < 1e-14 * (a + b).norm().max(a.norm()));
            assert!((first * second - a * b).norm() < 1e-14 * (a * b).norm());
        }
    }

    #[test]
    fn a_root_of_zero_is_absent() {
        assert_eq!(
            roots_of_quadratic(c(2.0, 1.0), c(0.0, 0.0), 1e30)[1],
            c(1e30, 0.0)
        );
        assert_eq!(
            roots_of_quadratic(c(0.0, 0.0), c(0.0, 0.0), 1e30),
            [c(1e30, 0.0); 2]
        );
        let found = roots_of_cubic([c(2.0, 1.0), c(0.5, 0.1), c(0.0, 0.0)], 1e30);
        assert_eq!(found.iter().filter(|x| x.norm() > 1e20).count(), 1);
    }
}
