//! Radii in a Renishaw `.b5r` file.
//!
//! | element | text | meaning |
//! |---|---|---|
//! | `RUN_DIRECTION` | `CW` or `CCW` | direction of the run whose readings follow |
//! | `READINGS` | numbers, separated by blanks | radii of the run, mm |
//!
//! The file gives neither the nominal radius nor the angles: both are options, and samples are taken as evenly spaced over one turn.
//! No file with readings was available; names and shape are those that users report \[recalled\].

use armill_core::measure::ballbar::{Direction, Run};
use armill_core::units::from_mm;
use roxmltree::Node;

use super::b5r::Results;
use super::csv::evenly;
use super::runs::{BallbarReadOptions, BallbarRuns, direction_of};
use crate::document::{Problem, Problems, Source};
use crate::xml::{parse, tag};

/// A reading further from the nominal radius than this, m, is not a radius of this circle.
const FARTHEST: f64 = 5e-3;

/// The runs in `text`; none without readings. `path` is the file name shown in problems, `results` are those of the same file.
///
/// # Errors
/// Text that is not XML; readings without a direction, radius or start angle; texts that are not numbers; radii of another circle.
pub(super) fn read(
    path: &str,
    text: &str,
    options: &BallbarReadOptions,
    results: &Results,
) -> Result<Option<BallbarRuns>, Problems> {
    let source = Source::new(path, text);
    let document = parse(&source)?;
    let mut problems = Vec::new();
    let mut direction = None;
    let mut recorded = BallbarRuns {
        radius: options.radius,
        feed: None,
        plane: results.plane.clone(),
        runs: Vec::new(),
        names: Vec::new(),
        unused: Vec::new(),
        notes: vec![
            "the angles of the readings are assumed: evenly spaced over one turn from the start angle"
                .to_owned(),
        ],
    };
    let mut has_readings = false;
    for node in document.descendants().filter(Node::is_element) {
        let text = node.text().map(str::trim).unwrap_or_default();
        match node.tag_name().name() {
            "RUN_DIRECTION" => direction = direction_of(text),
            "READINGS" if !text.is_empty() => {
                has_readings = true;
                match run(&source, node, options, options.direction.or(direction)) {
                    Ok(run) => {
                        recorded.runs.push(run);
                        recorded.names.push(String::new());
                    }
                    Err(problem) => problems.push(*problem),
                }
            }
            _ => {}
        }
    }
    Problems::from(problems).into_result()?;
    Ok(has_readings.then_some(recorded))
}

fn run(
    source: &Source,
    node: Node<'_, '_>,
    options: &BallbarReadOptions,
    direction: Option<Direction>,
) -> Result<Run, Box<Problem>> {
    let problem =
        |message: String, hint: &str| Box::new(source.problem(tag(node), message, Some(hint.to_owned())));
    let missing =
        |what: &str, option: &str| problem(format!("{what} of these readings is not given"), option);
    let direction = direction.ok_or_else(|| missing("the direction", "--direction CW or CCW"))?;
    let nominal = options
        .radius
        .ok_or_else(|| missing("the nominal radius", "--radius-mm 100"))?;
    let start = options
        .start
        .ok_or_else(|| missing("the angle of the first one", "--start-deg 0"))?;
    let mut deviations = Vec::new();
    for word in node.text().unwrap_or_default().split_whitespace() {
        let number = word.parse().or_else(|_| word.replace(',', ".").parse::<f64>());
        let Some(radius) = number.ok().filter(|number| number.is_finite()).map(from_mm) else {
            return Err(problem(
                format!("`{word}` is not a number"),
                "radii in mm, separated by blanks",
            ));
        };
        if (radius - nominal).abs() > FARTHEST {
            return Err(problem(
                format!("the reading {word} is not within 5 mm of the nominal radius"),
                "readings are radii in mm; --radius-mm is the nominal one",
            ));
        }
        deviations.push(radius - nominal);
    }
    let angles = evenly(deviations.len(), start, direction);
    Run::new(direction, angles, deviations)
        .map_err(|error| problem(error.to_string(), "check whether the file is cut off"))
}
