//! The quantile of the standard normal distribution.
//!
//! Source: M. J. Wichura, Algorithm AS 241: The percentage points of the normal distribution, Applied Statistics 37:477-484, 1988 (PPND16,
//! relative accuracy 1e-16).

/// Half width of the central range of probabilities.
const CENTRAL: f64 = 0.425;
/// Square of [`CENTRAL`].
const CENTRAL_SQUARED: f64 = 0.180_625;
/// Where the tail begins: `sqrt(-ln p)`.
const FAR: f64 = 5.0;
/// Shift of the argument between the central range and the far tail.
const SHIFT: f64 = 1.6;

const CENTRE: [[f64; 8]; 2] = [
    [
        3.387_132_872_796_366_6,
        1.331_416_678_917_843_8e2,
        1.971_590_950_306_551_4e3,
        1.373_169_376_550_946e4,
        4.592_195_393_154_987e4,
        6.726_577_092_700_87e4,
        3.343_057_558_358_813e4,
        2.509_080_928_730_122_7e3,
    ],
    [
        1.0,
        4.231_333_070_160_091e1,
        6.871_870_074_920_579e2,
        5.394_196_021_424_751e3,
        2.121_379_430_158_659_7e4,
        3.930_789_580_009_271e4,
        2.872_908_573_572_194_3e4,
        5.226_495_278_852_854e3,
    ],
];
const NEAR_TAIL: [[f64; 8]; 2] = [
    [
        1.423_437_110_749_683_5,
        4.630_337_846_156_546,
        5.769_497_221_460_691,
        3.647_848_324_763_204_5,
        1.270_458_252_452_368_4,
        2.417_807_251_774_506e-1,
        2.272_384_498_926_918_4e-2,
        7.745_450_142_783_414e-4,
    ],
    [
        1.0,
        2.053_191_626_637_759,
        1.676_384_830_183_803_8,
        6.897_673_349_851e-1,
        1.481_039_764_274_800_8e-1,
        1.519_866_656_361_645_7e-2,
        5.475_938_084_995_345e-4,
        1.050_750_071_644_416_9e-9,
    ],
];
const FAR_TAIL: [[f64; 8]; 2] = [
    [
        6.657_904_643_501_103,
        5.463_784_911_164_114,
        1.784_826_539_917_291_3,
        2.965_605_718_285_049e-1,
        2.653_218_952_657_612_4e-2,
        1.242_660_947_388_078_4e-3,
        2.711_555_568_743_487_6e-5,
        2.010_334_399_292_288_1e-7,
    ],
    [
        1.0,
        5.998_322_065_558_88e-1,
        1.369_298_809_227_358e-1,
        1.487_536_129_085_061_5e-2,
        7.868_691_311_456_133e-4,
        1.846_318_317_510_054_7e-5,
        1.421_511_758_316_446e-7,
        2.044_263_103_389_939_8e-15,
    ],
];

/// The standard normal variable that is exceeded with the probability `1 - p`; `p` between 0 and 1, both excluded.
pub(super) fn normal_quantile(p: f64) -> f64 {
    let q = p - 0.5;
    if q.abs() <= CENTRAL {
        return q * ratio(&CENTRE, CENTRAL_SQUARED - q * q);
    }
    let r = (-libm::log(p.min(1.0 - p))).sqrt();
    let size = match r <= FAR {
        true => ratio(&NEAR_TAIL, r - SHIFT),
        false => ratio(&FAR_TAIL, r - FAR),
    };
    size.copysign(q)
}

/// A ratio of polynomials in `x`, lowest coefficients first.
fn ratio(of: &[[f64; 8]; 2], x: f64) -> f64 {
    let [numerator, denominator] = of.map(|terms| terms.iter().rev().fold(0.0, |sum, term| sum * x + term));
    numerator / denominator
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_other_programs() {
        // scipy.special.ndtri 1.17.1.
        for (p, expected) in [
            (0.5, 0.0),
            (0.6, 0.253_347_103_135_799_7),
            (0.925, 1.439_531_470_938_456),
            (0.975, 1.959_963_984_540_054),
            (1e-3, -3.090_232_306_167_813),
            (1e-12, -7.034_483_825_301_132),
            (1e-60, -16.397_278_212_718_71),
        ] {
            let found = normal_quantile(p);
            assert!(
                (found - expected).abs() <= 1e-14 * f64::abs(expected),
                "{p}: {found}"
            );
        }
    }

    #[test]
    fn the_pieces_join() {
        for at in [0.5 - CENTRAL, 0.5 + CENTRAL, libm::exp(-FAR * FAR)] {
            let [below, above] = [at * (1.0 - 1e-13), at * (1.0 + 1e-13)].map(normal_quantile);
            assert!(below < above && above - below < 1e-11, "{below} {above}");
        }
    }
}
