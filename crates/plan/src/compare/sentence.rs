//! The ranking of cells in one sentence with its numbers; and what limits it.
//!
//! ```text
//! groove: B is within 20 µm on 93.0 % of the path, A on 12.0 %; largest deviation 18.2 and 61.1 µm.
//! ```
//!
//! A point is within the tolerance if the robot is inside its joint limits, too. If cells have different tolerances,
//! each is reported with its own.

use armill_core::map::COVERAGE;
use armill_study::analysis::words::micrometres;

use super::numbers::CellNumbers;

/// The ranking of cells, given best first.
pub(super) fn ranking(name: &str, kind: &str, cells: &[CellNumbers]) -> String {
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
        return format!("{name}: no cell reaches any point of {of}.");
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
            "every cell is within {limit} µm on {whole}, {} is best",
            first.cell
        )
    } else if all(0.0) {
        format!(
            "no cell is within {limit} µm at any point of {of}, {} is best",
            first.cell
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
        let reach = match cell.points - cell.reached {
            0 => None,
            _ if reaches_nothing(&cell) => Some("reaches no point".to_owned()),
            n => Some(format!("does not reach {n} of {} points", cell.points)),
        };
        let limits =
            (outside > 0).then(|| format!("is outside joint limits at {outside} of {} points", cell.points));
        let given: Vec<String> = reach.into_iter().chain(limits).collect();
        format!("; {} {}", cell.cell, given.join(" and "))
    });
    let lost: String = lost.collect();
    format!("{name}: {main}{largest}{lost}.")
}

/// Limitations of the ranking: neighbours with different robots whose largest deviations differ by less than their
/// uncertainty, assumed compliances, cells that do not reach all points.
///
/// For two cells with the same robot (`same_arm`, by the index of the first) the uncertainty is common and
/// does not affect the ranking.
pub(super) fn uncertainties(cells: &[CellNumbers], same_arm: impl Fn(usize) -> bool) -> Vec<String> {
    let mut uncertainties = Vec::new();
    for (index, pair) in cells.windows(2).enumerate() {
        if same_arm(index) {
            continue;
        }
        let given = |cell: &CellNumbers| {
            let u = cell.max_in_plane_u_um.unwrap_or(0.0);
            Some((cell.max_in_plane_um?, COVERAGE * u))
        };
        let Some(((a, ua), (b, ub))) = given(&pair[0]).zip(given(&pair[1])) else {
            continue;
        };
        if (a - b).abs() < ua.hypot(ub) {
            uncertainties.push(format!(
                "The largest deviations of {} and {} do not differ significantly: {} ± {} and {} ± {} µm.",
                pair[0].cell,
                pair[1].cell,
                micrometres(a),
                micrometres(ua),
                micrometres(b),
                micrometres(ub)
            ));
        }
    }
    uncertainties.extend(assumed(cells));
    if cells.iter().any(|cell| cell.reached < cell.points) {
        uncertainties.push(
            "Mean, 95 % and largest deviation are of the points that a cell reaches: cells that do not reach all points are compared over fewer."
                .to_owned(),
        );
    }
    uncertainties
}

/// Cells with assumed joint compliances, in a sentence.
pub(super) fn assumed(cells: &[CellNumbers]) -> Option<String> {
    let assumed = cells.iter().filter(|cell| cell.compliance_assumed);
    let names: Vec<&str> = assumed.map(|cell| cell.cell.as_str()).collect();
    let given = format!(
        "The joint compliances of {} are assumed, not measured.",
        names.join(", ")
    );
    (!names.is_empty()).then_some(given)
}

#[cfg(test)]
mod tests {
    use armill_study::answer::CountsAnswer;

    use super::*;

    fn cell(name: &str, part: f64, largest: Option<f64>) -> CellNumbers {
        CellNumbers {
            cell: name.to_owned(),
            robot: "r".to_owned(),
            compliance_assumed: false,
            branch: "best".to_owned(),
            points: 10,
            reached: if largest.is_some() { 10 } else { 0 },
            inside_joint_limits: if largest.is_some() { 10 } else { 0 },
            counts: CountsAnswer::of(&armill_core::map::Counts::default()),
            tolerance_um: 20.0,
            mean_in_plane_um: largest,
            p95_in_plane_um: largest,
            max_in_plane_um: largest,
            max_in_plane_u_um: Some(4.0),
            max_normal_um: largest,
            fraction_within: part,
            fraction_within_and_inside_joint_limits: part,
            mostly_by: None,
            mostly_by_percent: None,
        }
    }

    #[test]
    fn two_cells_are_compared() {
        let cells = [cell("b", 0.93, Some(18.2)), cell("a", 0.12, Some(61.1))];
        assert_eq!(
            ranking("ring", "path", &cells),
            "ring: b is within 20 µm on 93.0 % of the path, a on 12.0 %; largest deviation 18.2 and 61.1 µm."
        );
        assert!(uncertainties(&cells, |_| false).is_empty());
    }

    #[test]
    fn reports_all_none_and_different_tolerances() {
        let mut cells = [
            cell("b", 1.0, Some(18.2)),
            cell("a", 0.0, Some(61.1)),
            cell("c", 0.0, None),
        ];
        assert_eq!(
            ranking("ring", "path", &cells),
            "ring: b is within 20 µm on the whole path, a on no point of the path, c on no point of the path; largest deviation 18.2 and 61.1 µm; c reaches no point."
        );
        cells[1].tolerance_um = 50.0;
        let given = ranking("ring", "path", &cells);
        assert!(
            given.contains("b is within its 20 µm on the whole path, a is within its 50 µm on no point"),
            "{given}"
        );
        assert_eq!(
            ranking("m", "map", &[cell("a", 0.0, None), cell("b", 0.0, None)]),
            "m: no cell reaches any point of the plane."
        );
    }

    #[test]
    fn names_the_best_cell_if_all_or_none_meet_the_tolerance() {
        let all = [cell("b", 1.0, Some(18.2)), cell("a", 1.0, Some(19.5))];
        assert_eq!(
            ranking("ring", "path", &all),
            "ring: every cell is within 20 µm on the whole path, b is best; largest deviation 18.2 and 19.5 µm."
        );
        let none = [cell("b", 0.0, Some(58.2)), cell("a", 0.0, Some(61.1))];
        assert_eq!(
            ranking("ring", "path", &none),
            "ring: no cell is within 20 µm at any point of the path, b is best; largest deviation 58.2 and 61.1 µm."
        );
    }

    #[test]
    fn reports_neighbours_within_their_uncertainty() {
        // k = 2: hypot(8, 8) = 11.3 um.
        let near = [cell("b", 1.0, Some(18.0)), cell("a", 1.0, Some(29.0))];
        let far = [cell("b", 1.0, Some(18.0)), cell("a", 1.0, Some(30.0))];
        assert!(uncertainties(&near, |_| true).is_empty());
        assert!(
            uncertainties(&near, |_| false)[0].contains("do not differ significantly: 18 ± 8 and 29 ± 8 µm")
        );
        assert!(uncertainties(&far, |_| false).is_empty());
    }
}
