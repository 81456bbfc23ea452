//! The chapter on the clearance: the least of each analysis in words, and what is checked.

use armill_core::robot::Robot;
use armill_report::html::Report;

use crate::answer::StudyAnswer;

/// What is checked, and what is not.
const CHECKED: [&str; 2] = [
    "Checked at every point: links, tool and what rides with the arm against obstacles, floor and pedestal, spindle and links against the part, and the arm \
     against itself. Distances are those of the bodies as given; capsules are larger than the links that they enclose.",
    "Not checked: links next to each other and bodies in contact in every posture, which touch by design; the cutter against the part; base and first link \
     against floor and pedestal.",
];
/// The same where the robot holds the part.
const CHECKED_IN_HAND: [&str; 2] = [
    "Checked at every point: the part and links against the tool that stands in the cell, obstacles, floor and pedestal, links against the part, and the arm \
     against itself. Distances are those of the bodies as given; capsules are larger than the links that they enclose.",
    "Not checked: links next to each other and bodies in contact in every posture, which touch by design; the cutter against the part, and the last link, \
     which holds it; base and first link against floor and pedestal.",
];
/// What no cell contains.
const NOT_IN_CELL: &str = "Not part of the cell: cables and hoses, what the study does not contain, and the part as it becomes while it is cut, unless the path has a stock: this is \
     checked at the points of the path. Moves between the points are checked where a program is written, without the stock.";
/// The same where the robot holds the part.
const NOT_IN_CELL_IN_HAND: &str = "Not part of the cell: cables and hoses, what the study does not contain, and the part as it becomes while it is cut. Moves between the points are \
     checked where a program is written.";

/// The clearance of an analysis.
struct Given<'a> {
    name: &'a str,
    least_mm: Option<f64>,
    nearest: Option<&'a [String; 2]>,
    in_collision: usize,
}

impl Given<'_> {
    /// `map: the least clearance is 3.2 mm, between spindle and fence; 4 points have no posture that keeps the demanded clearance`.
    fn sentence(&self) -> Option<String> {
        let [first, second] = self.nearest?;
        let least = match self.least_mm? {
            mm if mm > 0.0 => format!("the least clearance is {mm:.1} mm, between {first} and {second}"),
            _ => format!("{first} and {second} touch"),
        };
        let lost = match self.in_collision {
            0 => "every point keeps the demanded clearance".to_owned(),
            1 => "1 point has no posture that keeps the demanded clearance".to_owned(),
            count => format!("{count} points have no posture that keeps the demanded clearance"),
        };
        Some(format!("{}: {least}; {lost}.", self.name))
    }
}

/// Adds the chapter, if an analysis has a clearance.
pub(super) fn add_section(report: Report, robot: &Robot, answer: &StudyAnswer) -> Report {
    let maps = answer.maps.iter().map(|map| Given {
        name: &map.name,
        least_mm: map.least_clearance_mm,
        nearest: map.nearest.as_ref(),
        in_collision: map.counts.in_collision,
    });
    let paths = answer.paths.iter().map(|path| Given {
        name: &path.name,
        least_mm: path.least_clearance_mm,
        nearest: path.nearest.as_ref(),
        in_collision: path.in_collision,
    });
    let holes = answer.holes.iter().map(|holes| Given {
        name: &holes.name,
        least_mm: holes.least_clearance_mm,
        nearest: holes.nearest.as_ref(),
        in_collision: holes.counts.in_collision,
    });
    let volumes = answer.volumes.iter().map(|volume| Given {
        name: &volume.name,
        least_mm: volume.least_clearance_mm,
        nearest: volume.nearest.as_ref(),
        in_collision: volume.counts.in_collision,
    });
    let all = maps.chain(paths).chain(holes).chain(volumes);
    let mut sentences: Vec<String> = all.filter_map(|given| given.sentence()).collect();
    if sentences.is_empty() {
        return report;
    }
    let (checked, not_in_cell) = match robot.chain().ground().part_is_in_hand() {
        true => (CHECKED_IN_HAND, NOT_IN_CELL_IN_HAND),
        false => (CHECKED, NOT_IN_CELL),
    };
    sentences.extend(checked.into_iter().chain([not_in_cell]).map(str::to_owned));
    report.section("Clearance").list(&sentences)
}
