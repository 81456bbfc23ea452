//! The ranking of cells, or that there is none, in one sentence with its numbers; and what limits it.
//!
//! ```text
//! groove: B is within 20 µm on 93.0 % of the path, A on 12.0 %; largest deviation 18.2 and 61.1 µm.
//! ```
//!
//! A point is within the tolerance if the robot is inside its joint limits, too. If cells have different tolerances,
//! each is reported with its own.

use armill_core::map::COVERAGE;
use armill_core::optimize::SharedInputs;
use armill_core::units::to_um;
use armill_study::analysis::words::micrometres;

use super::numbers::CellNumbers;
use super::verdict::{Candidate, Verdict};

/// The ranking of cells, given in the order of their numbers, or that there is none.
pub(super) fn ranking(name: &str, kind: &str, cells: &[CellNumbers], verdict: &Verdict) -> String {
    let (whole, of) = match kind {
        "path" => ("the whole path", "the path"),
        "holes" => ("all holes", "the holes"),
        "map" => ("the whole plane", "the plane"),
        _ => ("the whole box", "the box"),
    };
    let Some(first) = cells.first() else {
        return String::new();
    };
    let reaches_nothing = |cell: &&CellNumbers| cell.reached == 0;
    if cells.iter().all(|cell| cell.reached == 0) {
        let collide = cells.iter().any(|cell| cell.counts.in_collision > 0);
        return match collide {
            true => format!("{name}: no cell reaches any point of {of} with the demanded clearance."),
            false => format!("{name}: no cell reaches any point of {of}."),
        };
    }
    let one_limit = cells.iter().all(|cell| cell.tolerance_um == first.tolerance_um);
    let part = |cell: &CellNumbers| match cell.fraction_within_and_inside_joint_limits {
        1.0 => whole.to_owned(),
        0.0 => format!("no point of {of}"),
        fraction => format!("{:.1} %", fraction * 100.0),
    };
    let parts = cells.iter().enumerate().map(|(index, cell)| {
        let limit = micrometres(cell.tolerance_um);
        let part = part(cell);
        // The first percentage names the whole, unless it is all or nothing of it.
        let part = if index == 0 && part.ends_with('%') {
            format!("{part} of {of}")
        } else {
            part
        };
        match (index, one_limit) {
            (0, true) => format!("{} is within {limit} µm on {part}", cell.cell),
            (_, true) => format!("{} on {part}", cell.cell),
            (_, false) => format!("{} is within its {limit} µm on {part}", cell.cell),
        }
    });
    let parts: Vec<String> = parts.collect();
    let all = |fraction: f64| {
        let same = |cell: &CellNumbers| cell.fraction_within_and_inside_joint_limits == fraction;
        one_limit && cells.iter().all(same)
    };
    let limit = micrometres(first.tolerance_um);
    let main = if all(1.0) {
        format!(
            "every cell is within {limit} µm on {whole}{}",
            best(verdict, first)
        )
    } else if all(0.0) {
        format!(
            "no cell is within {limit} µm at any point of {of}{}",
            best(verdict, first)
        )
    } else {
        parts.join(", ")
    };
    let largest: Vec<String> = cells
        .iter()
        .filter_map(|cell| cell.max_in_plane_um)
        .map(micrometres)
        .collect();
    let largest = match &largest[..] {
        [a, b] => format!("; largest deviation {a} and {b} µm"),
        several => format!("; largest deviation {} µm", several.join(", ")),
    };
    let lost = cells.iter().filter(|cell| cell.inside_joint_limits < cell.points);
    let lost = lost.map(|cell| {
        let outside = cell.reached - cell.inside_joint_limits;
        let collisions = cell.counts.in_collision;
        let reach = match cell.points - cell.reached - collisions {
            0 => None,
            _ if reaches_nothing(&cell) && collisions == 0 => Some("reaches no point".to_owned()),
            n => Some(format!("does not reach {n} of {} points", cell.points)),
        };
        let limits =
            (outside > 0).then(|| format!("is outside joint limits at {outside} of {} points", cell.points));
        let collisions = (collisions > 0).then(|| {
            format!(
                "does not keep the demanded clearance at {collisions} of {} points",
                cell.points
            )
        });
        let given: Vec<String> = reach.into_iter().chain(collisions).chain(limits).collect();
        format!("; {} {}", cell.cell, given.join(" and "))
    });
    let lost: String = lost.collect();
    let no_ranking = no_ranking(verdict, cells);
    format!("{name}: {no_ranking}{main}{largest}{lost}.")
}

/// The best cell, at the end of what all have in common.
fn best(verdict: &Verdict, first: &CellNumbers) -> String {
    match verdict {
        Verdict::First => format!(", {} is best", first.cell),
        Verdict::Undecided(_) | Verdict::FirstIsAssumed => String::new(),
    }
}

/// That there is no ranking, and why, at the beginning of the sentence; nothing if there is one.
fn no_ranking(verdict: &Verdict, cells: &[CellNumbers]) -> String {
    match verdict {
        Verdict::First => String::new(),
        Verdict::Undecided(same) if same.len() + 1 == cells.len() => {
            let differences = match same.len() {
                1 => "the difference is within its uncertainty",
                _ => "the differences are within their uncertainty",
            };
            format!("no ranking: {differences}; ")
        }
        Verdict::Undecided(same) => {
            let names: Vec<&str> = (std::iter::once(&0).chain(same))
                .map(|index| cells[*index].cell.as_str())
                .collect();
            format!(
                "no ranking of {}: differences are within their uncertainty; ",
                names.join(", ")
            )
        }
        Verdict::FirstIsAssumed => format!(
            "no ranking: the compliances of {}, which has the best numbers, are assumed; ",
            cells.first().map_or("", |first| first.cell.as_str())
        ),
    }
}

/// Limitations of the ranking: neighbours whose largest deviations differ by less than the uncertainty of the
/// difference, assumed compliances, cells that do not reach all points.
///
/// `shared`: the inputs that two cells share, by their indices.
pub(super) fn uncertainties(
    candidates: &[Candidate<'_>],
    shared: impl Fn(usize, usize) -> SharedInputs,
) -> Vec<String> {
    let cells: Vec<&CellNumbers> = candidates.iter().map(|candidate| candidate.numbers).collect();
    let mut uncertainties = Vec::new();
    for (index, pair) in candidates.windows(2).enumerate() {
        let [better, worse] = [&pair[0], &pair[1]];
        if worse.numbers.reached == 0 {
            continue;
        }
        let gain = better.gain_over(worse, shared(index, index + 1));
        if gain.by().abs() > gain.required(better.least) {
            continue;
        }
        let names = format!("{} and {}", better.numbers.cell, worse.numbers.cell);
        let by = micrometres(to_um(gain.by().abs()));
        uncertainties.push(match gain.uncertainty {
            Some(u) => format!(
                "The largest deviations of {names} do not differ significantly: by {by} ± {} µm (k = 2).",
                micrometres(to_um(COVERAGE * u))
            ),
            None => format!(
                "The largest deviations of {names} differ by {by} µm; the uncertainty of the difference is not known."
            ),
        });
    }
    uncertainties.extend(assumed(cells.iter().copied()));
    if cells.iter().any(|cell| cell.reached < cell.points) {
        uncertainties.push(
            "Mean, 95 % and largest deviation are of the points that a cell reaches: cells that do not reach all points are compared over fewer."
                .to_owned(),
        );
    }
    uncertainties
}

/// Cells with assumed joint compliances, in a sentence.
pub(super) fn assumed<'a>(cells: impl Iterator<Item = &'a CellNumbers>) -> Option<String> {
    let assumed = cells.filter(|cell| cell.compliance_assumed);
    let names: Vec<&str> = assumed.map(|cell| cell.cell.as_str()).collect();
    let given = format!(
        "The joint compliances of {} are assumed, not measured.",
        names.join(", ")
    );
    (!names.is_empty()).then_some(given)
}

#[cfg(test)]
mod tests {
    use armill_core::optimize::LeastGain;

    use super::super::numbers::tests::cell;
    use super::*;

    #[test]
    fn two_cells_are_compared() {
        let cells = [cell("b", 0.93, Some(18.2)), cell("a", 0.12, Some(61.1))];
        assert_eq!(
            ranking("ring", "path", &cells, &Verdict::First),
            "ring: b is within 20 µm on 93.0 % of the path, a on 12.0 %; largest deviation 18.2 and 61.1 µm."
        );
        let undecided = Verdict::Undecided(vec![1]);
        assert!(ranking("ring", "path", &cells, &undecided).starts_with(
            "ring: no ranking: the difference is within its uncertainty; b is within 20 µm on 93.0 %"
        ));
        let assumed = ranking("ring", "path", &cells, &Verdict::FirstIsAssumed);
        assert!(assumed.starts_with(
            "ring: no ranking: the compliances of b, which has the best numbers, are assumed; "
        ));
    }

    #[test]
    fn reports_all_none_and_different_tolerances() {
        let mut cells = [
            cell("b", 1.0, Some(18.2)),
            cell("a", 0.0, Some(61.1)),
            cell("c", 0.0, None),
        ];
        assert_eq!(
            ranking("ring", "path", &cells, &Verdict::First),
            "ring: b is within 20 µm on the whole path, a on no point of the path, c on no point of the path; largest deviation 18.2 and 61.1 µm; c reaches no point."
        );
        cells[1].tolerance_um = 50.0;
        let given = ranking("ring", "path", &cells, &Verdict::First);
        assert!(
            given.contains("b is within its 20 µm on the whole path, a is within its 50 µm on no point"),
            "{given}"
        );
        assert_eq!(
            ranking(
                "m",
                "map",
                &[cell("a", 0.0, None), cell("b", 0.0, None)],
                &Verdict::First
            ),
            "m: no cell reaches any point of the plane."
        );
    }

    #[test]
    fn names_the_best_cell_if_all_or_none_meet_the_tolerance() {
        let all = [cell("b", 1.0, Some(18.2)), cell("a", 1.0, Some(19.5))];
        assert_eq!(
            ranking("ring", "path", &all, &Verdict::First),
            "ring: every cell is within 20 µm on the whole path, b is best; largest deviation 18.2 and 19.5 µm."
        );
        let none = [cell("b", 0.0, Some(58.2)), cell("a", 0.0, Some(61.1))];
        assert_eq!(
            ranking("ring", "path", &none, &Verdict::First),
            "ring: no cell is within 20 µm at any point of the path, b is best; largest deviation 58.2 and 61.1 µm."
        );
    }

    #[test]
    fn reports_neighbours_within_their_uncertainty() {
        let least = LeastGain {
            coverage_factor: 2.0,
            ..LeastGain::ANY
        };
        let said = |cells: &[CellNumbers], shared: SharedInputs| {
            let candidates: Vec<Candidate<'_>> = cells
                .iter()
                .map(|numbers| Candidate {
                    numbers,
                    sensitivity: None,
                    least: &least,
                })
                .collect();
            uncertainties(&candidates, |_, _| shared)
        };
        // k = 2: hypot(8, 8) = 11.3 um.
        let near = [cell("b", 1.0, Some(18.0)), cell("a", 1.0, Some(29.0))];
        let far = [cell("b", 1.0, Some(18.0)), cell("a", 1.0, Some(30.0))];
        assert!(said(&near, SharedInputs::OneRobot).is_empty());
        let given = said(&near, SharedInputs::LoadAndTool);
        assert!(
            given[0].contains("do not differ significantly: by 11 ± 11.3 µm"),
            "{given:?}"
        );
        assert!(said(&far, SharedInputs::LoadAndTool).is_empty());
    }
}
