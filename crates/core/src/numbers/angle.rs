//! Angles without branches: arc tangent of two numbers, sine and cosine.
//!
//! Minimax polynomials, found with the Remez exchange in 40 digits: `atan z = z + z^3 P(z^2)` on
//! |z| <= tan(pi/8) with relative error 1.3e-18, `sin` and `cos` on |x| <= pi/4 with 3.5e-18 and 5e-20 of the
//! series' rest. What remains is rounding: below 9e-16 rad for [`atan2`], 2e-16 for [`sin_cos`] up to 1e5 rad.

use super::real::{Float, Real};

const ATAN: [f64; 11] = [
    -0.333_333_333_333_332,
    0.199_999_999_999_540_82,
    -0.142_857_142_802_485_51,
    0.111_111_107_861_396_18,
    -0.090_908_978_364_939_48,
    0.076_920_616_378_323_4,
    -0.066_631_203_912_898_65,
    0.058_480_089_658_309_746,
    -0.050_398_457_204_483_1,
    0.038_078_326_004_415_346,
    -0.017_922_284_615_051_777,
];
const SIN: [f64; 6] = [
    -0.166_666_666_666_666_32,
    0.008_333_333_333_322_425,
    -0.000_198_412_698_298_169_53,
    2.755_731_369_522_703e-6,
    -2.505_075_865_331_895_3e-8,
    1.589_682_793_031_656_1e-10,
];
const COS: [f64; 6] = [
    0.041_666_666_666_666_6,
    -0.001_388_888_888_887_413_8,
    2.480_158_728_949_183_7e-5,
    -2.755_731_435_524_500_7e-7,
    2.087_572_368_485_145_3e-9,
    -1.135_966_988_891_097e-11,
];

/// tan(pi/8).
const TAN_PI_8: f64 = 0.414_213_562_373_095_1;
/// pi/2 in three parts, the first two with zeros at the end, so that whole multiples of them are exact.
const QUARTER: [f64; 3] = [
    1.570_796_325_802_803,
    9.920_935_791_635_221e-10,
    5.170_182_981_794_105e-19,
];

/// Polynomial in `x`, lowest coefficient first.
#[inline(always)]
fn polynomial<R: Real, const N: usize>(x: R, coefficients: [f64; N]) -> R {
    let mut sum = R::of(coefficients[N - 1]);
    let mut k = N - 1;
    while k > 0 {
        k -= 1;
        sum = sum.mul_add(x, R::of(coefficients[k]));
    }
    sum
}

/// The angle of the vector (`x`, `y`), rad, in [-pi, pi]; zero where it has no length.
#[inline(always)]
pub(crate) fn atan2<R: Real>(y: R, x: R) -> R {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    let zero = R::of(0.0);
    let (ax, ay) = (x.abs(), y.abs());
    let (greater, lesser) = (ax.max(ay), ax.min(ay));
    // Above pi/8 the angle is computed from pi/4.
    let from_diagonal = lesser > greater * R::of(TAN_PI_8);
    let top = R::either(from_diagonal, lesser - greater, lesser);
    let bottom = R::either(from_diagonal, lesser + greater, greater);
    let start = R::either(from_diagonal, R::of(FRAC_PI_4), zero);
    let z = top / bottom.max(R::of(<R::Float as Float>::LEAST));
    let z2 = z * z;
    let angle = start + (z * z2).mul_add(polynomial(z2, ATAN), z);
    let angle = R::either(ay > ax, R::of(FRAC_PI_2) - angle, angle);
    let angle = R::either(x < zero, R::of(PI) - angle, angle);
    R::either(y < zero, -angle, angle)
}

/// Sine and cosine of `angle` (rad).
#[inline(always)]
pub(crate) fn sin_cos<R: Real>(angle: R) -> (R, R) {
    let quarters = (angle * R::of(std::f64::consts::FRAC_2_PI)).round();
    let x = (-quarters).mul_add(R::of(QUARTER[0]), angle);
    let x = (-quarters).mul_add(R::of(QUARTER[1]), x);
    let x = (-quarters).mul_add(R::of(QUARTER[2]), x);
    let x2 = x * x;
    let sin = (x * x2).mul_add(polynomial(x2, SIN), x);
    let cos = (x2 * x2).mul_add(polynomial(x2, COS), x2.mul_add(R::of(-0.5), R::of(1.0)));
    // quarters modulo 4 is 0, 1, 2 or 3, decoded by halves: odd swaps the two, and each has its sign.
    let half = quarters * R::of(0.5);
    let odd = half.round() != half;
    let left = quarters - R::of(4.0) * (quarters * R::of(0.25)).round();
    let (one, minus) = (R::of(1.0), R::of(-1.0));
    // `left` is -2, -1, 0, 1 or 2.
    let sin_sign = R::either(
        left.abs() > R::of(1.5),
        minus,
        R::either(left < R::of(-0.5), minus, one),
    );
    let cos_sign = R::either(
        left.abs() > R::of(1.5),
        minus,
        R::either(left > R::of(0.5), minus, one),
    );
    (
        sin_sign * R::either(odd, cos, sin),
        cos_sign * R::either(odd, sin, cos),
    )
}

#[cfg(test)]
mod tests {
    use super::super::real::{Fused, Plain};
    use super::*;

    #[test]
    fn atan2_agrees_with_the_standard_library_all_around() {
        let mut worst: f64 = 0.0;
        for k in 0..200_000 {
            let angle = (f64::from(k) / 100_000.0 - 1.0) * std::f64::consts::PI;
            let (y, x) = (3.0 * angle.sin(), 3.0 * angle.cos());
            for ours in [
                atan2(Plain::<f64>::load(y), Plain::load(x)).store(),
                atan2(Fused::<f64>::load(y), Fused::load(x)).store(),
            ] {
                worst = worst.max((ours - y.atan2(x)).abs());
            }
        }
        // Two roundings of a number below pi: 4.4e-16 each.
        assert!(worst < 9e-16, "{worst:e}");
    }

    #[test]
    fn atan2_on_the_axes_and_at_zero() {
        use std::f64::consts::{FRAC_PI_2, PI};
        let angle = |y: f64, x: f64| atan2(Plain::<f64>::load(y), Plain::load(x)).store();
        assert_eq!(angle(0.0, 2.0), 0.0);
        assert_eq!(angle(2.0, 0.0), FRAC_PI_2);
        assert_eq!(angle(0.0, -2.0), PI);
        assert_eq!(angle(-2.0, 0.0), -FRAC_PI_2);
        assert_eq!(angle(0.0, 0.0), 0.0);
    }

    #[test]
    fn sine_and_cosine_agree_with_the_standard_library_over_many_turns() {
        let (mut worst, mut worst_f32): (f64, f64) = (0.0, 0.0);
        for k in -150_000..150_000 {
            let angle = f64::from(k) * 1.234_567e-3;
            let (s, c) = sin_cos(Plain::<f64>::load(angle));
            let (fused_s, fused_c) = sin_cos(Fused::<f64>::load(angle));
            for (sin, cos) in [(s.store(), c.store()), (fused_s.store(), fused_c.store())] {
                worst = worst
                    .max((sin - angle.sin()).abs())
                    .max((cos - angle.cos()).abs());
            }
            if angle.abs() < 10.0 {
                let (s, c) = sin_cos(Plain::<f32>::load(angle as f32));
                let exact = f64::from(angle as f32);
                worst_f32 = worst_f32
                    .max((f64::from(s.store()) - exact.sin()).abs())
                    .max((f64::from(c.store()) - exact.cos()).abs());
            }
        }
        assert!(worst < 3e-16, "{worst:e}");
        assert!(worst_f32 < 1e-6, "{worst_f32:e}");
    }
}
