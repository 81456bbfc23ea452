//! Files of a circular test: the result, tables, pictures and a report in one folder.
//!
//! ```text
//! result.json           the result
//! report.html           quantities, parts, pictures, warnings
//! runs.csv              angle_deg, then a column a run: CW1_um, ...
//! differences.csv       angle_deg, a column a pair of runs, and CW minus CCW
//! parts.csv             a row a part: value and standard uncertainty
//! ballbar.svg           the runs round the nominal circle, magnified
//! repeat-CW.svg         magnitude of the difference of runs of the same direction; repeat-CCW.svg too
//! directions.svg        difference of the directions
//! taught.csv            corrected points, if requested
//! ```
//!
//! Each picture is there as .png too.

use std::path::PathBuf;

use armill_core::measure::ballbar::profile::{STATIONS, station};
use armill_core::measure::ballbar::{Difference, Direction, Profile};
use armill_core::units::{to_deg, to_um};
use armill_formats::file::ResultFolder;
use armill_formats::table::{Column, ColumnData, Table, csv};
use armill_report::html::{Report, Table as Rows};
use armill_report::{BallbarPlot, BallbarTrace, Growth, PathPlot, Sense, Series};
use armill_study::analysis::cells::{columns, input, um};
use armill_study::error::StudyError;
use armill_study::output::{Picture, REPORT, RESULT, picture_files, replace, save_pictures};

use super::analyse::BallbarAnalysis;
use super::answer::{BallbarAnswer, ShownAnswer};

/// The points to teach.
const TAUGHT: &str = "taught.csv";
/// The other tables.
const TABLES: [&str; 3] = ["runs.csv", "differences.csv", "parts.csv"];

/// Writes all files into `out` and returns their paths.
///
/// # Errors
/// A file cannot be written.
pub fn write(
    given: &BallbarAnswer,
    found: &BallbarAnalysis<'_>,
    out: &ResultFolder,
    taught: Option<&[u8]>,
) -> Result<Vec<PathBuf>, StudyError> {
    let drawn = pictures(given, found);
    let names: Vec<String> = TABLES
        .map(str::to_owned)
        .into_iter()
        .chain(taught.map(|_| TAUGHT.to_owned()))
        .chain(drawn.iter().flat_map(picture_files))
        .chain([REPORT.to_owned(), RESULT.to_owned()])
        .collect();
    replace(out, &names, given, &|_| (), |files| {
        let tables = [runs(found)?, differences(found)?, parts(given)?];
        for (name, table) in TABLES.iter().zip(tables) {
            files.save(name, &csv::write(&table))?;
        }
        if let Some(taught) = taught {
            files.save(TAUGHT, taught)?;
        }
        save_pictures(&drawn, files)?;
        files.save(REPORT, html(given, &drawn).as_bytes())?;
        Ok(())
    })
}

/// A number for every station, um; none where samples are missing.
fn stations(name: &str, description: &str, values: &[Option<f64>]) -> Column {
    Column {
        name: format!("{name}_um"),
        unit: Some("um".to_owned()),
        description: description.to_owned(),
        decimals: Some(3),
        data: ColumnData::OptionalFloat(values.iter().map(|value| value.map(to_um)).collect()),
    }
}

/// The angle of every station.
fn angles() -> Column {
    Column {
        name: "angle_deg".to_owned(),
        unit: Some("deg".to_owned()),
        description: "from the first axis of the plane towards the second".to_owned(),
        decimals: Some(3),
        data: ColumnData::Float((0..STATIONS).map(|k| to_deg(station(k))).collect()),
    }
}

fn runs(found: &BallbarAnalysis<'_>) -> Result<Table, StudyError> {
    let of = found.measured.origins.iter().zip(found.test.runs());
    let of = of.map(|(origin, run)| {
        stations(
            &origin.name,
            "radial deviation of the run",
            &Profile::of(run).stations(),
        )
    });
    Ok(Table::new("runs", [angles()].into_iter().chain(of).collect())?)
}

fn differences(found: &BallbarAnalysis<'_>) -> Result<Table, StudyError> {
    let origins = &found.measured.origins;
    let pair = |([one, other], of): &([usize; 2], Difference)| {
        let name = format!("{}_minus_{}", origins[*one].name, origins[*other].name);
        stations(
            &name,
            "difference of two runs of the same direction",
            &of.stations,
        )
    };
    let pairs = found.repeats.iter().map(pair);
    let between = stations(
        "CW_minus_CCW",
        "difference of the directions, of their means",
        &found.between.stations,
    );
    Ok(Table::new(
        "differences",
        [angles()].into_iter().chain(pairs).chain([between]).collect(),
    )?)
}

fn parts(given: &BallbarAnswer) -> Result<Table, StudyError> {
    let radial: Vec<_> = given.parts.iter().flat_map(|parts| &parts.radial).collect();
    let number = |name: &str, description: &str, values: Vec<f64>| Column {
        name: name.to_owned(),
        unit: Some("um".to_owned()),
        description: description.to_owned(),
        decimals: Some(4),
        data: ColumnData::Float(values),
    };
    let names = Column {
        name: "part".to_owned(),
        unit: None,
        description: "kind of the value".to_owned(),
        decimals: None,
        data: ColumnData::Text(radial.iter().map(|part| part.what.clone()).collect()),
    };
    let columns = vec![
        names,
        number(
            "value_um",
            "along the radius",
            radial.iter().map(|part| part.value_um).collect(),
        ),
        number(
            "u_um",
            "standard uncertainty",
            radial.iter().map(|part| part.u_um).collect(),
        ),
    ];
    Ok(Table::new("parts", columns)?)
}

/// The circle, the repeats of each direction that has some, the directions.
pub(crate) fn pictures(given: &BallbarAnswer, found: &BallbarAnalysis<'_>) -> Vec<Picture> {
    let mut pictures = vec![circle(given, found)];
    pictures.extend(
        Direction::BOTH
            .iter()
            .filter_map(|direction| repeats(*direction, found)),
    );
    pictures.extend(found.between.span().map(|_| directions(given, found)));
    pictures
}

/// The subtitle of all pictures.
fn under(given: &BallbarAnswer) -> String {
    let mut parts = vec![format!(
        "radius {} mm",
        armill_study::number::decimals(given.radius_mm, 3)
    )];
    parts.extend(
        given
            .feed_mm_per_min
            .map(|feed| format!("{} mm/min", armill_study::number::decimals(feed, 1))),
    );
    parts.extend(given.plane.as_ref().map(|plane| format!("plane {plane}")));
    parts.push(match given.centring.centre {
        "setup" => "centre as set up".to_owned(),
        _ => "least-squares centre".to_owned(),
    });
    parts.join(", ")
}

fn circle(given: &BallbarAnswer, found: &BallbarAnalysis<'_>) -> Picture {
    let trace = |index: usize| {
        let run = &found.test.runs()[index];
        let radii = Profile::of(run).stations();
        // The first point again, so that the line closes; missing samples interrupt it.
        let closed = (0..=STATIONS).map(|k| radii[k % STATIONS].map_or(f64::NAN, to_um));
        BallbarTrace {
            name: found.measured.origins[index].name.clone(),
            sense: match run.direction() {
                Direction::Clockwise => Sense::Clockwise,
                Direction::Anticlockwise => Sense::Anticlockwise,
            },
            angle_deg: (0..=STATIONS).map(|k| to_deg(station(k))).collect(),
            radial_um: closed.collect(),
            start_deg: Some(given.runs[index].start_deg),
        }
    };
    let g = given
        .circular_bidirectional_um
        .map(|g| format!("; G(b) {g:.1} µm"));
    let picture = BallbarPlot {
        title: "Circular test".to_owned(),
        subtitle: under(given) + &g.unwrap_or_default(),
        horizontal: given.axes[0].clone(),
        vertical: given.axes[1].clone(),
        growth: Growth::Right,
        traces: (0..found.test.runs().len()).map(trace).collect(),
        marks: Vec::new(),
    };
    Picture {
        name: "ballbar".to_owned(),
        caption: "The runs about the nominal circle, magnified: radial deviation, positive outwards. The first run of each direction \
                  is solid, repeats are dashed."
            .to_owned(),
        svg: picture.to_svg(),
    }
}

/// A line along the angle, um.
fn along(name: String, values: &[Option<f64>], of: fn(f64) -> f64) -> Series {
    Series {
        name,
        position: (0..STATIONS).map(|k| to_deg(station(k))).collect(),
        deviation_um: values
            .iter()
            .map(|value| value.map_or(f64::NAN, |v| of(to_um(v))))
            .collect(),
    }
}

/// What runs of a direction differ by from its first; `None` of a single run.
fn repeats(direction: Direction, found: &BallbarAnalysis<'_>) -> Option<Picture> {
    let first = found
        .test
        .runs()
        .iter()
        .position(|run| run.direction() == direction)?;
    let of = found.repeats.iter().filter(|([one, _], _)| *one == first);
    let series: Vec<Series> = of
        .map(|([one, other], of)| {
            let [one, other] = [*one, *other].map(|index| found.measured.origins[index].name.as_str());
            along(format!("|{one} − {other}|"), &of.stations, f64::abs)
        })
        .collect();
    if series.is_empty() {
        return None;
    }
    let picture = PathPlot {
        title: format!("Repeatability, {}", direction.name()),
        subtitle: "magnitude of the difference of the radius between runs of the same direction".to_owned(),
        position_label: "angle (deg)".to_owned(),
        quantity: "difference (µm)".to_owned(),
        series,
        envelope: None,
        tolerance_um: None,
    };
    Some(Picture {
        name: format!("repeat-{}", direction.name()),
        caption: format!("What {} runs differ by along the circle.", direction.name()),
        svg: picture.to_svg(),
    })
}

fn directions(given: &BallbarAnswer, found: &BallbarAnalysis<'_>) -> Picture {
    let picture = PathPlot {
        title: "Clockwise minus anticlockwise".to_owned(),
        subtitle: under(given),
        position_label: "angle (deg)".to_owned(),
        quantity: "difference (µm)".to_owned(),
        series: vec![along("CW − CCW".to_owned(), &found.between.stations, |um| um)],
        envelope: None,
        tolerance_um: None,
    };
    Picture {
        name: "directions".to_owned(),
        caption:
            "What the mean clockwise run has more than the mean anticlockwise one: backlash, lag, friction."
                .to_owned(),
        svg: picture.to_svg(),
    }
}

/// The page.
fn html(given: &BallbarAnswer, drawn: &[Picture]) -> String {
    let mut report = Report::new(&format!("Circular test: {}", given.files.join(", ")))
        .question("What is the circularity, and what causes the deviation?")
        .answer(&sentence(given));
    for warning in &given.warnings {
        report = report.warning(warning);
    }
    report = report.section("Quantities").table(&quantities(given));
    for picture in drawn {
        report = report.picture(&picture.svg, &picture.caption);
    }
    if let Some(parts) = &given.parts {
        let row = |part: &super::answer::PartAnswer| {
            vec![
                part.what.clone(),
                format!("{:.2}", part.value_um),
                format!("{:.2}", 2.0 * part.u_um),
            ]
        };
        report = report.section("Parts").table(&Rows {
            caption: format!(
                "Contributions to the radial deviation; ± is twice the standard uncertainty. About the circle {:.1} µm rms, unexplained {:.1} µm.",
                parts.rms_before_um, parts.rms_after_um
            ),
            columns: columns(&[("part", ""), ("along the radius", "µm"), ("±", "µm")]),
            rows: parts.radial.iter().map(row).collect(),
        });
    }
    for results in &given.results {
        let row = |feature: &super::results::FeatureAnswer| {
            let ours = feature.ours.map_or_else(String::new, |ours| format!("{ours:.1}"));
            vec![
                feature.name.clone(),
                feature.value.to_string(),
                ours,
                feature.unit.clone(),
            ]
        };
        report = report.section("Results of the ball-bar software").table(&Rows {
            caption: format!(
                "{}: values only, no radii. Definitions and signs may differ from those of armill.",
                results.file
            ),
            columns: columns(&[
                ("result", ""),
                ("ball-bar software", "-"),
                ("armill", "-"),
                ("unit", ""),
            ]),
            rows: results.features.iter().map(row).collect(),
        });
    }
    if let Some(before) = &given.before {
        let row = |of: &super::teach::ComparedQuantity| {
            let left = of
                .left_percent
                .map_or_else(String::new, |left| format!("{left:.0}"));
            vec![of.what.to_owned(), um(of.before_um), um(of.after_um), left]
        };
        report = report.section("Before and after").table(&Rows {
            caption: format!("Before: {}.", before.files.join(", ")),
            columns: columns(&[("quantity", ""), ("before", "µm"), ("after", "µm"), ("left", "%")]),
            rows: before.compared.iter().map(row).collect(),
        });
    }
    let runs = given
        .runs
        .iter()
        .map(|run| input(&run.name, run.samples.to_string(), "samples", &run.file));
    report.inputs(runs).to_html()
}

/// The main result in one sentence.
pub fn sentence(given: &BallbarAnswer) -> String {
    let g = match given.circular_bidirectional_um {
        Some(g) => format!("The bidirectional circular deviation G(b) is {g:.1} µm"),
        None => {
            let of = given.directions.iter().filter_map(|of| of.shown.circular_um);
            format!("The circular deviation G is {:.1} µm", of.fold(0.0, f64::max))
        }
    };
    match &given.between_directions {
        Some(between) => format!(
            "{g}; the directions differ by up to {:.1} µm, at {:.0} deg.",
            between.max_um.abs(),
            between.max_at_deg
        ),
        None => format!("{g}."),
    }
}

fn quantities(given: &BallbarAnswer) -> Rows {
    let row = |name: &str, shown: &ShownAnswer| {
        vec![
            name.to_owned(),
            um(shown.circular_um),
            um(Some(shown.radial_max_um)),
            um(Some(shown.radial_min_um)),
        ]
    };
    let runs = given.runs.iter().map(|run| row(&run.name, &run.shown));
    let directions = given
        .directions
        .iter()
        .map(|of| row(&format!("all {}", of.direction), &of.shown));
    Rows {
        caption: format!(
            "Circular deviation G (minimum zone) and radial deviation F from the {} centre. G(b) {} µm, D {} µm, H {} µm.",
            given.centring.centre,
            um(given.circular_bidirectional_um),
            um(given.mean_bidirectional_um),
            um(given.hysteresis_um)
        ),
        columns: columns(&[("runs", ""), ("G", "µm"), ("F max", "µm"), ("F min", "µm")]),
        rows: runs.chain(directions).collect(),
    }
}
