//! Comment lines of a table of radii: `# radius_mm: 100`.
//!
//! | key | meaning |
//! |---|---|
//! | `radius_mm` | nominal radius, one per file |
//! | `feed_mm_per_min` | speed along the circle, one per file |
//! | `plane` | `XY`, `YZ`, `ZX`, or any word; one per file |
//! | `direction` | `CW` or `CCW`, of the rows below |
//! | `run` | name of the run in the rows below |
//! | `start_deg` | start angle of a run without angles, for the rows below |
//!
//! Other comment lines are ignored.

use super::runs::{BallbarReadOptions, direction_of};
use armill_core::measure::ballbar::Direction;
use armill_core::units::{from_deg, from_mm};

use crate::document::Problems;
use crate::document::lines::Line;
use crate::table::sheet::number;

/// Values from the comment lines so far, and from the options.
#[derive(Clone, Debug)]
pub(super) struct Remarks {
    /// Nominal radius, m.
    pub radius: Option<f64>,
    /// m/s
    pub feed: Option<f64>,
    /// Name of the plane.
    pub plane: Option<String>,
    /// Of the rows below.
    pub direction: Option<Direction>,
    /// Of the rows below.
    pub run: Option<String>,
    /// Of the rows below, rad.
    pub start: Option<f64>,
    /// Start angle from the options, rad.
    option_start: Option<f64>,
    /// Number of comment lines so far that gave a run, direction or start. Rows on different sides of such a line
    /// belong to different runs.
    pub parts: usize,
}

impl Remarks {
    /// Starts with the values from the options.
    pub fn with_options(options: &BallbarReadOptions) -> Remarks {
        Remarks {
            radius: options.radius,
            feed: None,
            plane: None,
            direction: options.direction,
            run: None,
            start: options.start,
            option_start: options.start,
            parts: 0,
        }
    }

    /// Reads one comment line of the file `path`; other comments change nothing.
    ///
    /// # Errors
    /// A value that is not valid for its key, or that differs from the one given before.
    pub fn take(&mut self, path: &str, line: &Line) -> Result<(), Problems> {
        let plain = line.text.trim_start().trim_start_matches('#');
        let Some((key, value)) = plain.split_once([':', '=']) else {
            return Ok(());
        };
        // Spreadsheets pad a line with separators.
        let value = value.trim().trim_end_matches([';', ',']).trim();
        let refused = |message: String, hint: &str| -> Problems {
            line.problem(path, 0..line.text.len(), message, hint).into()
        };
        let quantity = |[least, most]: [f64; 2], unit: &str, example: &str| {
            // A single number needs no separator: a comma is the decimal mark.
            let value = number(value, ';').filter(|value| *value > least && *value <= most);
            value.ok_or_else(|| {
                let message = format!(
                    "`{}` is not a number above {least} and up to {most} {unit}",
                    line.text.trim()
                );
                refused(message, &format!("write it as `# {example}`"))
            })
        };
        let twice = |what: &str| {
            let message = format!("another {what} was given before");
            refused(
                message,
                "one file is one circle: split the file, or leave out the option",
            )
        };
        match key.trim().to_lowercase().as_str() {
            "radius_mm" | "nominal_radius_mm" => {
                let radius = from_mm(quantity([0.0, 1e4], "mm", "radius_mm: 100")?);
                match self.radius.replace(radius) {
                    Some(before) if (before - radius).abs() > 1e-9 * radius => Err(twice("nominal radius")),
                    _ => Ok(()),
                }
            }
            "feed_mm_per_min" => {
                let feed = quantity([0.0, 1e7], "mm/min", "feed_mm_per_min: 1000")? / 60e3;
                match self.feed.replace(feed) {
                    Some(before) if before != feed => Err(twice("feed")),
                    _ => Ok(()),
                }
            }
            "plane" => match self.plane.replace(value.to_owned()) {
                Some(before) if before != value => Err(twice("plane")),
                _ => Ok(()),
            },
            "start_deg" => {
                let start = from_deg(quantity([-1e4, 1e4], "deg", "start_deg: 0")?);
                self.parts += 1;
                self.start = Some(start);
                match self.option_start {
                    Some(given) if (given - start).abs() > 1e-9 => Err(twice("start")),
                    _ => Ok(()),
                }
            }
            "direction" => {
                self.parts += 1;
                self.direction = direction_of(value);
                match self.direction {
                    Some(_) => Ok(()),
                    None => Err(refused(format!("`{value}` is not a direction"), "use CW or CCW")),
                }
            }
            "run" => {
                self.parts += 1;
                self.run = Some(value.to_owned());
                Ok(())
            }
            _ => Ok(()),
        }
    }
}
