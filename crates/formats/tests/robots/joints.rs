//! Joint positions as they fall, from a seed that a failing test needs not print: it is written in the test.

/// A stream of six joint positions from -3 to 3 rad.
pub struct Joints(u64);

impl Joints {
    pub fn seeded(seed: u64) -> Joints {
        Joints(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn next(&mut self) -> [f64; 6] {
        std::array::from_fn(|_| {
            // xorshift64*, G. Marsaglia and S. Vigna.
            self.0 ^= self.0 >> 12;
            self.0 ^= self.0 << 25;
            self.0 ^= self.0 >> 27;
            let bits = self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11;
            bits as f64 / (1_u64 << 53) as f64 * 6.0 - 3.0
        })
    }
}
