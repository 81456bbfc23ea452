//! The groove of the paper under every interpretation. See README.md.
//!
//! An interpretation fixes what the paper does not state: tool length, plate angle, branch, and the reference
//! frame of heights. Each is an analysis of `study.toml`; the numbers here are those of another program
//! for it.

use armill_study::answer::PathAnswer;

use crate::check::{Check, ErrorBound, worst, worst_difference};
use crate::studies::{answer_to, path};

const REFERENCE: &str = "independent computation";
const STUDY: &str = include_str!("study.toml");
/// Index of joint U.
const U: usize = 2;

/// Result of one interpretation; none if the reference does not give it.
struct Reading {
    /// Name of its analysis in `study.toml`.
    name: &'static str,
    /// Smallest and largest in-plane envelope of the four cases along the circle, um.
    in_plane: (Option<f64>, f64),
    /// Largest length of the deviation, um.
    full: Option<f64>,
    /// Range of joint U, deg.
    u_range: Option<[f64; 2]>,
    /// Whether every joint stays inside its limits.
    inside: Option<bool>,
}

/// All numbers as printed, one decimal; what is left out was not stated.
const READINGS: [Reading; 11] = [
    Reading {
        name: "(i) horizontal plate, 250 mm, elbow up",
        in_plane: (Some(49.7), 58.7),
        full: Some(132.2),
        u_range: Some([-11.2, 13.8]),
        inside: Some(true),
    },
    Reading {
        name: "(i) horizontal plate, 250 mm, elbow down",
        in_plane: (Some(48.0), 58.6),
        full: None,
        u_range: Some([131.5, 156.5]),
        inside: Some(false),
    },
    Reading {
        name: "horizontal plate, 100 mm, elbow up",
        in_plane: (None, 42.7),
        full: Some(121.0),
        u_range: None,
        inside: None,
    },
    Reading {
        name: "horizontal plate, 350 mm, elbow up",
        in_plane: (None, 77.6),
        full: Some(139.6),
        u_range: None,
        inside: None,
    },
    Reading {
        name: "(ii) vertical plate, 100 mm, elbow down",
        in_plane: (Some(51.0), 68.8),
        full: Some(120.4),
        u_range: Some([167.5, 177.4]),
        inside: Some(false),
    },
    Reading {
        name: "(ii) vertical plate, 100 mm, elbow up",
        in_plane: (Some(130.4), 139.7),
        full: Some(146.5),
        u_range: Some([-32.1, -22.2]),
        inside: Some(true),
    },
    Reading {
        name: "vertical plate, 250 mm, elbow up",
        in_plane: (None, 207.2),
        full: Some(214.5),
        u_range: None,
        inside: None,
    },
    Reading {
        name: "vertical plate, 350 mm, elbow up",
        in_plane: (None, 263.9),
        full: Some(271.7),
        u_range: None,
        inside: None,
    },
    Reading {
        name: "(iii) controller frame, 100 mm, elbow down",
        in_plane: (Some(47.3), 61.1),
        full: Some(123.3),
        u_range: Some([121.8, 147.3]),
        inside: Some(true),
    },
    Reading {
        name: "(iii) controller frame, 120 mm, elbow down",
        in_plane: (Some(48.9), 62.8),
        full: None,
        u_range: None,
        inside: Some(true),
    },
    Reading {
        name: "(iii) controller frame, 100 mm, elbow up",
        in_plane: (Some(140.8), 147.4),
        full: None,
        u_range: None,
        inside: None,
    },
];

/// Largest deviations of each reading of the statement against those computed before.
pub fn checks() -> Vec<Check> {
    let answer = answer_to("validation/mh12-readings/study.toml", STUDY);
    let of = |reading: &Reading| path(&answer, reading.name).clone();
    let mut checks: Vec<Check> = READINGS
        .iter()
        .map(|reading| deviations(reading, &of(reading)))
        .collect();
    let u_ranges = READINGS
        .iter()
        .filter_map(|r| Some(worst_difference(&of(r).joint_range_deg[U], &r.u_range?)));
    checks.push(Check::printed(
        "range of joint U, every interpretation that gives it",
        REFERENCE,
        ErrorBound {
            worst: worst(u_ranges),
            tolerance: 0.05,
            unit: "deg",
        },
        3,
    ));
    // An interpretation without a statement on limits is not checked.
    let wrong = READINGS
        .iter()
        .filter(|r| r.inside.is_some_and(|inside| inside != is_inside(&of(r))))
        .count();
    checks.push(Check::none_wrong(
        "interpretations wrongly inside or outside the joint limits",
        REFERENCE,
        wrong,
    ));
    let uneven = READINGS
        .iter()
        .filter(|r| of(r).points != 72 || of(r).unreachable > 0)
        .count();
    checks.push(Check::none_wrong(
        "interpretations without 72 reached points",
        "360 / 5",
        uneven,
    ));
    checks
}

/// The largest of the differences for one interpretation, um.
fn deviations(reading: &Reading, path: &PathAnswer) -> Check {
    let away = |found: Option<f64>, printed: f64| found.unwrap_or(f64::NAN) - printed;
    let (least, greatest) = reading.in_plane;
    let gaps = [
        least.map(|printed| away(path.min_in_plane_um, printed)),
        Some(away(path.max_in_plane_um, greatest)),
        reading.full.map(|printed| away(path.max_full_um, printed)),
    ];
    // Half of the last printed digit.
    let gap = ErrorBound {
        worst: worst(gaps.into_iter().flatten()),
        tolerance: 0.05,
        unit: "um",
    };
    let given = match (least, reading.full) {
        (Some(least), Some(full)) => format!("in-plane {least:.1} to {greatest:.1}, full {full:.1} um"),
        (Some(least), None) => format!("in-plane {least:.1} to {greatest:.1} um"),
        (None, Some(full)) => format!("in-plane at most {greatest:.1}, full {full:.1} um"),
        (None, None) => format!("in-plane at most {greatest:.1} um"),
    };
    Check::printed(format!("{}: {given}", reading.name), REFERENCE, gap, 3)
}

/// Whether every point of the path keeps inside the joint limits.
fn is_inside(path: &PathAnswer) -> bool {
    path.outside_joint_limits == 0
}
