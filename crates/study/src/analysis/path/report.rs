//! Paths: the deviation of the tool, where and why, and its effect on features and operations.
//!
//! Two tables contain all paths, a row a path: deviations, and data of the path. Then each path has its own: worst
//! points, features, process limits, operations, notes. Empty columns are left out.

use armill_report::html::{Report, Table};

use crate::analysis::cells::{COUNT, NONE, columns, percent, um, without_empty_columns};
use crate::analysis::path::answer::{
    FeatureAnswer, LimitAnswer, LimitsAnswer, MotionAnswer, OperationAnswer, PathAnswer, ProgramAnswer,
    SlowPlace, WorstPoint,
};
use crate::analysis::path::machined_part;
use crate::uncertainty_words::deviation_in_words;

/// Operations that a table lists at most; `result.json` has all.
const MOST_OPERATIONS: usize = 40;

/// The section of the paths, each with its own tables.
pub fn add_section(report: Report, paths: &[PathAnswer]) -> Report {
    let mut report = report
        .section("Paths")
        .table(&deviations(paths))
        .table(&followed(paths));
    if paths.iter().any(|path| path.motion.is_some()) {
        report = report.table(&motions(paths));
    }
    for table in machined_part::report::tables(paths) {
        report = report.table(&table);
    }
    for path in paths {
        if !path.worst_points.is_empty() {
            report = report.table(&worst_points(&path.name, &path.worst_points));
        }
        if !path.features.is_empty() {
            report = report.table(&features(&path.name, &path.features));
        }
        if let Some(motion) = path.motion.as_ref().filter(|motion| !motion.places.is_empty()) {
            report = report.table(&slow_places(&path.name, motion));
        }
        if let Some(limits) = &path.limits {
            report = report.table(&permitted(&path.name, limits));
        }
        let operations = path
            .program
            .as_ref()
            .map_or(&[][..], |program| &program.operations);
        if operations.len() > 1 {
            report = report.table(&operations_table(&path.name, operations));
        }
        if !path.notes.is_empty() {
            report = report
                .paragraph(&format!("{}: skipped statements and assumptions.", path.name))
                .list(&path.notes);
        }
    }
    report
}

/// Deviation of the tool: a row a path.
fn deviations(paths: &[PathAnswer]) -> Table {
    let row = |path: &PathAnswer| {
        vec![
            path.name.clone(),
            path.followed_branch.as_ref().unwrap_or(&path.branch).clone(),
            percent(path.fraction_within),
            um(path.min_in_plane_um),
            um(path.max_in_plane_um),
            um(path.max_along_um),
            um(path.max_cross_um),
            um(path.max_axial_um),
            um(path.max_full_um),
            um(path.roundness_um),
        ]
    };
    without_empty_columns(Table {
        caption: "Deviations by size. The deviation across the tool, for a shape in its plane, is compared with the tolerance; it \
                  has a component along the track, hardly visible on the part, and one to its left, the error of walls. The component \
                  along the tool is the error of floors. Roundness: largest of all load cases, peak to valley about the least-squares circle."
            .to_owned(),
        columns: columns(&[
            ("path", ""),
            ("branch", ""),
            ("within the tolerance", "%"),
            ("least across the tool", "µm"),
            ("largest across the tool", "µm"),
            ("along the track", "µm"),
            ("to the left", "µm"),
            ("along the tool", "µm"),
            ("total", "µm"),
            ("roundness", "µm"),
        ]),
        rows: paths.iter().map(row).collect(),
    })
}

/// What the controller makes of the paths: a row a path.
fn motions(paths: &[PathAnswer]) -> Table {
    let with_motion = paths
        .iter()
        .filter_map(|path| Some((path, path.motion.as_ref()?)));
    let row = |(path, motion): (&PathAnswer, &MotionAnswer)| {
        vec![
            path.name.clone(),
            format!("{:.1}", motion.cycle_time_s),
            format!("{:.1}", motion.cutting_time_s),
            format!("{:.1}", motion.programmed_time_s),
            percent(motion.length_at_feed_percent / 100.0),
            um(Some(motion.largest_blending_um)),
            um(Some(motion.largest_servo_um)),
            um(motion.largest_servo_u_um),
        ]
    };
    without_empty_columns(Table {
        caption: "Motion. Times of the whole program without tool changes, of its cuts, and of these at the programmed feed; part of the length at \
                  98 % of the feed or more; largest distance of the commanded path from the programmed one (rounded corners) and of the path \
                  that is followed from the commanded one (joints follow late); deviation across the tool with both."
            .to_owned(),
        columns: columns(&[
            ("path", ""),
            ("program", "s"),
            ("cuts", "s"),
            ("at the programmed feed", "s"),
            ("length at the feed", "%"),
            ("rounded corners", "µm"),
            ("late joints", "µm"),
            ("its standard uncertainty", "µm"),
        ]),
        rows: with_motion.map(row).collect(),
    })
}

/// Where the feed is not reached: a row a place.
fn slow_places(name: &str, motion: &MotionAnswer) -> Table {
    let row = |place: &SlowPlace| {
        vec![
            place.line.to_string(),
            format!("{:.1}", place.distance_mm),
            format!("{:.1}", place.speed_mm_per_s),
            format!("{:.1}", place.programmed_mm_per_s),
            format!("{:.3}", place.lost_s),
            place.limited_by.clone(),
            place.advice.clone(),
        ]
    };
    Table {
        caption: format!("{name}: where most time is lost, and what may help."),
        columns: columns(&[
            ("line", ""),
            ("distance", "mm"),
            ("speed", "mm/s"),
            ("programmed", "mm/s"),
            ("time lost", "s"),
            ("limited by", ""),
            ("what may help", ""),
        ]),
        rows: motion.places.iter().map(row).collect(),
    }
}

/// Data of the paths: files, lengths, times, and points that have no posture or no force.
fn followed(paths: &[PathAnswer]) -> Table {
    let count = |points: usize| match points {
        0 => NONE.to_owned(),
        points => points.to_string(),
    };
    let row = |path: &PathAnswer| {
        let of_program =
            |given: fn(&ProgramAnswer) -> String| path.program.as_ref().map_or(NONE.to_owned(), given);
        vec![
            path.name.clone(),
            of_program(|program| format!("{} ({})", program.file, program.format)),
            of_program(|program| program.moves.to_string()),
            format!("{:.0}", path.length_mm),
            of_program(|program| minutes(program.cutting_time_s)),
            path.points.to_string(),
            count(path.unreachable),
            count(path.outside_joint_limits),
            count(path.cut.as_ref().map_or(0, |cut| cut.points_without_force)),
        ]
    };
    without_empty_columns(Table {
        caption: "Data of the paths.".to_owned(),
        columns: columns(&[
            ("path", ""),
            ("file", ""),
            ("moves, rapids included", COUNT),
            ("length of the cuts", "mm"),
            ("time of the cuts", "min:s"),
            ("points", COUNT),
            ("out of reach", COUNT),
            ("outside joint limits", COUNT),
            ("without force", COUNT),
        ]),
        rows: paths.iter().map(row).collect(),
    })
}

/// A time as minutes and seconds; a dash without a feed.
fn minutes(seconds: f64) -> String {
    let whole = seconds.round();
    if seconds > 0.0 {
        format!("{}:{:02}", (whole / 60.0).floor(), whole % 60.0)
    } else {
        NONE.to_owned()
    }
}

/// The process limits of the whole program.
fn permitted(name: &str, limits: &LimitsAnswer) -> Table {
    let rows = [
        ("force in any direction", &limits.any_direction),
        ("force along the feed", &limits.along),
        ("force across the feed", &limits.cross),
        ("force along the tool", &limits.axial),
        ("axial depth", &limits.axial_depth),
        ("radial depth", &limits.radial_depth),
        ("feed per tooth", &limits.feed_per_tooth),
    ];
    let row = |(what, limit): (&str, &Option<LimitAnswer>)| {
        let limit = limit.as_ref()?;
        // A verdict of nothing has no number.
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
            "{name}: process limits that meet the tolerance everywhere, each with everything else as in the study, and the line that permits no \
             more. Evaluated at {} points; nothing: the tool exceeds the tolerance at any value.",
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

/// The worst points of one path; the numbers are those of its pictures.
fn worst_points(name: &str, points: &[WorstPoint]) -> Table {
    let row = |(i, worst): (usize, &WorstPoint)| {
        let [along, cross, axial] =
            [worst.along_um, worst.cross_um, worst.axial_um].map(|part| um(Some(part)));
        let [x, y, z] = worst.point.xyz_mm.map(|mm| format!("{mm:.0}"));
        vec![
            (i + 1).to_string(),
            worst.line.to_string(),
            format!("{:.1}", worst.distance_mm),
            format!("{x}, {y}, {z}"),
            deviation_in_words(worst.point.in_plane_um, worst.point.in_plane_u_um),
            along,
            cross,
            axial,
            worst.cause.clone(),
        ]
    };
    Table {
        caption: format!(
            "{name}: the worst points, each from another part of the path. Signs: forwards along the track, to its left, \
             from the part towards the spindle. The pictures show the numbers of the points."
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
            ("largest contribution", ""),
        ]),
        rows: points.iter().enumerate().map(row).collect(),
    }
}

/// The deviations of the features of one path; the case is given if there are several.
fn features(name: &str, features: &[FeatureAnswer]) -> Table {
    let several = features.iter().any(|feature| feature.case > 1);
    let row = |feature: &FeatureAnswer| {
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
            um(feature.straightness_axial_um),
            um(feature.flatness_um),
            feature.points.to_string(),
            feature.missing.unwrap_or_default().to_owned(),
        ]
    };
    without_empty_columns(Table {
        caption: format!(
            "{name}: deviations of its features. Shift: of the centre, axis or middle, in the axes of the program. Roundness, \
             straightness and flatness are peak to valley."
        ),
        columns: columns(&[
            ("feature", ""),
            ("kind", ""),
            ("load case", ""),
            ("radius of the path", "mm"),
            ("radius change", "µm"),
            ("shift x, y, z", "µm"),
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

/// The stretches of one program with the same tool and spindle speed.
fn operations_table(name: &str, operations: &[OperationAnswer]) -> Table {
    let row = |operation: &OperationAnswer| {
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
            ("first line", COUNT),
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
