//! Whether the first of several cells is better than the others.
//!
//! A difference of largest deviations is significant if it exceeds its uncertainty, as a gain of one change does
//! (`docs/theory/gain.md`). Two robots share the inputs of load and tool, but not their compliances; two cells of one
//! robot share all. Where the sensitivities are not known (maps, boxes, holes), the uncertainties of both deviations
//! are treated as independent.

use armill_core::optimize::{Gain, LeastGain, Sensitivity, SharedInputs};
use armill_core::units::from_um;

use super::numbers::CellNumbers;

/// What a comparison decides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// The first cell is better than all others.
    First,
    /// The first cell does not differ from those with these indices.
    Undecided(Vec<usize>),
    /// The first cell has the smallest deviation, but with assumed compliances.
    FirstIsAssumed,
}

/// A cell with what its verdict needs.
pub(super) struct Candidate<'a> {
    pub numbers: &'a CellNumbers,
    pub sensitivity: Option<&'a Sensitivity>,
    pub least: &'a LeastGain,
}

impl Candidate<'_> {
    /// The gain of this cell over `other`.
    pub fn gain_over(&self, other: &Candidate<'_>, shared: SharedInputs) -> Gain {
        if let Some((mine, others)) = self.sensitivity.zip(other.sensitivity) {
            return mine.gain_over(others, shared);
        }
        let of = |cell: &CellNumbers| from_um(cell.max_in_plane_um.unwrap_or(0.0));
        let both = (self.numbers.max_in_plane_u_um).zip(other.numbers.max_in_plane_u_um);
        Gain {
            before: of(other.numbers),
            after: of(self.numbers),
            uncertainty: match shared {
                SharedInputs::LoadAndTool => both.map(|(a, b)| from_um(a.hypot(b))),
                // One robot deviates more or less in both: the part that the deviations do not share is not known, and
                // at most their difference is certain.
                SharedInputs::OneRobot => both.map(|(a, b)| from_um((a - b).abs())),
            },
        }
    }

    /// Whether it is certain which of the two is better: they reach different points, or their largest deviations
    /// differ significantly.
    fn differs_from(&self, other: &Candidate<'_>, shared: SharedInputs) -> bool {
        let reaches = |of: &CellNumbers| of.inside_joint_limits as f64 / of.points.max(1) as f64;
        if reaches(self.numbers) != reaches(other.numbers) || other.numbers.reached == 0 {
            return true;
        }
        let gain = self.gain_over(other, shared);
        gain.by().abs() > gain.required(self.least)
    }
}

/// The verdict on cells in the order of their numbers; `shared` are the inputs that the first shares with another.
pub(super) fn verdict(cells: &[Candidate<'_>], shared: impl Fn(usize) -> SharedInputs) -> Verdict {
    let Some(first) = cells.first() else {
        return Verdict::First;
    };
    let others = 1..cells.len();
    let same: Vec<usize> = others
        .filter(|index| !first.differs_from(&cells[*index], shared(*index)))
        .collect();
    let mut others = 1..cells.len();
    let several_robots = others.any(|index| shared(index) == SharedInputs::LoadAndTool);
    match same.is_empty() {
        false => Verdict::Undecided(same),
        true if several_robots && first.numbers.compliance_assumed => Verdict::FirstIsAssumed,
        true => Verdict::First,
    }
}

#[cfg(test)]
mod tests {
    use super::super::numbers::tests::cell;
    use super::*;

    const TWO_SIGMA: LeastGain = LeastGain {
        coverage_factor: 2.0,
        ..LeastGain::ANY
    };

    fn verdict_of(cells: &[CellNumbers], shared: SharedInputs) -> Verdict {
        let candidate = |numbers| Candidate {
            numbers,
            sensitivity: None,
            least: &TWO_SIGMA,
        };
        let candidates: Vec<Candidate<'_>> = cells.iter().map(candidate).collect();
        verdict(&candidates, |_| shared)
    }

    #[test]
    fn a_difference_within_its_uncertainty_is_no_ranking() {
        let robots = SharedInputs::LoadAndTool;
        // k = 2 and 4 um each: 11.3 um.
        let near = [cell("b", 1.0, Some(18.0)), cell("a", 1.0, Some(29.0))];
        assert_eq!(verdict_of(&near, robots), Verdict::Undecided(vec![1]));
        assert_eq!(verdict_of(&near, SharedInputs::OneRobot), Verdict::First);
        let far = [cell("b", 1.0, Some(18.0)), cell("a", 1.0, Some(30.0))];
        assert_eq!(verdict_of(&far, robots), Verdict::First);
    }

    #[test]
    fn assumed_compliances_do_not_win() {
        let mut cells = [cell("b", 1.0, Some(18.0)), cell("a", 1.0, Some(90.0))];
        cells[0].compliance_assumed = true;
        assert_eq!(
            verdict_of(&cells, SharedInputs::LoadAndTool),
            Verdict::FirstIsAssumed
        );
        assert_eq!(verdict_of(&cells, SharedInputs::OneRobot), Verdict::First);
    }

    #[test]
    fn reach_is_certain_whatever_the_deviations() {
        let mut cells = [cell("b", 1.0, Some(18.0)), cell("a", 0.5, Some(19.0))];
        cells[1].inside_joint_limits = 1;
        assert_eq!(verdict_of(&cells, SharedInputs::LoadAndTool), Verdict::First);
    }
}
