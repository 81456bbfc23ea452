//! `armill ballbar`: circularity and its causes, from ball-bar files.
//!
//! Stdout has a [`BallbarAnswer`], as text or JSON; `--out` receives it with tables, pictures and a report, `--teach`
//! the points of the corrected circle, `--program` a robot program of it.
//!
//! ```text
//! circle of 100 mm in XY, 1000 mm/min; least-squares centre, (12.1, -3.4) um from the set-up
//! runs   G   F max   F min           each run, then each direction
//! G(b), D, H                         ISO 230-4
//! differences                        between runs of the same direction, and between directions
//! parts                              contributions to the circular deviation, with standard uncertainty
//! lobes                              common to both directions
//! ```

use std::path::PathBuf;

use armill_formats::measurement::ballbar::{BallbarReadOptions, direction_of};
use armill_measure::ballbar::answer::{LobeAnswer, PartAnswer, ShownAnswer};
use armill_measure::ballbar::results::FeatureAnswer;
use armill_measure::ballbar::teach::ComparedQuantity;
use armill_measure::ballbar::{
    BallbarAnalysis, BallbarAnswer, Centring, CirclePlacement, Cyclic, Question, TaughtAnswer, TaughtCircle,
    analyse, answer, before, output, points_within, sagitta, taught_program, teach,
};
use armill_programs::Written;
use armill_study::StudyError;
use armill_study::measured::circular_test::{FileOptions, MeasuredTest, read};
use armill_study::number::decimals;
use armill_study::studies;

use super::numbers::{above_zero, finite};
use super::program::{self, save};
use crate::Outcome;
use crate::arguments::{BallbarArguments, CentreChoice};
use crate::terminal::{Align, columns, print, say};

/// Highest lobe: higher ones cannot be measured.
const MOST_LOBES: usize = 360;
/// Default and greatest number of corrected points.
const USUAL_POINTS: usize = 72;
const MOST_POINTS: usize = 3600;
/// Number of outliers listed in the text.
const MOST_OUTLIERS: usize = 10;

/// Reads, analyses, writes the requested files and prints the result.
///
/// # Errors
/// Files that cannot be read, or their problems; invalid options; files that cannot be written.
pub(crate) fn run(arguments: &BallbarArguments) -> Result<Outcome, StudyError> {
    let (requested, question) = (requested(arguments)?, question(arguments)?);
    let measured = read(&arguments.files, &requested)?;
    let found = analyse(&measured, &question)?;
    let mut answer = answer(&measured, &question, &found);
    if !arguments.before.is_empty() {
        let first = read(&arguments.before, &requested)?;
        let shown = analyse(&first, &question)?;
        answer.before = Some(before((&first, &shown), (&measured, &found))?);
    }
    let taught = taught(arguments, (&measured, &found))?;
    let table = match &taught {
        None => None,
        Some((given, circle, _)) => {
            answer.warnings.extend(given.warnings(arguments.teach_lobes));
            answer.taught = Some(given.clone());
            Some(circle.csv()?)
        }
    };
    let writer = arguments.writing.writer("ballbar");
    if let Some(out) = &arguments.out {
        let out = writer.folder(out)?;
        output::write(&answer, (&measured, &found), (&out, table.as_deref()))?;
        say(&format!(
            "tables, pictures and report in {}",
            out.path().display()
        ));
    }
    // Last, so that no points are written if the folder cannot be written.
    if let (Some(file), Some(table)) = (&arguments.teach, &table) {
        writer.write(file, table)?;
        say(&format!("corrected points in {}", file.display()));
    }
    if let Some((_, _, Some((folder, written)))) = &taught {
        save(&writer, folder, written)?;
    }
    for warning in &answer.warnings {
        say(&format!("warning: {warning}"));
    }
    print(&if arguments.json {
        serde_json::to_string_pretty(&answer)?
    } else {
        as_text(&answer)
    })?;
    Ok(Outcome::Fine)
}

/// A program and its folder.
type Program = (PathBuf, Written);

/// The corrected circle, if requested, and its program.
fn taught(
    arguments: &BallbarArguments,
    (measured, found): (&MeasuredTest, &BallbarAnalysis),
) -> Result<Option<(TaughtAnswer, TaughtCircle, Option<Program>)>, StudyError> {
    let file_feed = measured.feed.map(|feed| feed * 60e3);
    let program = program::requested(&arguments.program, arguments.feed_mm_per_min.or(file_feed))?;
    if arguments.teach.is_none() && program.is_none() {
        return Ok(None);
    }
    let radius = measured.test.radius();
    let needed = program
        .as_ref()
        .map(|(_, requested)| points_within(radius, requested.within));
    let points = arguments
        .points
        .unwrap_or(needed.unwrap_or(USUAL_POINTS).min(MOST_POINTS));
    if points <= 2 * arguments.teach_lobes {
        let message = format!(
            "--points: {points} points are too few for the {} lobes of --teach-lobes",
            arguments.teach_lobes
        );
        return Err(StudyError::value(message, "more than two points per lobe"));
    }
    let (given, circle) = teach(found, (points, arguments.teach_lobes))?;
    let Some((folder, requested)) = program else {
        return Ok(Some((given, circle, None)));
    };
    let Some(study) = &arguments.study else {
        return Err(StudyError::value(
            "--program requires a study that gives the circle and the robot",
            "--study STUDY",
        ));
    };
    finite("--zero-deg", &[arguments.zero_deg])?;
    let place = CirclePlacement {
        analysis: arguments.analysis.clone(),
        zero: arguments.zero_deg.to_radians(),
        mirrored: arguments.mirrored,
    };
    let study = studies::find(study)?.read()?;
    let mut written = taught_program(&study, &circle, &place, &requested)?;
    let sagitta = sagitta(radius, points);
    if sagitta > requested.within {
        written.notes.push(format!(
            "linear moves between {points} points deviate by {:.1} um from the circle; {} points are within {} um",
            sagitta * 1e6,
            points_within(radius, requested.within),
            arguments.program.within_um
        ));
    }
    Ok(Some((given, circle, Some((folder, written)))))
}

/// Data that the files do not contain.
fn requested(arguments: &BallbarArguments) -> Result<FileOptions, StudyError> {
    let direction = arguments.direction.as_deref().map(|word| {
        direction_of(word).ok_or_else(|| {
            StudyError::value(format!("--direction: `{word}` is not a direction"), "CW or CCW")
        })
    });
    let positive = |flag: &str, value: Option<f64>| value.map(|value| above_zero(flag, value)).transpose();
    finite("--start-deg", arguments.start_deg.as_slice())?;
    Ok(FileOptions {
        given: BallbarReadOptions {
            radius: positive("--radius-mm", arguments.radius_mm)?.map(|mm| mm * 1e-3),
            direction: direction.transpose()?,
            start: arguments.start_deg.map(f64::to_radians),
        },
        plane: arguments.plane.clone(),
        feed: positive("--feed-mm-per-min", arguments.feed_mm_per_min)?.map(|feed| feed / 60e3),
    })
}

/// Settings of the analysis.
fn question(arguments: &BallbarArguments) -> Result<Question, StudyError> {
    for (flag, value, [least, most]) in [
        ("--lobes", arguments.lobes, [0, MOST_LOBES]),
        ("--teach-lobes", arguments.teach_lobes, [0, MOST_LOBES]),
        (
            "--points",
            arguments.points.unwrap_or(USUAL_POINTS),
            [3, MOST_POINTS],
        ),
    ] {
        if !(least..=most).contains(&value) {
            let message = format!("{flag}: {value} is outside {least} to {most}");
            return Err(StudyError::value(message, "see `armill ballbar --help`"));
        }
    }
    finite("--reversal-deg", &arguments.reversal_deg)?;
    let cyclic = match arguments.cyclic.as_deref() {
        None => Cyclic::None,
        Some("search") => Cyclic::Search,
        Some(word) => {
            let period = word.parse().map_err(|_| {
                StudyError::value(
                    format!("--cyclic: `{word}` is not a period"),
                    "millimetres such as 10, or `search`",
                )
            })?;
            Cyclic::Period(above_zero("--cyclic", period)? * 1e-3)
        }
    };
    Ok(Question {
        centring: match arguments.centre {
            CentreChoice::Setup => Centring::Setup,
            CentreChoice::LeastSquares => Centring::LeastSquares,
        },
        most_lobes: arguments.lobes,
        cyclic,
        reversals: arguments
            .reversal_deg
            .iter()
            .map(|deg| deg.to_radians())
            .collect(),
        axes_reverse: !arguments.no_axes,
        without_outliers: arguments.leave_out_outliers,
    })
}

/// The result as text, see the documentation of this module.
fn as_text(answer: &BallbarAnswer) -> String {
    let mut lines = vec![head(answer), String::new()];
    lines.extend(table(
        [["um", "samples", "G", "F max", "at deg", "F min", "at deg"]
            .map(str::to_owned)
            .to_vec()]
        .into_iter()
        .chain(
            answer
                .runs
                .iter()
                .map(|run| shown(&run.name, run.samples.to_string(), &run.shown)),
        )
        .chain(
            answer
                .directions
                .iter()
                .map(|of| shown(&format!("all {}", of.direction), String::new(), &of.shown)),
        ),
    ));
    lines.push(String::new());
    lines.push(format!(
        "both directions    G(b) {} um, D {} um, H {} um",
        um(answer.circular_bidirectional_um),
        um(answer.mean_bidirectional_um),
        um(answer.hysteresis_um)
    ));
    for of in answer.repeatability.iter().chain(&answer.between_directions) {
        lines.push(format!(
            "{:<12} {:.1} um at most, at {:.1} deg; {:.1} um rms",
            format!("{} - {}", of.of[0], of.of[1]),
            of.max_um.abs(),
            of.max_at_deg,
            of.rms_um
        ));
    }
    lines.extend(parts(answer));
    if !answer.lobes.is_empty() {
        let lobe = |lobe: &LobeAnswer| {
            format!(
                "{}: {:.1} um at {:.0} deg",
                lobe.waves, lobe.amplitude_um, lobe.crest_deg
            )
        };
        lines.push(String::new());
        lines.push(format!(
            "lobes        {}",
            answer.lobes.iter().map(lobe).collect::<Vec<_>>().join(", ")
        ));
    }
    lines.extend(outliers(answer));
    lines.extend(results(answer));
    lines.extend(steps(answer));
    lines.join("\n")
}

/// Circle and centre.
fn head(answer: &BallbarAnswer) -> String {
    let plane = answer
        .plane
        .as_ref()
        .map(|plane| format!(" in {plane}"))
        .unwrap_or_default();
    let feed = answer
        .feed_mm_per_min
        .map(|feed| format!(", {feed:.0} mm/min"))
        .unwrap_or_default();
    let centre = match (answer.centring.centre, answer.centring.offset_um) {
        ("setup", Some([x, y])) => {
            format!("as set up; the least-squares centre is ({x:.1}, {y:.1}) um from it")
        }
        (_, Some([x, y])) => format!("least-squares, offset ({x:.1}, {y:.1}) um from the set-up removed"),
        (_, None) => "as set up".to_owned(),
    };
    format!(
        "circle of {:.3} mm{plane}{feed}\ncentre       {centre}",
        answer.radius_mm
    )
}

/// A row of quantities.
fn shown(name: &str, samples: String, of: &ShownAnswer) -> Vec<String> {
    vec![
        name.to_owned(),
        samples,
        um(of.circular_um),
        format!("{:+.1}", of.radial_max_um),
        format!("{:.0}", of.radial_max_at_deg),
        format!("{:+.1}", of.radial_min_um),
        format!("{:.0}", of.radial_min_at_deg),
    ]
}

/// Aligned rows, the first column to the left.
fn table(rows: impl Iterator<Item = Vec<String>>) -> Vec<String> {
    columns(&rows.collect::<Vec<_>>(), &[Align::Left])
}

/// In tenths of a micrometre; a dash for no value.
fn um(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.1}"))
}

/// Contributions to the circular deviation.
fn parts(answer: &BallbarAnswer) -> Vec<String> {
    let Some(parts) = &answer.parts else {
        return Vec::new();
    };
    let mut lines = vec![
        String::new(),
        format!(
            "contributions  {:.2} um rms about the circle, {:.2} um unexplained",
            parts.rms_before_um, parts.rms_after_um
        ),
    ];
    let row = |part: &PartAnswer| {
        vec![
            format!("  {}", part.what),
            format!("{:+.2}", decimals(part.value_um, 2)),
            format!("+- {:.2} um", 2.0 * part.u_um),
        ]
    };
    // Lobes have their own line below.
    let shown = parts.radial.iter().filter(|part| part.kind != "lobes");
    lines.extend(table(shown.map(row)));
    let [a, b] = &answer.axes;
    if let (Some([sa, sb]), Some([ua, ub])) = (parts.scale_um_per_m, parts.scale_u_um_per_m) {
        lines.push(format!(
            "scale        {a} {sa:+.1} +- {:.1} um/m, {b} {sb:+.1} +- {:.1} um/m",
            2.0 * ua,
            2.0 * ub
        ));
    }
    if let (Some(s), Some(u)) = (parts.squareness_urad, parts.squareness_u_urad) {
        lines.push(format!(
            "squareness   {s:+.1} um/m, +- {:.1} um/m: the angle between +{a} and +{b} is {} than 90 deg",
            2.0 * u,
            if s > 0.0 { "larger" } else { "smaller" }
        ));
    }
    if let (Some(late), Some(u)) = (parts.servo_mismatch_s, parts.servo_mismatch_u_s) {
        lines.push(format!(
            "servo        {a} lags {b} by {:+.3} ms, +- {:.3} ms",
            late * 1e3,
            2e3 * u
        ));
    }
    lines.extend(
        parts
            .cyclic_period_mm
            .map(|period| format!("cyclic       period {period:.3} mm")),
    );
    lines
}

/// The first outliers.
fn outliers(answer: &BallbarAnswer) -> Vec<String> {
    let mut lines: Vec<String> = answer
        .outliers
        .iter()
        .take(MOST_OUTLIERS)
        .map(|of| {
            let why = if of.at_reversal { ", a reversal spike" } else { "" };
            format!(
                "outlier      {} at {:.2} deg: {:+.1} um{why}",
                of.run, of.angle_deg, of.off_um
            )
        })
        .collect();
    if let Some(more) = answer
        .outliers
        .len()
        .checked_sub(MOST_OUTLIERS)
        .filter(|more| *more > 0)
    {
        lines.push(format!("             and {more} more"));
    }
    if !lines.is_empty() {
        lines.insert(0, String::new());
    }
    lines
}

/// Results of the software of the ball-bar.
fn results(answer: &BallbarAnswer) -> Vec<String> {
    let mut lines = Vec::new();
    for of in &answer.results {
        lines.push(String::new());
        lines.push(format!("{}: results of the ball-bar software, no radii", of.file));
        let row = |feature: &FeatureAnswer| {
            let ours = feature
                .ours
                .map_or_else(String::new, |ours| format!("armill {ours:.1}"));
            vec![
                format!("  {}", feature.name),
                feature.value.to_string(),
                feature.unit.clone(),
                ours,
            ]
        };
        lines.extend(table(of.features.iter().map(row)));
        if !of.without_number.is_empty() {
            lines.push(format!("  without a value: {}", of.without_number.join(", ")));
        }
    }
    lines
}

/// The corrected circle, and the comparison with the previous test.
fn steps(answer: &BallbarAnswer) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(taught) = &answer.taught {
        lines.push(String::new());
        lines.push(format!(
            "to teach     {} points, moved by up to {:.1} um: circularity {} um, expected {} um; {} um cannot be corrected",
            taught.points,
            taught.largest_correction_um,
            um(taught.circular_before_um),
            um(taught.circular_expected_um),
            um(taught.stays_um)
        ));
    }
    if let Some(before) = &answer.before {
        lines.push(String::new());
        let row = |of: &ComparedQuantity| {
            let left = of
                .left_percent
                .map_or_else(String::new, |left| format!("{left:.0} %"));
            vec![of.what.to_owned(), um(of.before_um), um(of.after_um), left]
        };
        let head = ["um", "before", "after", "left"].map(str::to_owned).to_vec();
        lines.extend(table(
            std::iter::once(head).chain(before.compared.iter().map(row)),
        ));
    }
    lines
}
