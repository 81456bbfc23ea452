//! Last direction of motion of each joint, one bit per joint.

/// Joints whose last motion was positive, and those whose last motion was negative; a joint that has not moved is in
/// neither.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Heading {
    up: u32,
    down: u32,
}

/// Number of joints that are examined; further ones are never reported as reversing.
const MOST: usize = u32::BITS as usize;
/// A joint that moves by less than this between two points is at rest, rad (m): far above rounding, far below the
/// motion between points of a path.
const STILL: f64 = 1e-9;

impl Heading {
    /// Directions of joints that move by this amount.
    pub fn of(moves: impl Iterator<Item = f64>) -> Heading {
        let mut heading = Heading::default();
        for (joint, by) in moves.take(MOST).enumerate() {
            heading.up |= u32::from(by > STILL) << joint;
            heading.down |= u32::from(by < -STILL) << joint;
        }
        heading
    }

    /// Number of joints that reverse on this motion.
    pub fn turned_by(self, on: Heading) -> u32 {
        ((self.up & on.down) | (self.down & on.up)).count_ones()
    }

    /// The directions after this motion; joints at rest keep theirs.
    pub fn then(self, on: Heading) -> Heading {
        Heading {
            up: (self.up & !on.down) | on.up,
            down: (self.down & !on.up) | on.down,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reversal_is_reported_once_and_a_pause_is_not_a_reversal() {
        let moves = [
            [1.0, 0.0, 0.0],
            [1.0, -0.5, 0.0],
            [0.0, 0.0, 0.0],
            [-1.0, -0.5, 2e-10],
            [-1.0, 0.5, -2e-10],
        ];
        let (mut heading, mut backs) = (Heading::default(), Vec::new());
        for by in moves {
            let on = Heading::of(by.into_iter());
            backs.push(heading.turned_by(on));
            heading = heading.then(on);
        }
        assert_eq!(backs, [0, 0, 0, 1, 1]);
        assert_eq!(
            heading,
            Heading {
                up: 0b010,
                down: 0b001
            }
        );
    }

    #[test]
    fn joints_beyond_the_bit_width_are_skipped() {
        let up = Heading::of(std::iter::repeat_n(1.0, 40));
        assert_eq!(up.turned_by(Heading::of(std::iter::repeat_n(-1.0, 40))), 32);
    }
}
