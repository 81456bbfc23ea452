//! The result of `armill ballbar` as text.
//!
//! ```text
//! circle of 100 mm in XY, 1000 mm/min; least-squares centre, (12.1, -3.4) um from the set-up
//! runs   G   F max   F min           each run, then each direction
//! G(b), D, H                         ISO 230-4
//! differences                        between runs of the same direction, and between directions
//! parts                              contributions to the circular deviation, with standard uncertainty
//! lobes                              common to both directions
//! ```

use armill_measure::ballbar::BallbarAnswer;
use armill_measure::ballbar::answer::{LobeAnswer, PartAnswer, ShownAnswer};
use armill_measure::ballbar::results::FeatureAnswer;
use armill_measure::ballbar::teach::ComparedQuantity;
use armill_study::number::decimals;

use crate::terminal::{Align, columns};

/// Number of outliers listed.
const MOST_OUTLIERS: usize = 10;

/// The whole text.
pub(super) fn as_text(answer: &BallbarAnswer) -> String {
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
            // unit: ms
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
