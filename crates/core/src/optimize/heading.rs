//! Which way did each joint go last? A bit a joint.

/// Joints that last went up, and those that last went down; one that has not moved is in neither.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Heading {
    up: u32,
    down: u32,
}

/// Joints that are looked at; further ones never turn back.
const MOST: usize = u32::BITS as usize;
/// A joint that moves by less than this from one point to the next stands still, rad (m): far above rounding, far below
/// what a joint moves between points that are worth telling apart.
const STILL: f64 = 1e-9;

impl Heading {
    /// That of joints that move by this.
    pub fn of(moves: impl Iterator<Item = f64>) -> Heading {
        let mut heading = Heading::default();
        for (joint, by) in moves.take(MOST).enumerate() {
            heading.up |= u32::from(by > STILL) << joint;
            heading.down |= u32::from(by < -STILL) << joint;
        }
        heading
    }

    /// How many joints turn back when they move on so.
    pub fn turned_by(self, on: Heading) -> u32 {
        ((self.up & on.down) | (self.down & on.up)).count_ones()
    }

    /// The heading after moving on so: that of joints that stand still stays.
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
    fn a_joint_turns_back_once_and_a_pause_does_not_count() {
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
    fn joints_beyond_the_bits_are_passed_over() {
        let up = Heading::of(std::iter::repeat_n(1.0, 40));
        assert_eq!(up.turned_by(Heading::of(std::iter::repeat_n(-1.0, 40))), 32);
    }
}
