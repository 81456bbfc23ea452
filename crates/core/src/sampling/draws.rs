//! Standard normal numbers of a seed: random ones, or a Sobol sequence.
//!
//! Both are functions of seed, index of the sample and number of the input alone: samples may be drawn in any order and on any machine.
//!
//! | method | uniform number of sample `i`, input `k` |
//! |---|---|
//! | random | Philox 4x64-10 with the key (seed, i), output `k` |
//! | Sobol | point `i` of the sequence in the order of the Gray code, dimension `k`, scrambled by a random linear matrix and a digital shift of the seed |
//!
//! Without the matrix, means over some dimensions are off in the same way for every seed, even of thousands of points.
//!
//! Source: J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC 2011 (Philox); P. Bratley and B. L. Fox, Algorithm 659,
//! ACM Trans. Math. Softw. 14:88-100, 1988 (Sobol); J. Matousek, On the L2-discrepancy for anchored boxes, J. Complexity 14:527-556,
//! 1998 (linear scrambling, digital shift).

use rayon::prelude::*;

use super::quantile::normal_quantile;
use super::sobol_numbers::{INITIAL, POLYNOMIALS};

/// Largest number of inputs of a Sobol sequence.
pub const MOST_DIMENSIONS: usize = POLYNOMIALS.len();
/// Bits of a Sobol number: a sequence has `2^32` points.
const BITS: usize = 32;
/// The stream of the scrambling of the first dimension; those of the next have smaller numbers.
const SCRAMBLING: u64 = u64::MAX;

/// How samples are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Independent random numbers.
    Random,
    /// A scrambled Sobol sequence: lower error than random numbers for the same count, best for powers of two.
    Sobol,
}

/// Samples of independent standard normal inputs.
#[derive(Clone, Copy, Debug)]
pub struct Draws {
    /// Random or Sobol.
    pub method: Method,
    /// Same seed, same numbers.
    pub seed: u64,
    /// Number of inputs; at most [`MOST_DIMENSIONS`] for a Sobol sequence.
    pub inputs: usize,
}

impl Draws {
    /// Samples `first` to `first + count`, one row of inputs each.
    ///
    /// # Panics
    /// If a Sobol sequence has more than [`MOST_DIMENSIONS`] inputs or `2^32` points.
    pub fn normal(&self, first: u64, count: usize) -> Vec<f64> {
        if self.inputs == 0 || count == 0 {
            return Vec::new();
        }
        let mut numbers = vec![0.0; count * self.inputs];
        let rows = (numbers.par_chunks_mut(self.inputs).enumerate()).map(|(i, row)| (row, i as u64));
        match self.method {
            Method::Random => rows.for_each(|(row, i)| {
                let key = [self.seed, first + i];
                for (block, four) in row.chunks_mut(4).enumerate() {
                    let words = philox(key, block as u64 + 1);
                    for (number, word) in four.iter_mut().zip(words) {
                        *number = normal_quantile(unit(word));
                    }
                }
            }),
            Method::Sobol => {
                assert!(
                    self.inputs <= MOST_DIMENSIONS,
                    "a Sobol sequence of {} inputs",
                    self.inputs
                );
                assert!(
                    first + (count as u64) <= 1 << BITS,
                    "a Sobol sequence has 2^32 points"
                );
                let (directions, shifts) = scrambled(directions(self.inputs), self.seed);
                rows.for_each(|(row, i)| {
                    let place = first + i;
                    let gray = place ^ (place >> 1);
                    for ((number, directions), shift) in row.iter_mut().zip(&directions).zip(&shifts) {
                        let bits = (0..BITS).filter(|bit| gray >> bit & 1 == 1);
                        let point = bits.fold(0_u32, |point, bit| point ^ directions[bit]);
                        *number = normal_quantile(unit(shift ^ u64::from(point) << BITS));
                    }
                });
            }
        }
        numbers
    }
}

/// The middle of one of `2^53` equal parts of the range from 0 to 1.
fn unit(word: u64) -> f64 {
    /// `2^-53`
    const PART: f64 = f64::EPSILON / 2.0;
    // The last part has its middle below 1 only before rounding.
    (((word >> 11) as f64 + 0.5) * PART).min(1.0 - PART)
}

/// Four words of the generator Philox 4x64-10 with this key; the counter is (`block`, 0, 0, 0).
fn philox(key: [u64; 2], block: u64) -> [u64; 4] {
    const ROUNDS: usize = 10;
    const MULTIPLIERS: [u64; 2] = [0xD2E7_470E_E14C_6C93, 0xCA5A_8263_9512_1157];
    const WEYL: [u64; 2] = [0x9E37_79B9_7F4A_7C15, 0xBB67_AE85_84CA_A73B];
    let (mut counter, mut key) = ([block, 0, 0, 0], key);
    for _ in 0..ROUNDS {
        let [first, second] = [0, 1].map(|i| u128::from(MULTIPLIERS[i]) * u128::from(counter[2 * i]));
        counter = [
            (second >> 64) as u64 ^ counter[1] ^ key[0],
            second as u64,
            (first >> 64) as u64 ^ counter[3] ^ key[1],
            first as u64,
        ];
        key = [0, 1].map(|i| key[i].wrapping_add(WEYL[i]));
    }
    counter
}

/// Direction numbers, each multiplied by a random lower triangular matrix of bits, and the digital shift of each dimension.
///
/// Of the stream of a dimension the first word is the shift; the others have the rows of the matrix, with ones on its diagonal.
fn scrambled(mut directions: Vec<[u32; BITS]>, seed: u64) -> (Vec<[u32; BITS]>, Vec<u64>) {
    let mut shifts = Vec::with_capacity(directions.len());
    for (v, dimension) in directions.iter_mut().zip(0_u64..) {
        let key = [seed, SCRAMBLING - dimension];
        let words: Vec<u64> = (1..=9).flat_map(|block| philox(key, block)).collect();
        shifts.push(words[0]);
        for v in v {
            // Row r has the bit r, and random ones of the bits above it.
            let row = |r: usize| {
                let above = if r == 0 { 0 } else { u32::MAX << (BITS - r) };
                let mask = words[1 + r] as u32 & above | 1 << (BITS - 1 - r);
                ((*v & mask).count_ones() & 1) << (BITS - 1 - r)
            };
            *v = (0..BITS).fold(0, |scrambled, r| scrambled | row(r));
        }
    }
    (directions, shifts)
}

/// The direction numbers of each dimension, with the binary point before the first bit.
fn directions(dimensions: usize) -> Vec<[u32; BITS]> {
    let mut found = vec![[0; BITS]; dimensions];
    let mut initial = INITIAL.iter();
    for (v, polynomial) in found.iter_mut().zip(POLYNOMIALS) {
        let degree = polynomial.ilog2() as usize;
        for j in 0..BITS {
            v[j] = if degree == 0 {
                1 << (BITS - 1 - j)
            } else if j < degree {
                initial.next().copied().unwrap_or(1) << (BITS - 1 - j)
            } else {
                let terms = (1..degree).filter(|k| polynomial >> (degree - k) & 1 == 1);
                let first = v[j - degree] ^ (v[j - degree] >> degree);
                terms.fold(first, |sum, k| sum ^ v[j - k])
            };
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn philox_gives_the_words_of_numpy() {
        // numpy.random.Philox(key=[7, 3]).random_raw(6), numpy 2.4.6.
        let first = philox([7, 3], 1);
        let second = philox([7, 3], 2);
        assert_eq!(first, FIRST);
        assert_eq!(second[..2], SECOND);
    }

    const FIRST: [u64; 4] = [
        0x7b6cc7b1862cc5f2,
        0xb960f2ea4b3f8d9f,
        0xcdd72e015deb1a6,
        0x50edb0d22a6a6fd5,
    ];
    const SECOND: [u64; 2] = [0xae45891bf7ab4df3, 0x32005aae5c700f2c];

    #[test]
    fn sobol_points_are_those_of_scipy() {
        // scipy.stats.qmc.Sobol(256, scramble=False, bits=32).random(1000)[[1, 2, 3, 999]], dimensions 0, 1, 2, 40 and 255, times 2^32.
        let directions = directions(256);
        for (place, expected) in [
            (1, [2147483648, 2147483648, 2147483648, 2147483648, 2147483648]),
            (2, [3221225472, 1073741824, 1073741824, 1073741824, 3221225472]),
            (3, [1073741824, 3221225472, 3221225472, 3221225472, 1073741824]),
            (999, [675282944, 3904897024, 348127232, 1505755136, 1874853888]),
        ] {
            let gray = place ^ (place >> 1);
            let point = |k: usize| {
                let bits = (0..BITS).filter(|bit| gray >> bit & 1 == 1);
                bits.fold(0_u32, |point, bit| point ^ directions[k][bit])
            };
            assert_eq!([0, 1, 2, 40, 255].map(point), expected, "{place}");
        }
    }

    #[test]
    fn scrambling_keeps_one_point_in_each_part_of_every_dimension() {
        let (directions, _) = scrambled(directions(40), 9);
        for v in &directions {
            let point = |place: u32| {
                (0..8)
                    .filter(|bit| place >> bit & 1 == 1)
                    .fold(0, |sum, bit| sum ^ v[bit])
            };
            let mut parts: Vec<u32> = (0..256).map(|place| point(place) >> 24).collect();
            parts.sort_unstable();
            assert_eq!(parts, (0..256).collect::<Vec<_>>());
        }
    }

    #[test]
    fn numbers_depend_on_seed_index_and_input_alone() {
        for method in [Method::Random, Method::Sobol] {
            let draws = Draws {
                method,
                seed: 5,
                inputs: 7,
            };
            let all = draws.normal(0, 100);
            assert_eq!(draws.normal(40, 10), all[40 * 7..50 * 7], "{method:?}");
            let fewer = Draws { inputs: 3, ..draws };
            assert_eq!(fewer.normal(9, 1), all[63..66], "{method:?}");
            assert_ne!(Draws { seed: 6, ..draws }.normal(0, 1), all[..7], "{method:?}");
            assert!(draws.normal(0, 0).is_empty());
        }
    }

    #[test]
    fn numbers_have_the_moments_of_the_normal_distribution() {
        const COUNT: usize = 1 << 14;
        for (method, tolerance) in [(Method::Random, 5.0), (Method::Sobol, 0.2)] {
            let draws = Draws {
                method,
                seed: 11,
                inputs: 20,
            };
            let all = draws.normal(0, COUNT);
            for k in 0..20 {
                let column = || all.iter().skip(k).step_by(20);
                let mean = column().sum::<f64>() / COUNT as f64;
                let square = column().map(|z| z * z).sum::<f64>() / COUNT as f64;
                // One standard error of the mean is 1 / sqrt(count), of the mean square sqrt(2 / count).
                let error = tolerance / (COUNT as f64).sqrt();
                assert!(mean.abs() < error, "{method:?} {k}: {mean}");
                assert!((square - 1.0).abs() < 1.5 * error, "{method:?} {k}: {square}");
            }
        }
    }
}
