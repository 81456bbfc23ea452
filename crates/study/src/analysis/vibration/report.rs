//! The section of a report on the vibration: a row an analysis.

use armill_report::html::{Report, Table};

use super::answer::{CutVibrationAnswer, VibrationAnswer};
use crate::analysis::cells::{columns, percent, um, without_empty_columns};
use crate::uncertainty_words::NOT_KNOWN;

/// The section with the vibration of these analyses, by name; nothing without any.
pub fn add_section(report: Report, all: &[(&str, &VibrationAnswer)]) -> Report {
    if all.is_empty() {
        return report;
    }
    report.section("Vibration").table(&table(all))
}

fn table(all: &[(&str, &VibrationAnswer)]) -> Table {
    let mm = |mm: Option<f64>| mm.map_or_else(String::new, |mm| format!("{mm:.3}"));
    let row = |(name, vibration): &(&str, &VibrationAnswer)| {
        let hz = vibration
            .lowest_mode_hz
            .map_or_else(String::new, |[least, greatest]| {
                format!("{least:.1} … {greatest:.1}")
            });
        let mut row = vec![(*name).to_owned(), hz];
        let cut = vibration.cut.as_ref();
        let of = |words: &dyn Fn(&CutVibrationAnswer) -> String| cut.map_or_else(String::new, words);
        row.extend([
            of(&|cut| if cut.is_stable { "stable" } else { "unstable" }.to_owned()),
            of(&|cut| mm(Some(cut.depth_mm))),
            of(&|cut| mm(cut.semi_discretisation_depth_mm.or(cut.stable_depth_mm))),
            of(&|cut| {
                let [x, y, z] = cut.at_mm;
                format!("({x:.0}, {y:.0}, {z:.0})")
            }),
            of(&|cut| match (&cut.cause, cut.chatter_frequency_hz) {
                (Some(cause), Some(hz)) => format!("{cause} at {hz:.1} Hz"),
                _ => String::new(),
            }),
            of(&|cut| {
                cut.probability_stable
                    .map_or_else(|| NOT_KNOWN.to_owned(), percent)
            }),
            um(cut.and_then(|cut| cut.largest_vibration_um)),
            um(cut.and_then(|cut| cut.largest_surface_error_um)),
        ]);
        row
    };
    without_empty_columns(Table {
        caption: "Modes of the arm, and the cut at the point that is nearest to its limit of stability. Vibration: largest distance across the tool from its mean position, by the force of the teeth. Not modelled: process damping, loss of contact, vibration of the part.".to_owned(),
        columns: columns(&[
            ("analysis", ""),
            ("lowest mode of the arm", "Hz"),
            ("programmed cut", ""),
            ("programmed depth", "mm"),
            ("stable depth", "mm"),
            ("at", "mm"),
            ("limited by", ""),
            ("probability that it is stable", "%"),
            ("largest vibration", "µm"),
            ("largest error of a wall by it", "µm"),
        ]),
        rows: all.iter().map(row).collect(),
    })
}
