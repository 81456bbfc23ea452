//! Tool path programs: how far the tool deviates, where and why, what became of features and operations.

use armill_report::html::{Report, Table};

use super::cells::{COUNT, NONE, columns, percent, um, without_empty_columns};
use crate::answer::{
    FeatureResult, LimitResult, LimitsResult, OperationResult, PathResult, ProgramResult, WorstPoint,
};

/// Operations that a table lists at most; `result.json` has all.
const MOST_OPERATIONS: usize = 40;

/// The section of the programs, each with its own tables.
pub(super) fn tell(report: Report, programs: &[&PathResult]) -> Report {
    let mut report = report
        .section("Tool path programs")
        .table(&deviations(programs))
        .table(&followed(programs));
    for path in programs {
        let Some(program) = &path.program else { continue };
        if !program.worst_points.is_empty() {
            report = report.table(&worst_points(&path.name, &program.worst_points));
        }
        if !program.features.is_empty() {
            report = report.table(&features(&path.name, &program.features));
        }
        if let Some(limits) = &program.limits {
            report = report.table(&permitted(&path.name, limits));
        }
        if program.operations.len() > 1 {
            report = report.table(&operations(&path.name, &program.operations));
        }
        if !program.notes.is_empty() {
            report = report
                .paragraph(&format!(
                    "{}: what was passed over or taken for granted.",
                    path.name
                ))
                .list(&program.notes);
        }
    }
    report
}

fn deviations(programs: &[&PathResult]) -> Table {
    let row = |(path, program): (&&PathResult, &ProgramResult)| {
        vec![
            path.name.clone(),
            path.branch.clone(),
            percent(path.fraction_within),
            um(path.max_in_plane_um),
            um(program.max_along_um),
            um(program.max_cross_um),
            um(program.max_normal_um),
            um(path.max_full_um),
        ]
    };
    Table {
        caption: "Largest deviations by size. Across the tool is what the tolerance is held against; it has a part along \
                  the track, hardly seen on the part, and one to its side, which walls get. Floors get the one along the tool."
            .to_owned(),
        columns: columns(&[
            ("program", ""),
            ("branch", ""),
            ("within the limit", "%"),
            ("across the tool", "µm"),
            ("along the track", "µm"),
            ("to its side", "µm"),
            ("along the tool", "µm"),
            ("in space", "µm"),
        ]),
        rows: told(programs).map(row).collect(),
    }
}

fn followed(programs: &[&PathResult]) -> Table {
    let count = |points: usize| match points {
        0 => NONE.to_owned(),
        points => points.to_string(),
    };
    let row = |(path, program): (&&PathResult, &ProgramResult)| {
        vec![
            path.name.clone(),
            format!("{} ({})", program.file, program.format),
            program.moves.to_string(),
            format!("{:.0}", program.cutting_length_mm),
            minutes(program.cutting_time_s),
            path.points.to_string(),
            count(path.unreached),
            count(path.outside_joint_limits),
            count(program.points_without_force),
        ]
    };
    without_empty_columns(Table {
        caption: "What was followed.".to_owned(),
        columns: columns(&[
            ("program", ""),
            ("file", ""),
            ("moves, rapids included", COUNT),
            ("length of the cuts", "mm"),
            ("time of the cuts", "min:s"),
            ("points", COUNT),
            ("out of reach", COUNT),
            ("outside joint limits", COUNT),
            ("without force", COUNT),
        ]),
        rows: told(programs).map(row).collect(),
    })
}

fn told<'a>(programs: &'a [&'a PathResult]) -> impl Iterator<Item = (&'a &'a PathResult, &'a ProgramResult)> {
    programs
        .iter()
        .filter_map(|path| Some((path, path.program.as_ref()?)))
}

/// A time as people read it; a dash where no feed is told.
fn minutes(seconds: f64) -> String {
    let whole = seconds.round();
    if seconds > 0.0 {
        format!("{}:{:02}", (whole / 60.0).floor(), whole % 60.0)
    } else {
        NONE.to_owned()
    }
}

/// What keeps the tolerance on the whole program.
fn permitted(name: &str, limits: &LimitsResult) -> Table {
    let rows = [
        ("force in any direction", &limits.any_direction),
        ("force along the feed", &limits.along),
        ("force across the feed", &limits.cross),
        ("force along the tool", &limits.axial),
        ("axial depth", &limits.axial_depth),
        ("radial depth", &limits.radial_depth),
        ("feed per tooth", &limits.feed_per_tooth),
    ];
    let row = |(what, limit): (&str, &Option<LimitResult>)| {
        let limit = limit.as_ref()?;
        let value = match limit.verdict {
            "nothing" => NONE.to_owned(),
            _ => format!("{:.3}", limit.value),
        };
        Some(vec![
            what.to_owned(),
            limit.verdict.to_owned(),
            value,
            limit.unit.to_owned(),
            limit.line.to_string(),
        ])
    };
    Table {
        caption: format!(
            "{name}: what holds the tolerance everywhere, each with all else as the study has it, and the line that permits no \
             more. Asked at {} points; nothing: however little is asked for, the tool deviates more.",
            limits.points
        ),
        columns: columns(&[
            ("quantity", ""),
            ("", ""),
            ("value", COUNT),
            ("unit", ""),
            ("line", COUNT),
        ]),
        rows: rows.into_iter().filter_map(row).collect(),
    }
}

fn worst_points(name: &str, points: &[WorstPoint]) -> Table {
    let row = |(i, worst): (usize, &WorstPoint)| {
        let [along, cross, normal] = worst.along_cross_normal_um.map(|part| um(Some(part)));
        let [x, y, z] = worst.point.xyz_mm.map(|mm| format!("{mm:.0}"));
        vec![
            (i + 1).to_string(),
            worst.line.to_string(),
            format!("{:.1}", worst.along_mm),
            format!("{x}, {y}, {z}"),
            format!(
                "{:.1} ± {:.1}",
                worst.point.in_plane_um, worst.point.in_plane_u_um
            ),
            along,
            cross,
            normal,
            worst.cause.clone(),
        ]
    };
    Table {
        caption: format!(
            "{name}: where it is worst, each from another part of the path. Signs: forwards along the track, to its left, \
             from the part towards the spindle. The numbers stand in the pictures."
        ),
        columns: columns(&[
            ("point", ""),
            ("line", COUNT),
            ("along the cuts", "mm"),
            ("tip at x, y, z", "mm"),
            ("across the tool", "µm"),
            ("along the track", "µm"),
            ("to its left", "µm"),
            ("along the tool", "µm"),
            ("mostly by", ""),
        ]),
        rows: points.iter().enumerate().map(row).collect(),
    }
}

fn features(name: &str, features: &[FeatureResult]) -> Table {
    let several = features.iter().any(|feature| feature.case > 1);
    let row = |feature: &FeatureResult| {
        let shift = feature
            .shift_um
            .map_or_else(|| NONE.to_owned(), |shift| shift.map(tenths).join(", "));
        vec![
            feature.name.clone(),
            feature.kind.to_owned(),
            if several {
                feature.case.to_string()
            } else {
                String::new()
            },
            feature
                .radius_mm
                .map_or_else(|| NONE.to_owned(), |radius| format!("{radius:.3}")),
            um(feature.radius_change_um),
            shift,
            um(feature.roundness_um),
            um(feature.straightness_across_um),
            um(feature.straightness_normal_um),
            um(feature.flatness_um),
            feature.points.to_string(),
            feature.missing.unwrap_or_default().to_owned(),
        ]
    };
    without_empty_columns(Table {
        caption: format!(
            "{name}: what became of its features. Moved by: centre, axis or middle, in the axes of the program. Roundness, \
             straightness and flatness are peak to valley."
        ),
        columns: columns(&[
            ("feature", ""),
            ("kind", ""),
            ("load case", ""),
            ("radius of the path", "mm"),
            ("grows by", "µm"),
            ("moved by x, y, z", "µm"),
            ("roundness", "µm"),
            ("straightness across the tool", "µm"),
            ("straightness along the tool", "µm"),
            ("flatness", "µm"),
            ("points", COUNT),
            ("no result", ""),
        ]),
        rows: features.iter().map(row).collect(),
    })
}

/// A number with one decimal; what rounds to zero has no sign.
fn tenths(value: f64) -> String {
    let rounded = (value * 10.0).round() / 10.0;
    format!("{:.1}", if rounded == 0.0 { 0.0 } else { rounded })
}

fn operations(name: &str, operations: &[OperationResult]) -> Table {
    let row = |operation: &OperationResult| {
        vec![
            operation.name.clone().unwrap_or_else(|| NONE.to_owned()),
            operation
                .tool
                .map_or_else(|| NONE.to_owned(), |tool| tool.to_string()),
            operation.line.to_string(),
            operation.points.to_string(),
            um(operation.max_in_plane_um),
        ]
    };
    let more = match operations.len().saturating_sub(MOST_OPERATIONS) {
        0 => String::new(),
        more => format!(" The first {MOST_OPERATIONS}; {more} more are in result.json."),
    };
    without_empty_columns(Table {
        caption: format!("{name}: its operations, each with one tool and spindle speed.{more}"),
        columns: columns(&[
            ("operation", ""),
            ("tool", COUNT),
            ("begins in line", COUNT),
            ("points", COUNT),
            ("largest across the tool", "µm"),
        ]),
        rows: operations.iter().take(MOST_OPERATIONS).map(row).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_minutes_and_seconds() {
        assert_eq!(
            [0.0, 27.3, 59.7, 3725.0].map(minutes),
            [NONE, "0:27", "1:00", "62:05"]
        );
    }

    #[test]
    fn what_rounds_to_zero_has_no_sign() {
        assert_eq!(
            [-0.01, 0.04, -6.25, 3.0].map(tenths),
            ["0.0", "0.0", "-6.3", "3.0"]
        );
    }
}
