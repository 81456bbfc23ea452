//! The grid of settings at a point of a path: spin, lead, tilt, and external axes; which settings are neighbours.
//!
//! A setting has an index along each axis of the grid, that of the spin changes fastest. The way from a setting to another
//! one, with the posture from which it starts, is one number (a *code*): the steps along each axis as digits.

use crate::kernel::SLOTS;

use super::freedoms::MOST_MOVING;

/// Axes of a grid: spin, lead, tilt, external axes.
pub(super) const AXES: usize = 3 + MOST_MOVING;
/// Most steps along each axis from one column to the next.
const MOST_STEPS: [usize; AXES] = [15, 7, 7, 7, 7, 7];

/// How many more steps along each axis the first setting of a column has than that of the column before.
pub(super) type Shift = [isize; AXES];
/// The same settings in both.
pub(super) const UNSHIFTED: Shift = [0; AXES];

/// Numbers of values along the axes of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Grid {
    counts: [usize; AXES],
    /// Whether the last spin is a neighbour of the first.
    around: bool,
}

impl Grid {
    /// A grid with these numbers of values; `around`: whether the last spin is a neighbour of the first.
    pub fn new(counts: [usize; AXES], around: bool) -> Grid {
        Grid { counts, around }
    }

    /// A grid of spins alone.
    #[cfg(test)]
    pub fn of_spins(count: usize, around: bool) -> Grid {
        let mut counts = [1; AXES];
        counts[0] = count;
        Grid { counts, around }
    }

    /// Number of spins: settings that follow each other in groups of so many differ in nothing else.
    pub fn spins(&self) -> usize {
        self.counts[0]
    }

    /// Number of settings.
    pub fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// The axes with more than one value.
    pub fn free_axes(&self) -> impl Iterator<Item = usize> {
        let counts = self.counts;
        (0..AXES).filter(move |axis| counts[*axis] > 1)
    }

    /// Index along each axis of a setting.
    pub fn indices(&self, setting: usize) -> [usize; AXES] {
        let mut rest = setting;
        self.counts.map(|count| {
            let index = rest % count;
            rest /= count;
            index
        })
    }

    fn stride(&self, axis: usize) -> usize {
        self.counts[..axis].iter().product()
    }

    /// The neighbours of a setting along an axis, each with the sense of the step from there.
    pub fn neighbours(&self, setting: usize, axis: usize) -> impl Iterator<Item = (isize, usize)> {
        let (count, stride) = (self.counts[axis], self.stride(axis));
        let index = setting / stride % count;
        let around = axis == 0 && self.around && count > 2;
        let first = setting - index * stride;
        let below = match index {
            0 => around.then(|| count - 1),
            _ => Some(index - 1),
        };
        let above = match index + 1 == count {
            true => around.then_some(0),
            false => Some(index + 1),
        };
        let below = below.map(|other| (1, first + other * stride));
        below
            .into_iter()
            .chain(above.map(|other| (-1, first + other * stride)))
    }

    /// The setting whose indices are greater than those of `setting` by `by`; `None` outside the grid. Spins that go around
    /// are not shifted.
    pub fn shifted(&self, setting: usize, by: &Shift) -> Option<usize> {
        if *by == UNSHIFTED {
            return Some(setting);
        }
        let indices = self.indices(setting);
        let mut shifted = 0;
        for axis in 0..AXES {
            let index = indices[axis] as isize + by[axis];
            if !(0..self.counts[axis] as isize).contains(&index) {
                return None;
            }
            shifted += index as usize * self.stride(axis);
        }
        Some(shifted)
    }

    /// The setting from which these steps lead to `setting`.
    pub fn origin(&self, setting: usize, steps: &[isize; AXES]) -> usize {
        let indices = self.indices(setting);
        let moved = (0..AXES).map(|axis| {
            let origin = indices[axis] as isize - steps[axis];
            origin.rem_euclid(self.counts[axis] as isize) as usize * self.stride(axis)
        });
        moved.sum()
    }

    /// Steps along each axis, limited to what a code can hold; none along axes with one value.
    pub fn steps(&self, wanted: [usize; AXES]) -> [usize; AXES] {
        std::array::from_fn(|axis| match self.counts[axis] {
            1 => 0,
            _ => wanted[axis].min(MOST_STEPS[axis]),
        })
    }

    /// Whether a code fits in one byte.
    pub fn codes_are_bytes(&self) -> bool {
        self.free_axes().all(|axis| axis == 0)
    }

    /// Values of a digit of a code.
    fn radix(&self, axis: usize) -> usize {
        if self.counts[axis] > 1 {
            2 * MOST_STEPS[axis] + 1
        } else {
            1
        }
    }

    /// What a step along `axis` adds to a code.
    pub fn weight(&self, axis: usize) -> i64 {
        let below: usize = (0..axis).map(|axis| self.radix(axis)).product();
        (below * SLOTS) as i64
    }

    /// The code of a posture at the same setting; above zero, which means that there is none.
    pub fn code(&self, slot: usize) -> u32 {
        let still: i64 = self
            .free_axes()
            .map(|axis| self.weight(axis) * MOST_STEPS[axis] as i64)
            .sum();
        still as u32 + slot as u32 + 1
    }

    /// Steps along each axis, and the posture at their start.
    pub fn steps_and_slot(&self, code: u32) -> ([isize; AXES], usize) {
        let code = code.max(1) as usize - 1;
        let mut rest = code / SLOTS;
        let steps = std::array::from_fn(|axis| {
            let radix = self.radix(axis);
            let digit = rest % radix;
            rest /= radix;
            if radix > 1 {
                digit as isize - MOST_STEPS[axis] as isize
            } else {
                0
            }
        });
        (steps, code % SLOTS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_of_all_steps_are_different_and_lead_back() {
        let grid = Grid::new([20, 3, 4, 5, 1, 1], false);
        let setting = 7 + 20 * (1 + 3 * (2 + 4 * 3));
        let mut seen = std::collections::BTreeSet::new();
        for spin in -7..=7_isize {
            for lead in -1..=1 {
                for rail in -1..=2 {
                    let code = i64::from(grid.code(5))
                        + spin as i64 * grid.weight(0)
                        + lead as i64 * grid.weight(1)
                        + rail as i64 * grid.weight(3);
                    assert!(seen.insert(code));
                    let (steps, slot) = grid.steps_and_slot(code as u32);
                    assert_eq!((steps, slot), ([spin, lead, 0, rail, 0, 0], 5));
                    let indices = grid.indices(grid.origin(setting, &steps));
                    let back = [7 - spin, 1 - lead, 2, 3 - rail, 0, 0];
                    assert_eq!(indices.map(|index| index as isize), back);
                }
            }
        }
    }

    #[test]
    fn neighbours_are_those_of_one_axis_and_spins_go_around() {
        let grid = Grid::new([4, 3, 1, 1, 1, 1], true);
        let of = |setting, axis| grid.neighbours(setting, axis).collect::<Vec<_>>();
        assert_eq!(of(4, 0), [(1, 7), (-1, 5)]);
        assert_eq!(of(4, 1), [(1, 0), (-1, 8)]);
        assert_eq!(of(3, 1), [(-1, 7)]);
        assert_eq!(of(0, 2), []);
    }

    #[test]
    fn a_shift_keeps_the_value_of_a_setting_or_leads_outside() {
        let grid = Grid::new([4, 3, 1, 1, 1, 1], false);
        assert_eq!(grid.shifted(1 + 4, &[2, -1, 0, 0, 0, 0]), Some(3));
        assert_eq!(grid.shifted(1 + 4, &[3, 0, 0, 0, 0, 0]), None);
        assert_eq!(grid.shifted(1 + 4, &[0, 2, 0, 0, 0, 0]), None);
        assert_eq!(grid.shifted(7, &UNSHIFTED), Some(7));
    }

    #[test]
    fn codes_of_spins_alone_are_bytes_and_those_of_all_axes_fit() {
        let spins = Grid::of_spins(72, true);
        assert!(spins.codes_are_bytes());
        let largest = |grid: Grid| {
            let most = grid
                .free_axes()
                .map(|axis| grid.weight(axis) * MOST_STEPS[axis] as i64);
            i64::from(grid.code(SLOTS - 1)) + most.sum::<i64>()
        };
        assert!(largest(spins) <= i64::from(u8::MAX));
        assert!(largest(Grid::new([2; AXES], false)) <= i64::from(u32::MAX));
    }
}
