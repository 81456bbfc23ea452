//! What the remarks of a table of radii tell: `# radius_mm: 100`.
//!
//! | key | meaning |
//! |---|---|
//! | `radius_mm` | nominal radius, one for the whole file |
//! | `feed_mm_per_min` | speed along the circle, likewise |
//! | `plane` | `XY`, `YZ`, `ZX`, or any word; likewise |
//! | `direction` | `CW` or `CCW`, of the rows below |
//! | `run` | what the rows below are called |
//! | `start_deg` | where a run without angles begins, of the rows below |
//!
//! Other remarks are for people.

use super::{BallbarReadOptions, direction_of};
use armill_core::measure::ballbar::Direction;

use crate::document::Problems;
use crate::document::lines::Line;
use crate::table::sheet::number;

/// What the remarks so far tell, and what was told beside the file.
#[derive(Clone, Debug)]
pub(super) struct Remarks {
    /// Nominal radius, m.
    pub radius: Option<f64>,
    /// m/s
    pub feed: Option<f64>,
    /// As it is called.
    pub plane: Option<String>,
    /// Of the rows below.
    pub direction: Option<Direction>,
    /// Of the rows below.
    pub run: Option<String>,
    /// Of the rows below, rad.
    pub start: Option<f64>,
    /// As it was told beside the file, rad.
    start_beside: Option<f64>,
    /// How often a run, a direction or a start was told: rows on either side are not of one run.
    pub parts: usize,
}

impl Remarks {
    /// What is told beside the file.
    pub fn beside(given: &BallbarReadOptions) -> Remarks {
        Remarks {
            radius: given.radius,
            feed: None,
            plane: None,
            direction: given.direction,
            run: None,
            start: given.start,
            start_beside: given.start,
            parts: 0,
        }
    }

    /// Takes a remark of the file `path`; one for people changes nothing.
    ///
    /// # Errors
    /// A value that its key cannot have, or another one than was told before.
    pub fn take(&mut self, path: &str, line: &Line) -> Result<(), Problems> {
        let plain = line.text.trim_start().trim_start_matches('#');
        let Some((key, value)) = plain.split_once([':', '=']) else {
            return Ok(());
        };
        // Spreadsheets fill a line up with separators.
        let value = value.trim().trim_end_matches([';', ',']).trim();
        let refused = |message: String, hint: &str| -> Problems {
            line.problem(path, 0..line.text.len(), message, hint).into()
        };
        let quantity = |[least, most]: [f64; 2], unit: &str, example: &str| {
            // A single number needs no separator: a comma is a decimal one.
            let value = number(value, ';').filter(|value| *value > least && *value <= most);
            value.ok_or_else(|| {
                let message = format!(
                    "`{}` is not a number above {least} and up to {most} {unit}",
                    line.text.trim()
                );
                refused(message, &format!("such as `# {example}`"))
            })
        };
        let twice = |what: &str| {
            let message = format!("another {what} was told before");
            refused(message, "one file is one circle: split it, or drop the option")
        };
        match key.trim().to_lowercase().as_str() {
            "radius_mm" | "nominal_radius_mm" => {
                let radius = quantity([0.0, 1e4], "mm", "radius_mm: 100")? * 1e-3;
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
                let start = quantity([-1e4, 1e4], "deg", "start_deg: 0")?.to_radians();
                self.parts += 1;
                self.start = Some(start);
                match self.start_beside {
                    Some(beside) if (beside - start).abs() > 1e-9 => Err(twice("start")),
                    _ => Ok(()),
                }
            }
            "direction" => {
                self.parts += 1;
                self.direction = direction_of(value);
                match self.direction {
                    Some(_) => Ok(()),
                    None => Err(refused(format!("`{value}` is no direction"), "CW or CCW")),
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
