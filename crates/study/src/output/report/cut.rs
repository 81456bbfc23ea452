//! The cut of the forces: material with its coefficients, cutter, depths, feed and spindle, largest forces.
//!
//! Coefficients are in the units of catalogues, N/mm² of the chip and N/mm of the edge, each with its standard
//! uncertainty; lengths in mm, feed in mm/min, speed in rev/min.

use std::f64::consts::TAU;

use armill_core::load::{Cutter, CuttingLaw, Estimate, Hand, Immersion};
use armill_core::units::{to_deg, to_mm, to_um};
use armill_report::html::Input;

use crate::analysis::Subject;
use crate::analysis::cells::input;
use crate::analysis::path::{Cut, PathAnalysis};
use crate::answer::{StudyAnswer, sources_of_cut};
use crate::file::resolve::Study;
use crate::output::report::sources::{THE_STUDY, place};

/// The rows of every cut of the study; of equal ones the first. Where several differ each row names its program.
pub(super) fn rows(study: &Study, answer: &StudyAnswer) -> Vec<Input> {
    let mut given: Vec<(&str, &PathAnalysis, &Cut)> = Vec::new();
    for analysis in &study.analyses {
        let Subject::Path(path) = &analysis.subject else {
            continue;
        };
        if let Some(cut) = &path.cut
            && given.iter().all(|(_, _, other)| other.cutting != cut.cutting)
        {
            given.push((&analysis.name, path, cut));
        }
    }
    let several = given.len() > 1;
    let of = |(name, path, cut): (&str, &PathAnalysis, &Cut)| {
        let mut rows = of_cut(answer, name, path, cut);
        if several {
            for row in &mut rows {
                row.name = format!("{name}: {}", row.name);
            }
        }
        rows
    };
    given.into_iter().flat_map(of).collect()
}

/// The rows of one cut, from the material to the resulting forces.
fn of_cut(answer: &StudyAnswer, name: &str, path: &PathAnalysis, cut: &Cut) -> Vec<Input> {
    let sources = sources_of_cut(cut);
    let places: Vec<String> = sources.iter().map(|source| place(answer, &source.key)).collect();
    let of_material = places.join("; ");
    let mut rows = vec![input("material", cut.material.name.clone(), "", &of_material)];
    rows.extend(coefficients(&cut.cutting.law, &of_material));
    let study = |name: &str, value: String, unit: &str| input(name, value, unit, THE_STUDY);
    rows.push(study("cutter", cutter(&cut.cutting.cutter), ""));
    rows.push(study("axial depth", plain(to_mm(cut.cutting.depth)), "mm"));
    let (radial, unit) = match cut.cutting.immersion {
        Immersion::Slot => ("whole diameter, a slot".to_owned(), ""),
        Immersion::Up(depth) => (format!("{}, up-milling", plain(to_mm(depth))), "mm"),
        Immersion::Down(depth) => (format!("{}, down-milling", plain(to_mm(depth))), "mm"),
        Immersion::Centred(depth) => (format!("{}, centred", plain(to_mm(depth))), "mm"),
    };
    rows.push(study("radial depth", radial, unit));
    let given = |value: Option<f64>| {
        value.map_or_else(
            || "as in the program".to_owned(),
            |value| format!("{}, unless the program specifies it", plain(value)),
        )
    };
    let unit = |value: Option<f64>, unit: &'static str| value.map_or("", |_| unit);
    let feed = cut.cutting.feed;
    rows.push(study("feed", given(feed.map(|v| v * 60e3)), unit(feed, "mm/min")));
    let spindle = cut.cutting.spindle;
    let rpm = given(spindle.map(|v| v * 60.0 / TAU));
    rows.push(study("spindle", rpm, unit(spindle, "rev/min")));
    if let Some(stock) = &cut.stock {
        let [from, to] = stock.corners().map(|corner| {
            let [x, y, z] = [corner.x, corner.y, corner.z].map(|metres| plain(to_mm(metres)));
            format!("({x}, {y}, {z})")
        });
        let cell = plain(to_mm(stock.pitch()));
        rows.push(study("stock", format!("{from} to {to}, cells of {cell}"), "mm"));
    }
    let given = answer.paths.iter().find(|path| path.name == name);
    if let Some(of_cut) = given.and_then(|path| path.cut.as_ref()) {
        let (mean, peak) = (of_cut.largest_mean_n, of_cut.largest_peak_n);
        let u = mean * path.setting.uncertainty.relative;
        let computed = "computed from the rows above";
        rows.push(input(
            "largest mean force of a revolution",
            format!("{mean:.1} ± {u:.1}"),
            "N",
            computed,
        ));
        rows.push(input(
            "largest force within a revolution",
            format!("{peak:.1}"),
            "N",
            computed,
        ));
    }
    rows
}

/// The coefficients of the law with their source; ratios of Kienzle's law come from the study or are assumed.
fn coefficients(law: &CuttingLaw, source: &str) -> Vec<Input> {
    let row = |name: &str, estimate: Estimate, per: f64, unit: &str| {
        let value = format!(
            "{} ± {}",
            plain(estimate.value / per),
            plain(estimate.standard_uncertainty / per)
        );
        input(name, value, unit, source)
    };
    match law {
        CuttingLaw::Mechanistic(law) => {
            let of = |(i, name): (usize, &&str)| {
                let estimate = Estimate {
                    value: law.coefficients()[i],
                    standard_uncertainty: law.covariance()[(i, i)].max(0.0).sqrt(),
                };
                let (per, unit) = if i < 3 { (1e6, "N/mm²") } else { (1e3, "N/mm") };
                row(name, estimate, per, unit)
            };
            MECHANISTIC.iter().enumerate().map(of).collect()
        }
        CuttingLaw::Kienzle(law) => {
            let values = law.values();
            let ratio = |name: &str, estimate| {
                let mut row = row(name, estimate, 1.0, "");
                THE_STUDY_OR_ASSUMED.clone_into(&mut row.source);
                row
            };
            vec![
                row("specific force kc1.1", values.specific_force, 1e6, "N/mm²"),
                row("exponent mc", values.exponent, 1.0, ""),
                ratio("radial over cutting force", values.radial_ratio),
                ratio("axial over cutting force", values.axial_ratio),
            ]
        }
    }
}

/// Names of the mechanistic coefficients, in the order of the core.
const MECHANISTIC: [&str; 6] = [
    "tangential, of the chip (Ktc)",
    "radial, of the chip (Krc)",
    "axial, of the chip (Kac)",
    "tangential, of the edge (Kte)",
    "radial, of the edge (Kre)",
    "axial, of the edge (Kae)",
];
/// Source of values that no source of a material gives.
const THE_STUDY_OR_ASSUMED: &str = "the study; assumed by armill if not specified";

/// A cutter in the form of a catalogue; zero values are left out.
fn cutter(cutter: &Cutter) -> String {
    let mut parts = vec![format!("{} mm", plain(to_mm(cutter.diameter())))];
    let corner = cutter.corner_radius();
    if corner >= cutter.radius() {
        parts.push("ball nose".to_owned());
    } else if corner > 0.0 {
        parts.push(format!("corner radius {} mm", plain(to_mm(corner))));
    }
    parts.push(match cutter.flutes() {
        1 => "1 flute".to_owned(),
        flutes => format!("{flutes} flutes"),
    });
    let hand = match cutter.hand() {
        Hand::Right => "right-hand",
        Hand::Left => "left-hand",
    };
    parts.push(format!("{hand} helix {} deg", plain(to_deg(cutter.helix()))));
    if cutter.rake() != 0.0 {
        parts.push(format!("rake {} deg", plain(to_deg(cutter.rake()))));
    }
    if cutter.runout().offset > 0.0 {
        parts.push(format!("runout {} µm", plain(to_um(cutter.runout().offset))));
    }
    parts.join(", ")
}

/// Four digits, without trailing zeros.
fn plain(value: f64) -> String {
    let digits = if value == 0.0 {
        0
    } else {
        (3 - value.abs().log10().floor() as i32).clamp(0, 9)
    };
    let rounded = format!("{value:.*}", digits as usize);
    if rounded.contains('.') {
        rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        rounded
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits_and_no_zeros_behind_them() {
        let given = [0.0, 6.000000001, 0.25, 1012.595, 189.3, 12.3456, 9000.0, 10.0].map(plain);
        assert_eq!(given, ["0", "6", "0.25", "1013", "189.3", "12.35", "9000", "10"]);
    }

    #[test]
    fn a_cutter_is_described_as_in_its_catalogue() {
        let given = |made: Result<Cutter, _>| made.map(|made| cutter(&made)).unwrap_or_default();
        assert_eq!(
            given(Cutter::flat(6e-3, 2).and_then(|c| c.with_helix(30_f64.to_radians(), Hand::Right))),
            "6 mm, 2 flutes, right-hand helix 30 deg"
        );
        assert!(given(Cutter::ball(8e-3, 4)).starts_with("8 mm, ball nose, 4 flutes"));
        assert!(given(Cutter::bull_nose(8e-3, 1e-3, 1)).starts_with("8 mm, corner radius 1 mm, 1 flute,"));
    }
}
