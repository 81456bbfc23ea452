//! Whether the answers of all analyses fit into memory together.

use armill_formats::robot::RobotDescription;

use crate::analysis::Analysis;
use crate::input::memory::{GIB, MOST_BYTES};
use crate::input::problem_log::ProblemLog;

/// A problem if all analyses do not fit into memory together: their answers are in memory at the same time.
pub(super) fn check_analyses(log: &mut ProblemLog<'_>, robot: &RobotDescription, analyses: &[Analysis]) {
    let bytes: f64 = analyses
        .iter()
        .map(|analysis| analysis.subject.bytes(robot))
        .sum();
    if bytes > MOST_BYTES {
        let (gib, most) = (bytes / GIB, MOST_BYTES / GIB);
        let message =
            format!("all analyses together would take {gib:.1} GiB of memory, more than {most:.0} GiB");
        log.problem(
            "analysis",
            message,
            "use larger steps, smaller planes, or several studies",
        );
    }
}
