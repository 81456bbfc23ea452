//! The machined part in words and tables.

use armill_report::html::Table;

use super::answer::{MachinedPartAnswer, WorstPlaceAnswer};
use super::features::SurfaceFeatureAnswer;
use super::scan_answer::{AgreementAnswer, DeviationStatistics, ScanAnswer};
use super::scan_contributions::ScanContributionAnswer;
use super::thickness::WallThicknessAnswer;
use crate::analysis::cells::{COUNT, NONE, columns, percent, um, without_empty_columns};
use crate::analysis::path::answer::PathAnswer;
use crate::analysis::words::{micrometres, motion_in_words};
use crate::uncertainty_words::{deviation_in_words, u_in_words};

/// The surface of the part, as a further sentence of a path.
pub fn sentence(part: &MachinedPartAnswer) -> String {
    let (Some(left), Some(gouged)) = (part.most_left_um, part.most_gouged_um) else {
        return " No surface of the part is made by the program.".to_owned();
    };
    let worst = part.worst_places.first();
    let place = worst.map_or_else(String::new, |worst| {
        let line = worst
            .line
            .map_or_else(String::new, |line| format!(", line {line}"));
        let [x, y, z] = worst.xyz_mm;
        format!(
            "; the worst place is at ({x:.1}, {y:.1}, {z:.1}) mm ({}{line}): {}",
            u_in_words(worst.u_um),
            worst.cause
        )
    });
    let scan = part.scan.as_ref().map_or_else(String::new, scan_sentence);
    let within = part.fraction_within.map_or_else(String::new, |within| {
        format!("{:.1} % of its area is within the tolerance", within * 100.0)
    });
    format!(
        " The surface of the part is between {} and {} µm from the nominal one (positive: material is left); {within}{place}.{scan}",
        signed(gouged),
        signed(left)
    )
}

/// How much of the measured deviation is explained, as a sentence.
fn scan_sentence(scan: &ScanAnswer) -> String {
    let explained = scan.agreement.explained.map_or_else(
        || "the measured deviation does not vary".to_owned(),
        |explained| {
            format!(
                "the prediction explains {:.0} % of its variance",
                100.0 * explained
            )
        },
    );
    format!(
        " Measured ({}, {} points): between {} and {} µm; {explained}, and {} µm rms are left.",
        scan.file,
        scan.points,
        signed(scan.measured.least_um),
        signed(scan.measured.largest_um),
        micrometres(scan.difference.rms_um)
    )
}

/// A deviation with its sign.
fn signed(value: f64) -> String {
    let size = micrometres(value.abs());
    match value {
        value if value > 0.0 => format!("+{size}"),
        value if value < 0.0 => format!("-{size}"),
        _ => size,
    }
}

/// What a user should know of a part before relying on it.
pub fn warnings(path: &PathAnswer) -> Vec<String> {
    let Some(part) = &path.machined_part else {
        return Vec::new();
    };
    let name = &path.name;
    let mut warnings = Vec::new();
    let mut lines = |lines: &[u32], what: &str| {
        if let Some(first) = lines.first() {
            let more = match lines.len() {
                1 => String::new(),
                more => format!(", and {} more lines", more - 1),
            };
            warnings.push(format!("{name}: {what} line {first}{more}."));
        }
    };
    lines(&part.rapids_in_material, "a rapid meets material before");
    lines(&part.shank_in_material, "shank or holder meets material at");
    if part.unknown_area_mm2 > 0.0 {
        warnings.push(format!(
            "{name}: the deviation of {:.0} mm² of the surface is not known, because the arm has no posture there; it is in no other value.",
            part.unknown_area_mm2
        ));
    }
    warnings
}

/// The tables of all parts: a row a path, then the worst places of each.
pub fn tables(paths: &[PathAnswer]) -> Vec<Table> {
    let parts: Vec<(&PathAnswer, &MachinedPartAnswer)> = (paths.iter())
        .filter_map(|path| Some((path, path.machined_part.as_ref()?)))
        .collect();
    if parts.is_empty() {
        return Vec::new();
    }
    let places = parts.iter().filter(|(_, part)| !part.worst_places.is_empty());
    std::iter::once(surfaces(&parts))
        .chain(
            parts
                .iter()
                .filter(|(_, part)| !part.features.is_empty())
                .map(|(path, part)| features(&path.name, &part.features)),
        )
        .chain(
            parts
                .iter()
                .filter(|(_, part)| !part.walls.is_empty())
                .map(|(path, part)| walls(&path.name, &part.walls)),
        )
        .chain(
            parts
                .iter()
                .filter_map(|(path, part)| Some(scan(&path.name, part.scan.as_ref()?))),
        )
        .chain(
            parts
                .iter()
                .filter_map(|(path, part)| Some(agreement(&path.name, part.scan.as_ref()?))),
        )
        .chain(
            parts
                .iter()
                .filter_map(|(path, part)| Some(contributions(&path.name, part.scan.as_ref()?))),
        )
        .chain(places.map(|(path, part)| worst_places(&path.name, &part.worst_places)))
        .collect()
}

/// The surface of each part.
fn surfaces(parts: &[(&PathAnswer, &MachinedPartAnswer)]) -> Table {
    let row = |(path, part): &(&PathAnswer, &MachinedPartAnswer)| {
        vec![
            path.name.clone(),
            part.nominal.to_owned(),
            format!("{:.3}", part.cell_mm),
            format!("{:.0}", part.area_mm2),
            part.fraction_within.map_or_else(|| NONE.to_owned(), percent),
            um(part.most_left_um),
            um(part.most_gouged_um),
            um(part.mean_um),
            um(part.rms_um),
            um(part.profile_um),
            format!("{:.1}", part.left_mm3),
            format!("{:.1}", part.gouged_mm3),
            format!("{:.0}", part.removed_mm3),
            um(part.feed_marks_um),
            um(part.vibration_um),
        ]
    };
    without_empty_columns(Table {
        caption: "Machined parts. Deviation of the surface normal to the nominal one, positive where material is left; mean, root mean square and \
                  the part within the tolerance by area. Nominal: what the program leaves, or the mesh of the part. Profile: twice the largest \
                  deviation (profile of a surface, ISO 1101)."
            .to_owned(),
        columns: columns(&[
            ("path", ""),
            ("nominal", ""),
            ("cell", "mm"),
            ("area", "mm²"),
            ("within the tolerance", "%"),
            ("most left", "µm"),
            ("most gouged", "µm"),
            ("mean", "µm"),
            ("root mean square", "µm"),
            ("profile", "µm"),
            ("material left", "mm³"),
            ("material gouged", "mm³"),
            ("removed", "mm³"),
            ("feed marks", "µm"),
            ("vibration", "µm"),
        ]),
        rows: parts.iter().map(row).collect(),
    })
}

/// The features of the surface of one part.
fn features(name: &str, features: &[SurfaceFeatureAnswer]) -> Table {
    let mm = |value: Option<f64>| value.map_or_else(|| NONE.to_owned(), |value| format!("{value:.3}"));
    let row = |feature: &SurfaceFeatureAnswer| {
        vec![
            feature.name.clone(),
            feature.kind.to_owned(),
            feature.points.to_string(),
            um(feature.mean_um),
            um(feature.profile_um),
            um(feature.u_um),
            um(feature.flatness_um),
            um(feature.offset_um),
            feature
                .tilt_deg
                .map_or_else(|| NONE.to_owned(), |deg| format!("{deg:.4}")),
            mm(feature.nominal_diameter_mm),
            um(feature.diameter_change_um),
            mm(feature.inscribed_diameter_mm),
            mm(feature.circumscribed_diameter_mm),
            um(feature.cylindricity_um),
            um(feature.position_um),
            um(feature.feed_marks_um),
            um(feature.vibration_um),
            feature.missing.clone().unwrap_or_default(),
        ]
    };
    without_empty_columns(Table {
        caption: format!(
            "{name}: features of the surface that comes out. Flatness, cylindricity, position and profile after ISO 1101 (minimum zones), \
             diameters after ISO 14405-1: least squares (GG) as a change from the nominal one, maximum inscribed (GX), minimum circumscribed (GN). \
             Offset: positive where material is left. Feed marks: theoretical height of the marks of the teeth. Vibration: of the tool from its mean position; \
             it adds at most twice this to the height of the roughness."
        ),
        columns: columns(&[
            ("feature", ""),
            ("kind", ""),
            ("points", COUNT),
            ("mean", "µm"),
            ("profile", "µm"),
            ("u of the largest deviation", "µm"),
            ("flatness", "µm"),
            ("offset", "µm"),
            ("tilt", "deg"),
            ("nominal diameter", "mm"),
            ("diameter change", "µm"),
            ("inscribed diameter", "mm"),
            ("circumscribed diameter", "mm"),
            ("cylindricity", "µm"),
            ("position", "µm"),
            ("feed marks", "µm"),
            ("vibration", "µm"),
            ("no result", ""),
        ]),
        rows: features.iter().map(row).collect(),
    })
}

/// The walls of one part.
fn walls(name: &str, walls: &[WallThicknessAnswer]) -> Table {
    let mm = |value: Option<f64>| value.map_or_else(|| NONE.to_owned(), |value| format!("{value:.4}"));
    let row = |wall: &WallThicknessAnswer| {
        vec![
            wall.name.clone(),
            wall.between.join(", "),
            wall.points.to_string(),
            mm(wall.nominal_mm),
            mm(wall.least_mm),
            mm(wall.mean_mm),
            mm(wall.largest_mm),
            um(wall.change_um),
            um(wall.u_um),
            wall.missing.clone().unwrap_or_default(),
        ]
    };
    without_empty_columns(Table {
        caption: format!(
            "{name}: thickness of walls, two-point sizes (ISO 14405-1, LP). Change: mean less the nominal thickness; its uncertainty is at most the sum of those of both faces."
        ),
        columns: columns(&[
            ("wall", ""),
            ("between", ""),
            ("points", COUNT),
            ("nominal", "mm"),
            ("least", "mm"),
            ("mean", "mm"),
            ("largest", "mm"),
            ("change", "µm"),
            ("u of the change", "µm"),
            ("no result", ""),
        ]),
        rows: walls.iter().map(row).collect(),
    })
}

/// Measured and predicted deviations: a row for the part, and one for each feature.
fn scan(name: &str, scan: &ScanAnswer) -> Table {
    let row = |what: &str, points: usize, of: [&DeviationStatistics; 3]| {
        let [measured, predicted, difference] = of;
        let mut row = vec![what.to_owned(), points.to_string()];
        for one in [measured, predicted] {
            row.extend([one.mean_um, one.rms_um, one.least_um, one.largest_um].map(|value| um(Some(value))));
        }
        row.extend([difference.mean_um, difference.rms_um].map(|value| um(Some(value))));
        row
    };
    let whole = row(
        "part",
        scan.points,
        [&scan.measured, &scan.predicted, &scan.difference],
    );
    let features = scan.features.iter().map(|feature| {
        let of = [&feature.measured, &feature.predicted, &feature.difference];
        row(&feature.name, feature.points, of)
    });
    Table {
        caption: format!(
            "{name}: measured points of {} and the prediction there, after the same alignment ({}): it removes ({}) mm and ({}) deg from the measured points and \
             ({}) mm and ({}) deg from the prediction. {} points are too far from the nominal part, {} where nothing is predicted.",
            scan.file,
            scan.align.replace('_', " "),
            numbers(scan.removed.translation_mm),
            numbers(scan.removed.rotation_deg),
            numbers(scan.removed_from_prediction.translation_mm),
            numbers(scan.removed_from_prediction.rotation_deg),
            scan.too_far,
            scan.not_predicted
        ),
        columns: columns(&[
            ("surface", ""),
            ("points", COUNT),
            ("measured: mean", "µm"),
            ("root mean square", "µm"),
            ("least", "µm"),
            ("largest", "µm"),
            ("predicted: mean", "µm"),
            ("root mean square", "µm"),
            ("least", "µm"),
            ("largest", "µm"),
            ("difference: mean", "µm"),
            ("root mean square", "µm"),
        ]),
        rows: std::iter::once(whole).chain(features).collect(),
    }
}

fn numbers(values: [f64; 3]) -> String {
    values.map(|value| format!("{value:.3}")).join(", ")
}

/// What is explained, by wavelength and by feature.
fn agreement(name: &str, scan: &ScanAnswer) -> Table {
    let number = |value: Option<f64>| value.map_or_else(|| NONE.to_owned(), |value| format!("{value:.2}"));
    let row = |what: String, of: &AgreementAnswer| {
        vec![
            what,
            um(Some(of.measured_sd_um)),
            of.explained.map_or_else(|| NONE.to_owned(), percent),
            number(of.slope),
            number(of.correlation),
        ]
    };
    let [long, short] = scan.wavelengths_mm;
    let rows = [
        ("all wavelengths".to_owned(), &scan.agreement),
        (format!("above {long} mm"), &scan.long),
        (format!("{short} mm to {long} mm"), &scan.middle),
        (format!("below {short} mm"), &scan.short),
    ];
    let features = scan.features.iter().map(|feature| {
        let explained = feature.explained.map_or_else(|| NONE.to_owned(), percent);
        vec![
            feature.name.clone(),
            NONE.to_owned(),
            explained,
            NONE.to_owned(),
            NONE.to_owned(),
        ]
    });
    Table {
        caption: format!(
            "{name}: share of the variance of the measured deviations that the prediction explains, by wavelength along the surface and by feature; slope of \
             measured over predicted deviations (u = {})",
            number(scan.slope_u)
        ),
        columns: columns(&[
            ("part of the deviation", ""),
            ("measured, standard deviation", "µm"),
            ("explained", "%"),
            ("slope", ""),
            ("correlation", ""),
        ]),
        rows: rows
            .into_iter()
            .map(|(what, of)| row(what, of))
            .chain(features)
            .collect(),
    }
}

/// What each contributor explains of the measured deviations.
fn contributions(name: &str, scan: &ScanAnswer) -> Table {
    let share = |value: Option<f64>| value.map_or_else(|| NONE.to_owned(), percent);
    let row = |of: &ScanContributionAnswer| {
        vec![
            motion_in_words(&of.name).unwrap_or(&of.name).to_owned(),
            um(Some(of.largest_um)),
            um(Some(of.rms_um)),
            share(of.explained_alone),
            share(of.explained_without),
        ]
    };
    Table {
        caption: format!(
            "{name}: contributions to the predicted deviation at the measured points, after the same alignment. Alone: share of the mean square of the measured deviations \
             that this contribution explains without the others; without: share that the others explain without it."
        ),
        columns: columns(&[
            ("contribution", ""),
            ("largest", "µm"),
            ("root mean square", "µm"),
            ("alone", "%"),
            ("without", "%"),
        ]),
        rows: scan.contributions.iter().map(row).collect(),
    }
}

/// The worst places of the surface of one part.
fn worst_places(name: &str, places: &[WorstPlaceAnswer]) -> Table {
    let row = |(i, worst): (usize, &WorstPlaceAnswer)| {
        let [x, y, z] = worst.xyz_mm.map(|mm| format!("{mm:.1}"));
        let [i_, j, k] = worst.normal_axis.map(|part| format!("{part:.2}"));
        let number = |number: Option<String>| number.unwrap_or_else(|| NONE.to_owned());
        vec![
            (i + 1).to_string(),
            format!("{x}, {y}, {z}"),
            format!("{i_}, {j}, {k}"),
            deviation_in_words(worst.deviation_um, worst.u_um),
            number(worst.line.map(|line| line.to_string())),
            number(worst.operation.map(|operation| operation.to_string())),
            worst.cause.clone(),
        ]
    };
    without_empty_columns(Table {
        caption: format!(
            "{name}: the worst places of the surface of the part, each from another part of it, in the frame of the program."
        ),
        columns: columns(&[
            ("place", ""),
            ("x, y, z", "mm"),
            ("normal", ""),
            ("deviation", "µm"),
            ("line", COUNT),
            ("operation", COUNT),
            ("cause", ""),
        ]),
        rows: places.iter().enumerate().map(row).collect(),
    })
}
