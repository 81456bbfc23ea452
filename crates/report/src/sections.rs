//! Lines that swing too often to be seen one by one, by sections: the value of largest size in each.
//!
//! A pocket of 12 m has a hundred corners; drawn point after point its chart is a comb.

/// A line of a chart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Samples<'a> {
    /// Positions.
    pub position: &'a [f64],
    /// A value at each; one that is not finite is a gap.
    pub value: &'a [f64],
}

/// Sections of a path.
pub(crate) const SECTIONS: usize = 100;
/// Lines with more swings than this are drawn by sections.
const MOST_SWINGS: usize = 40;
/// A swing is a change of direction after this fraction of the range.
const SWING: f64 = 0.15;

/// The sections of the lines of a chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sections {
    first: f64,
    /// Of a section, in the unit of the positions.
    length: f64,
}

impl Sections {
    /// Those of these lines; `None` where every swing can be seen, or where the positions do not rise.
    pub fn of<'s>(lines: impl Iterator<Item = Samples<'s>> + Clone) -> Option<Sections> {
        let rises = |line: Samples<'_>| line.position.is_sorted();
        let is_crowded =
            |line: Samples<'_>| line.position.len() > 2 * SECTIONS && swings(line.value) > MOST_SWINGS;
        if !lines.clone().all(rises) || !lines.clone().any(is_crowded) {
            return None;
        }
        let positions = || lines.clone().flat_map(|line| line.position).copied();
        let first = positions().fold(f64::INFINITY, f64::min);
        let last = positions().fold(f64::NEG_INFINITY, f64::max);
        let length = (last - first) / SECTIONS as f64;
        (length > 0.0 && length.is_finite()).then_some(Sections { first, length })
    }

    /// The middles of the sections, and the value of largest size in each; not finite where there is none.
    pub fn largest(&self, line: Samples<'_>) -> (Vec<f64>, Vec<f64>) {
        let mut largest = [f64::NAN; SECTIONS];
        for (position, value) in line.position.iter().zip(line.value) {
            let section = ((position - self.first) / self.length) as usize;
            let largest = &mut largest[section.min(SECTIONS - 1)];
            if value.is_finite() && (largest.is_nan() || value.abs() > largest.abs()) {
                *largest = *value;
            }
        }
        let middle = |section: usize| self.first + (section as f64 + 0.5) * self.length;
        ((0..SECTIONS).map(middle).collect(), largest.to_vec())
    }
}

/// Changes of direction after a part of the range.
fn swings(values: &[f64]) -> usize {
    let values = || values.iter().copied().filter(|value| value.is_finite());
    let least = values().fold(f64::INFINITY, f64::min);
    let most = values().fold(f64::NEG_INFINITY, f64::max);
    let step = SWING * (most - least);
    let mut swings = 0;
    // The extreme since the last change of direction, and whether the line rises.
    let mut state: Option<(f64, bool)> = None;
    for value in values() {
        state = match state {
            None => Some((value, true)),
            Some((extreme, rises)) if (value > extreme) == rises => Some((value, rises)),
            Some((extreme, rises)) if (value - extreme).abs() > step => {
                swings += 1;
                Some((value, !rises))
            }
            unchanged => unchanged,
        };
    }
    swings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn comb(teeth: usize) -> (Vec<f64>, Vec<f64>) {
        let value = |k: usize| if k % 10 < 5 { 100.0 } else { -20.0 };
        let samples = 0..10 * teeth;
        (
            samples.clone().map(|k| k as f64).collect(),
            samples.map(value).collect(),
        )
    }

    fn sections((position, value): &(Vec<f64>, Vec<f64>)) -> Option<Sections> {
        Sections::of([Samples { position, value }].into_iter())
    }

    #[test]
    fn a_comb_is_drawn_by_sections_and_a_few_teeth_as_they_are() {
        let mut line = comb(50);
        let found = sections(&line).unwrap();
        assert!((found.length - 4.99).abs() < 1e-12, "{}", found.length);
        assert_eq!(sections(&comb(15)), None);
        line.0.reverse();
        assert_eq!(sections(&line), None);
    }

    #[test]
    fn the_value_of_largest_size_stands_for_its_section_and_gaps_stay() {
        let mut line = comb(60);
        line.1[300..360].fill(f64::NAN);
        line.1[3] = -150.0;
        let found = sections(&line).unwrap();
        let (position, value) = found.largest(Samples {
            position: &line.0,
            value: &line.1,
        });
        assert_eq!((position.len(), value.len()), (SECTIONS, SECTIONS));
        assert!((value[0] + 150.0).abs() < 1e-12);
        assert!(value[52].is_nan());
        let mut finite = value.iter().filter(|value| value.is_finite());
        assert!(finite.all(|value| value.abs() >= 20.0));
    }

    #[test]
    fn small_ripples_are_no_swings() {
        let ripple = |k: usize| 100.0 * (k as f64 / 500.0) + if k.is_multiple_of(2) { 5.0 } else { 0.0 };
        assert_eq!(swings(&(0..500).map(ripple).collect::<Vec<f64>>()), 0);
    }
}
