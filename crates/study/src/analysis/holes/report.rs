//! A set of holes: in numbers, then hole by hole, worst first.

use armill_report::html::{Report, Table};

use crate::analysis::cells::{COUNT, NONE, columns, percent, um, without_empty_columns};
use crate::analysis::holes::answer::{HoleAnswer, HolesAnswer};
use crate::uncertainty_words::deviation_in_words;

/// Holes that the table lists at most; `result.json` and the tables have all.
const MOST: usize = 40;

/// The section of one set.
pub fn add_section(report: Report, holes: &HolesAnswer) -> Report {
    let report = report
        .section(&format!("Holes: {}", holes.name))
        .table(&numbers(holes))
        .table(&each(holes));
    if holes.notes.is_empty() {
        return report;
    }
    let passed = format!("{}: skipped statements and assumptions.", holes.name);
    report.paragraph(&passed).list(&holes.notes)
}

fn numbers(holes: &HolesAnswer) -> Table {
    let given = |text: &Option<String>| text.clone().unwrap_or_else(|| NONE.to_owned());
    without_empty_columns(Table {
        caption: "Deviations across the holes are compared with the tolerance; deviations along them are the error of depth. Each \
                  hole is evaluated with its best spin of the tool and branch."
            .to_owned(),
        columns: columns(&[
            ("holes", ""),
            ("file", ""),
            ("count", COUNT),
            ("cannot be drilled", COUNT),
            ("within the tolerance", "%"),
            ("mean across", "µm"),
            ("largest across", "µm"),
            ("largest error of depth", "µm"),
            ("spins tried", COUNT),
            ("material", ""),
            ("largest thrust", "N"),
        ]),
        rows: vec![vec![
            holes.name.clone(),
            given(&holes.file),
            holes.holes.to_string(),
            (holes.unreachable + holes.refused).to_string(),
            percent(holes.fraction_within),
            um(holes.mean_in_plane_um),
            um(holes.max_in_plane_um),
            um(holes.max_depth_um),
            holes.turns.to_string(),
            given(&holes.material),
            um(holes.largest_thrust_n),
        ]],
    })
}

fn each(holes: &HolesAnswer) -> Table {
    let deg = |value: Option<f64>| value.map_or_else(|| NONE.to_owned(), |deg| format!("{deg:.0}"));
    let row = |hole: &HoleAnswer| {
        let [x, y, z] = hole.xyz_mm.map(|mm| format!("{mm:.1}"));
        let across = hole.in_plane_um.map_or_else(
            || NONE.to_owned(),
            |um| deviation_in_words(um, hole.in_plane_u_um),
        );
        let margin = hole.limit_joint.as_ref().zip(hole.limit_margin_deg);
        vec![
            hole.hole.to_string(),
            hole.line.to_string(),
            format!("{x}, {y}, {z}"),
            across,
            um(hole.x_um),
            um(hole.y_um),
            um(hole.depth_um),
            hole.branch.clone().unwrap_or_default(),
            deg(hole.turn_deg),
            margin.map_or_else(String::new, |(joint, margin)| format!("{margin:.0} ({joint})")),
            deg(hole.wrist_bend_deg),
            hole.reason.clone().unwrap_or_default(),
        ]
    };
    let more = match holes.each.len().saturating_sub(MOST) {
        0 => String::new(),
        more => format!(" The first {MOST}; {more} more are in the tables."),
    };
    without_empty_columns(Table {
        caption: format!(
            "{}: hole by hole, worst first. x is that of the part, projected into the plane of the hole, y to its left; depth is positive \
             if the hole is too shallow; ± is the standard uncertainty.{more}",
            holes.name
        ),
        columns: columns(&[
            ("hole", ""),
            ("line", COUNT),
            ("tip at x, y, z", "mm"),
            ("across", "µm"),
            ("x", "µm"),
            ("y", "µm"),
            ("depth", "µm"),
            ("branch", ""),
            ("spin", "deg"),
            ("to joint limit", "deg"),
            ("wrist bend", "deg"),
            ("reason", ""),
        ]),
        rows: holes.each.iter().take(MOST).map(row).collect(),
    })
}
