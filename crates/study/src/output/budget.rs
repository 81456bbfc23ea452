//! Table and pictures of a budget.
//!
//! ```text
//! budget.csv         one row per angle: each contribution, their sum, the part and the residual
//! NAME-budget.svg    magnitude of each contribution, the sums and the part; each picture as .png too
//! NAME-measured.svg  part and prediction about the circle, magnified
//! NAME-waves.svg     amplitude and phase per harmonic
//! ```
//!
//! `armill run` includes the pictures and `tables` in its report.

use std::path::PathBuf;

use armill_core::measure::ballbar::profile::is_gap;
use armill_core::units::{to_deg, to_um};
use armill_formats::file::ResultFolder;
use armill_formats::table::{Column, ColumnData, Table, csv};
use armill_report::{
    BudgetBar, BudgetBars, BudgetGroup, Growth, PolarPlot, RadialSeries, WaveBar, WaveBars, html,
};

use crate::StudyError;
use crate::analysis::cells::columns;
use crate::analysis::picture::Picture;
use crate::budget::answer::{BudgetAnswer, PartAnswer, WithoutLoadAnswer};
use crate::budget::combine::CombinedCurves;
use crate::file_names::slug;
use crate::output::picture_files::{picture_files, write_pictures};

/// The table.
const TABLE: &str = "budget.csv";

/// Writes table and pictures into the folder `out` and returns their paths.
///
/// # Errors
/// The folder or a file cannot be written.
pub fn write(
    given: &BudgetAnswer,
    combined: &CombinedCurves,
    out: &ResultFolder,
) -> Result<Vec<PathBuf>, StudyError> {
    let pictures = pictures(given, combined);
    let files: Vec<String> = pictures.iter().flat_map(picture_files).collect();
    out.allow(files.iter().map(String::as_str).chain([TABLE]))?;
    out.write(TABLE, &table_csv(given, combined)?)?;
    write_pictures(&pictures, out)?;
    out.finish()?;
    let named = pictures.iter().map(|picture| format!("{}.svg", picture.name));
    let names = std::iter::once(TABLE.to_owned()).chain(named);
    Ok(names.map(|name| out.path().join(name)).collect())
}

/// The table of all curves, a row an angle, as CSV.
///
/// # Errors
/// A table that cannot be written, which is a defect of armill.
pub fn table_csv(given: &BudgetAnswer, combined: &CombinedCurves) -> Result<Vec<u8>, StudyError> {
    Ok(csv::write(&table_of(given, combined)?))
}

/// Whether a picture of this name is one of [`pictures`] of this analysis.
pub(crate) fn is_of_budget(name: &str, analysis: &str) -> bool {
    let what = name
        .strip_prefix(&slug(analysis))
        .and_then(|rest| rest.strip_prefix('-'));
    matches!(what, Some("budget" | "measured" | "waves"))
}

/// The pictures: bars; with a part the circle and its waves.
pub(crate) fn pictures(given: &BudgetAnswer, combined: &CombinedCurves) -> Vec<Picture> {
    let picture = |what: &str, caption: &str, svg: String| Picture {
        name: format!("{}-{what}", slug(&given.analysis)),
        caption: format!("{}: {caption}", given.analysis),
        svg,
    };
    let mut pictures = vec![
        picture("budget", "contributions to the radial deviation.", bars(given)),
        picture(
            "measured",
            "radial deviation, predicted and measured, magnified.",
            circle(given, combined),
        ),
    ];
    pictures.extend(
        given
            .part
            .as_ref()
            .filter(|part| !part.waves.is_empty())
            .map(|part| {
                picture(
                    "waves",
                    "amplitudes of the part and of its prediction.",
                    waves(given, part),
                )
            }),
    );
    pictures
}

/// Datum of all curves, in a line.
fn subtitle(given: &BudgetAnswer) -> String {
    let mut parts = vec![
        format!("circle of {} mm", crate::number::decimals(given.radius_mm, 3)),
        given.branch.clone(),
    ];
    for (what, from) in [("centre", given.datum.centre), ("radius", given.datum.radius)] {
        parts.push(format!("{what} {from}"));
    }
    parts.join("; ")
}

fn bars(given: &BudgetAnswer) -> String {
    let bar = |label: &str, group: BudgetGroup, largest_um: f64, scatter_um: f64| BudgetBar {
        label: label.to_owned(),
        group,
        largest_um,
        scatter_um,
    };
    let mut bars: Vec<BudgetBar> = given
        .contributions
        .iter()
        .map(|one| {
            bar(
                &one.name,
                BudgetGroup::Contribution,
                one.largest_um,
                one.scatter_um,
            )
        })
        .collect();
    let sums = &given.sums;
    let half = (sums.with_scatter_um - sums.as_functions_um).max(0.0) / 2.0;
    bars.push(bar(
        "added with their signs",
        BudgetGroup::Sum,
        sums.as_functions_um,
        half,
    ));
    bars.push(bar(
        "root of the squares",
        BudgetGroup::Sum,
        sums.root_sum_square_um,
        0.0,
    ));
    bars.push(bar("plain sum", BudgetGroup::Sum, sums.plain_um, 0.0));
    if let Some(part) = &given.part {
        bars.push(bar("part", BudgetGroup::Measured, part.largest_um, 0.0));
        bars.push(bar(
            "not explained",
            BudgetGroup::Measured,
            part.residual.largest_um,
            0.0,
        ));
    }
    let picture = BudgetBars {
        title: format!("{}: error budget", given.analysis),
        subtitle: subtitle(given),
        quantity: "largest radial deviation (µm)".to_owned(),
        bars,
    };
    picture.to_svg()
}

fn circle(given: &BudgetAnswer, combined: &CombinedCurves) -> String {
    let balance = &combined.balance;
    let closed = |name: &str, curve: &[f64]| {
        let angle = combined.turn.angle();
        let (mut angle_deg, mut radial_um) = (Vec::new(), Vec::new());
        for k in 0..angle.len() {
            let next = angle
                .get(k + 1)
                .copied()
                .or_else(|| Some(angle.first()? + std::f64::consts::TAU));
            angle_deg.push(to_deg(angle[k]));
            radial_um.push(to_um(curve[k]));
            if next.is_some_and(|next| is_gap(next - angle[k])) {
                angle_deg.push(to_deg(angle[k]));
                radial_um.push(f64::NAN);
            }
        }
        angle_deg.extend(angle.first().map(to_deg));
        radial_um.extend(curve.first().map(to_um));
        RadialSeries {
            name: name.to_owned(),
            angle_deg,
            radial_um,
        }
    };
    let part = balance.comparison.as_ref();
    let mut series: Vec<RadialSeries> = part
        .map(|part| closed("part", &part.measured))
        .into_iter()
        .collect();
    series.push(closed("predicted together", &balance.sums.bias));
    let parts = balance
        .contributions
        .iter()
        .filter(|one| one.bias.iter().any(|b| *b != 0.0));
    series.extend(parts.map(|one| closed(&one.name, &one.bias)));
    series.extend(
        combined
            .without_load
            .as_ref()
            .map(|path| closed("path without load, predicted", &path.predicted)),
    );
    let picture = PolarPlot {
        title: format!("{}: predicted and measured", given.analysis),
        subtitle: subtitle(given),
        horizontal: "base y".to_owned(),
        vertical: "z′".to_owned(),
        growth: Growth::Left,
        zero: "reference circle".to_owned(),
        series,
        references: Vec::new(),
    };
    picture.to_svg()
}

fn waves(given: &BudgetAnswer, part: &PartAnswer) -> String {
    let wave = |wave: &crate::budget::answer::WaveAnswer| WaveBar {
        waves: wave.waves,
        measured_um: wave.measured_um,
        predicted_um: wave.predicted_um,
        phase_difference_deg: wave.phase_difference_deg,
    };
    let picture = WaveBars {
        title: format!("{}: wave by wave", given.analysis),
        subtitle: format!("{:.1} % of the part explained", part.explained_percent),
        names: ["part".to_owned(), "predicted".to_owned()],
        waves: part.waves.iter().map(wave).collect(),
    };
    picture.to_svg()
}

/// The budget in a paragraph.
pub(crate) fn in_words(given: &BudgetAnswer) -> String {
    let sums = &given.sums;
    let mut text = format!(
        "{}: largest contribution of the load {:.1} µm, of the path without load {:.1} µm. Largest signed sum over all angles \
         {:.1} µm, plain sum {:.1} µm.",
        given.analysis, sums.load_um, sums.unloaded_um, sums.as_functions_um, sums.plain_um
    );
    if let Some(part) = &given.part {
        text.push_str(&format!(
            " The largest deviation of the part is {:.1} µm; {:.1} % of its mean square are explained, {:.1} % can be explained. The \
             residual is {:.1} µm rms, {:.1} µm of it beyond known scatter and uncertainty.",
            part.largest_um,
            part.explained_percent,
            part.explainable_percent,
            part.residual.rms_um,
            part.residual.beyond_known_um
        ));
    }
    text
}

/// Contributions; waves of the part.
pub(crate) fn tables(given: &BudgetAnswer) -> Vec<html::Table> {
    let um = |value: f64| format!("{value:.2}");
    let percent = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| format!("{value:.1}"));
    let contributions = html::Table {
        caption: "Contributions, and the percentage of the part explained by each alone, and by the others without it."
            .to_owned(),
        columns: columns(&[
            ("contribution", ""),
            ("largest", "µm"),
            ("at", "deg"),
            ("rms", "µm"),
            ("scatter", "µm"),
            ("uncertainty", "µm"),
            ("alone", "%"),
            ("without", "%"),
        ]),
        rows: (given.contributions.iter())
            .map(|one| {
                vec![
                    one.name.clone(),
                    um(one.largest_um),
                    format!("{:.1}", one.largest_at_deg),
                    um(one.rms_um),
                    um(one.scatter_um),
                    one.bias_u_um.map_or_else(|| "–".to_owned(), um),
                    percent(one.explained_alone_percent),
                    percent(one.explained_without_percent),
                ]
            })
            .collect(),
    };
    let of_part = |part: &PartAnswer| html::Table {
        caption: "Part and prediction, wave by wave.".to_owned(),
        columns: columns(&[
            ("harmonic", ""),
            ("part", "µm"),
            ("predicted", "µm"),
            ("phase difference", "deg"),
            ("explained", "%"),
        ]),
        rows: (part.waves.iter())
            .map(|wave| {
                vec![
                    wave.waves.to_string(),
                    um(wave.measured_um),
                    um(wave.predicted_um),
                    percent(wave.phase_difference_deg),
                    percent(wave.explained_percent),
                ]
            })
            .collect(),
    };
    let waves = given
        .part
        .as_ref()
        .filter(|part| !part.waves.is_empty())
        .map(of_part);
    let unloaded = given.without_load.as_ref().map(without_load);
    std::iter::once(contributions)
        .chain(unloaded)
        .chain(waves)
        .collect()
}

/// The path without load: predicted and measured.
fn without_load(given: &WithoutLoadAnswer) -> html::Table {
    let row = |name: &str, [most_um, at_deg, rms_um]: [f64; 3], shares: [Option<f64>; 2]| {
        let percent =
            |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| format!("{value:.1}"));
        vec![
            name.to_owned(),
            format!("{most_um:.2}"),
            format!("{at_deg:.1}"),
            format!("{rms_um:.2}"),
            percent(shares[0]),
            percent(shares[1]),
        ]
    };
    html::Table {
        caption: "The path without load. The measured path is included in the sums, the predicted one is for comparison."
            .to_owned(),
        columns: columns(&[
            ("path without load", ""),
            ("largest", "µm"),
            ("at", "deg"),
            ("rms", "µm"),
            ("explained", "%"),
            ("similarity", "%"),
        ]),
        rows: vec![
            row(
                "measured",
                [given.measured_um, given.measured_at_deg, given.measured_rms_um],
                [None; 2],
            ),
            row(
                "predicted",
                [given.predicted_um, given.predicted_at_deg, given.predicted_rms_um],
                [Some(given.explained_percent), given.likeness_percent],
            ),
        ],
    }
}

/// A row an angle.
fn table_of(given: &BudgetAnswer, combined: &CombinedCurves) -> Result<Table, StudyError> {
    let column = |name: String, unit: &str, (decimals, data): (u8, Vec<f64>)| Column {
        name,
        unit: Some(unit.to_owned()),
        description: String::new(),
        decimals: Some(decimals),
        data: ColumnData::Float(data),
    };
    let um = |curve: &[f64]| (4, curve.iter().map(to_um).collect());
    let angle = combined.turn.angle().iter().map(to_deg).collect();
    let mut columns = vec![column("angle_deg".to_owned(), "deg", (4, angle))];
    let balance = &combined.balance;
    for (one, said) in balance.contributions.iter().zip(&given.contributions) {
        let name = slug(&said.name).replace('-', "_");
        columns.push(column(format!("{name}_um"), "um", um(&one.bias)));
    }
    columns.push(column("sum_um".to_owned(), "um", um(&balance.sums.bias)));
    columns.push(column("scatter_um".to_owned(), "um", um(&balance.sums.scatter)));
    if let Some(path) = &combined.without_load {
        let name = "predicted_without_load_um".to_owned();
        columns.push(column(name, "um", um(&path.predicted)));
    }
    if let Some(part) = &balance.comparison {
        columns.push(column("part_um".to_owned(), "um", um(&part.measured)));
        columns.push(column(
            "residual_um".to_owned(),
            "um",
            um(&part.together.residual),
        ));
    }
    Ok(Table::new("budget", columns)?)
}
