//! `spin_curve_mm_deg`: a spin of the tool that changes along the path, in addition to the constant one.
//!
//! Its points give distance along the path and spin. A path has either this curve or a search for the best spins.

use armill_core::path::{NoSpinCurve, SpinCurve, SpinKnot};
use armill_core::units::{from_deg, from_mm, to_mm};

use crate::analysis::path::PathAnalysis;
use crate::input::problem_log::ProblemLog;

/// The key.
const KEY: &str = "spin_curve_mm_deg";
/// Largest spin of a point, deg: two turns, as of a search.
const MOST_DEG: f64 = 720.0;
/// Rounding of a length that was written in mm, mm.
const ROUNDING_MM: f64 = 1e-3;

/// The curve through these points of the path of `analysis`; `None` if it has problems, reported at their keys.
pub fn resolve(
    log: &mut ProblemLog<'_>,
    points_mm_deg: &[[f64; 2]],
    analysis: &PathAnalysis,
) -> Option<SpinCurve> {
    let length_mm = to_mm(analysis.length());
    let before = log.problems.len();
    for (index, [along_mm, spin_deg]) in points_mm_deg.iter().enumerate() {
        let key = format!("{KEY}[{index}]");
        if !(-ROUNDING_MM..=length_mm + ROUNDING_MM).contains(along_mm) {
            let message = format!("`{key}` is at {along_mm} mm: the path ranges from 0 to {length_mm:.1} mm");
            log.problem(&key, message, "distances are along the path from its start");
        }
        if spin_deg.abs() > MOST_DEG {
            let message = format!("`{key}` has a spin of {spin_deg} deg: must be within {MOST_DEG} deg of 0");
            log.problem(&key, message, "a full turn is 360 deg");
        }
    }
    let knot = |[along_mm, spin_deg]: &[f64; 2]| SpinKnot {
        along: from_mm(*along_mm),
        spin: from_deg(*spin_deg),
    };
    let curve = SpinCurve::new(points_mm_deg.iter().map(knot).collect());
    let report = |error: NoSpinCurve| match error {
        NoSpinCurve::TooFew { count } => {
            let message = format!("`{KEY}` must have at least 2 points (got {count})");
            log.problem(
                KEY,
                message,
                "give a constant spin by `spin_deg`, of a program by `program.spin_deg`",
            );
        }
        NoSpinCurve::NotAscending { index } => {
            let [[before_mm, _], [here_mm, _]] = [points_mm_deg[index - 1], points_mm_deg[index]];
            let key = format!("{KEY}[{index}]");
            let message = format!(
                "`{key}` is at {here_mm} mm: must be greater than {before_mm} mm, where the point before is"
            );
            log.problem(&key, message, "list the points in the order of the path");
        }
    };
    let curve = curve.map_err(report).ok()?;
    (log.problems.len() == before).then_some(curve)
}

/// Reports a curve together with a search, which would choose the spins itself.
pub fn refuse_with_search(log: &mut ProblemLog<'_>) {
    let message = format!("`{KEY}` and `posture.search` both specify the spin along the path");
    log.problem(KEY, message, "remove one of them");
}
