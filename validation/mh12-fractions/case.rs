//! Fraction of a tilted plane within 0.05 mm. See README.md.
//!
//! A fraction is one of grid points, all with the same weight; a point without a posture in the branch is
//! not within. Joint limits are not considered.

use crate::check::{Check, ErrorBound};
use crate::studies::answer_to;

/// Four planes, one analysis each.
const STUDY: &str = include_str!("study.toml");
/// Points of a plane.
const POINTS: usize = 21 * 21;

/// Branch and tilt (deg) in the order of `study.toml`, fraction of points within the tolerance.
const FRACTIONS: [(&str, i32, f64); 4] = [
    ("front elbow-up", 90, 0.977),
    ("front elbow-up", -60, 0.832),
    ("front elbow-up", 0, 0.000),
    ("front elbow-down", 30, 0.751),
];

/// Fractions of planes within the tolerance compared with those computed before.
pub fn checks() -> Vec<Check> {
    let answer = answer_to("validation/mh12-fractions/study.toml", STUDY);
    let mut checks: Vec<Check> = FRACTIONS
        .iter()
        .zip(&answer.maps)
        .map(|((branch, tilt, fraction), map)| {
            let mine = map.branch == *branch && map.grid.points == POINTS;
            let found = if mine { map.fraction_within } else { f64::NAN };
            // One point more or less: a point exactly at the tolerance.
            let gap = ErrorBound {
                worst: (found - fraction).abs(),
                tolerance: 0.0023,
                unit: "",
            };
            let what = format!("{branch}, tilt {tilt} deg: {fraction:.3} of {POINTS} points within 0.05 mm");
            Check::printed(what, "independent computation", gap, 5)
        })
        .collect();
    let missing = FRACTIONS.len().abs_diff(answer.maps.len());
    checks.push(Check::none_wrong("planes missing", "the study", missing));
    checks
}
