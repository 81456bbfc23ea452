//! Table and picture of a profile.
//!
//! ```text
//! roundness.csv     angle_deg, radius_mm, deviation_um, deviation_measured_um; round the circle, one row a point
//! roundness.svg     the profile, magnified, with its four circles and their centres; roundness.png is the same
//! ```

use std::path::PathBuf;

use armill_core::nalgebra::Point2;
use armill_core::roundness::Polar;
use armill_core::units::{to_deg, to_mm, to_um, um_from_mm};
use armill_formats::file::ResultFolder;
use armill_formats::table::{Table, csv};
use armill_report::{Growth, PolarPlot, RadialReference, RadialSeries};
use armill_study::StudyError;
use armill_study::output::{Picture, column, picture_files, write_pictures};

use super::{RoundnessAnswer, RoundnessEvaluation};

/// Greatest number of points of a line in the picture: of more, the extremes of each step are drawn.
const MOST_DRAWN: usize = 3600;
/// A gap wider than this is not part of the profile: no line is drawn across it.
const OPEN_DEG: f64 = 20.0;
/// Steps of a circle on the picture.
const CIRCLE_STEPS: usize = 360;

/// Writes table and picture into the folder `out` and returns their paths.
///
/// # Errors
/// The folder or a file cannot be written.
pub fn write(
    answer: &RoundnessAnswer,
    evaluation: &RoundnessEvaluation,
    out: &ResultFolder,
) -> Result<Vec<PathBuf>, StudyError> {
    let svg = plot(answer, evaluation).to_svg();
    let files = vec![("roundness.csv", csv::write(&table(evaluation)?))];
    let pictures = [Picture {
        name: "roundness".to_owned(),
        caption: String::new(),
        svg,
    }];
    let drawn: Vec<String> = pictures.iter().flat_map(picture_files).collect();
    out.allow(
        files
            .iter()
            .map(|(name, _)| *name)
            .chain(drawn.iter().map(String::as_str)),
    )?;
    let mut written = Vec::new();
    for (name, bytes) in files {
        out.write(name, &bytes)?;
        written.push(out.path().join(name));
    }
    write_pictures(&pictures, out)?;
    written.extend(drawn.iter().map(|name| out.path().join(name)));
    out.finish()?;
    Ok(written)
}

/// The picture of a profile.
pub fn plot(answer: &RoundnessAnswer, evaluation: &RoundnessEvaluation) -> PolarPlot {
    let polar = &evaluation.polar;
    let given = |name: &str, ront_mm: f64| format!("{name}, RONt {:.2} µm", um_from_mm(ront_mm));
    let filter = match answer.filter_upr {
        Some(upr) => format!("Gaussian filter {upr} UPR"),
        None => "not filtered".to_owned(),
    };
    let drawn: Vec<usize> = drawn(polar);
    let mut series = RadialSeries {
        name: "profile".to_owned(),
        angle_deg: drawn.iter().map(|i| to_deg(polar.angles[*i])).collect(),
        radial_um: drawn.iter().map(|i| to_um(polar.deviations[*i])).collect(),
    };
    if !is_open(polar) {
        // The first point again closes the line.
        series.angle_deg.extend(series.angle_deg.first().copied());
        series.radial_um.extend(series.radial_um.first().copied());
    }
    let mut references = Vec::new();
    if let (Ok(zone), Some(answer)) = (&evaluation.zone, &answer.mzci) {
        references.push(reference(
            &given("MZCI", answer.ront_mm),
            polar,
            zone.centre,
            &[zone.inner, zone.outer],
        ));
    }
    // For an arc the smallest circle is another one, which would dominate the picture.
    if !is_open(polar) {
        let outer = &evaluation.circumscribed;
        let name = given("MCCI", answer.mcci.ront_mm);
        references.push(reference(&name, polar, outer.centre, &[outer.radius]));
    }
    if let (Ok(inner), Some(answer)) = (&evaluation.inscribed, &answer.mici) {
        references.push(reference(
            &given("MICI", answer.ront_mm),
            polar,
            inner.centre,
            &[inner.radius],
        ));
    }
    PolarPlot {
        title: format!("Roundness of {}", answer.file),
        subtitle: format!(
            "{}, {} points, {filter}; crosses: centres",
            given("LSCI", answer.lsci.ront_mm),
            answer.points
        ),
        horizontal: "x".to_owned(),
        vertical: "y".to_owned(),
        growth: Growth::Right,
        zero: format!("LSCI, radius {:.4} mm", answer.lsci.radius_mm),
        series: vec![series],
        references,
    }
}

/// Whether the points leave so much open that no line is drawn there.
fn is_open(polar: &Polar) -> bool {
    to_deg(polar.gap.width) > OPEN_DEG
}

/// Circles about `centre` with these radii (m), as seen from the centre of `polar`, where it has points.
fn reference(name: &str, polar: &Polar, centre: Point2<f64>, radii: &[f64]) -> RadialReference {
    let shift = centre - polar.centre;
    let gap = &polar.gap;
    let (begin, sweep) = match is_open(polar) {
        true => (gap.from + gap.width, std::f64::consts::TAU - gap.width),
        false => (0.0, std::f64::consts::TAU),
    };
    let mut seen = RadialSeries {
        name: name.to_owned(),
        ..RadialSeries::default()
    };
    for radius in radii {
        for step in 0..=CIRCLE_STEPS {
            let angle = begin + sweep * step as f64 / CIRCLE_STEPS as f64;
            let (sin, cos) = angle.sin_cos();
            let (along, across) = (shift.x * cos + shift.y * sin, shift.y * cos - shift.x * sin);
            // From the centre of the plot the circle is met at `along` and the remaining part of the radius.
            let distance = along + (radius * radius - across * across).max(0.0).sqrt();
            seen.angle_deg.push(to_deg(angle));
            seen.radial_um.push(to_um(distance - polar.radius));
        }
        // Ends the line of this circle.
        seen.angle_deg.push(0.0);
        seen.radial_um.push(f64::NAN);
    }
    RadialReference {
        seen,
        centre_um: [to_um(shift.x), to_um(shift.y)],
    }
}

/// The points that are drawn, in order from after the gap: all, or the lowest and highest of each step.
fn drawn(polar: &Polar) -> Vec<usize> {
    let count = polar.order.len();
    // An arc begins after the widest gap; a full circle may begin there too.
    let first = polar
        .order
        .iter()
        .position(|i| polar.angles[*i] > polar.gap.from)
        .unwrap_or(0);
    let round: Vec<usize> = (0..count).map(|k| polar.order[(first + k) % count]).collect();
    if count <= MOST_DRAWN {
        return round;
    }
    let extremes = |step: &[usize]| {
        let by = |a: &usize, b: &usize| polar.deviations[step[*a]].total_cmp(&polar.deviations[step[*b]]);
        let [low, high] =
            [(0..step.len()).min_by(by), (0..step.len()).max_by(by)].map(Option::unwrap_or_default);
        [step[low.min(high)], step[low.max(high)]]
    };
    round
        .chunks(count.div_ceil(MOST_DRAWN / 2))
        .flat_map(extremes)
        .collect()
}

/// A row a point, round the circle.
fn table(evaluation: &RoundnessEvaluation) -> Result<Table, StudyError> {
    let polar = &evaluation.polar;
    let all = |of: &dyn Fn(usize) -> f64| polar.order.iter().map(|i| of(*i)).collect::<Vec<f64>>();
    let mut columns = vec![
        column(
            "angle_deg",
            "deg",
            "about the centre of the least-squares circle",
            7,
            all(&|i| to_deg(polar.angles[i])),
        ),
        column(
            "radius_mm",
            "mm",
            "distance from that centre",
            9,
            all(&|i| to_mm(polar.radius + polar.deviations[i])),
        ),
        column(
            "deviation_um",
            "um",
            "outward from the least-squares circle",
            6,
            all(&|i| to_um(polar.deviations[i])),
        ),
    ];
    if let Some(measured) = &evaluation.measured {
        let values = all(&|i| to_um(measured.deviations[i]));
        columns.push(column(
            "deviation_measured_um",
            "um",
            "the same before the filter",
            6,
            values,
        ));
    }
    Ok(Table::new("roundness", columns)?)
}
