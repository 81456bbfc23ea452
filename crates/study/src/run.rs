//! Runs a study: every analysis with the core, in the order of the study.
//!
//! Analyses are run one after the other, the points of each on all threads. A result borrows its analysis,
//! so that answers and pictures need nothing else.

use armill_core::watch::Watch;

use crate::analysis::runner::Runner;
use crate::analysis::{Analysis, AnalysisResult};
use crate::error::StudyError;
use crate::file::resolve::Study;

/// The number of points of the study.
///
/// The points that the progress of `run` ends at: those of a path in a stock count twice, since the stock is cut in a
/// pass of its own.
pub fn point_count(study: &Study) -> usize {
    study
        .analyses
        .iter()
        .map(|analysis| analysis.subject.points_to_evaluate())
        .sum()
}

/// All analyses of the study, done in its order on the threads of the current rayon pool.
///
/// # Errors
/// Cancelled by the watch; a robot without compliance; a path that misses its stock.
///
/// `watch` is notified of every point and may cancel. The same study gives the same values on any number of threads.
pub fn run<'a>(study: &'a Study, watch: Watch<'_>) -> Result<Vec<AnalysisResult<'a>>, StudyError> {
    let runner = Runner::new(&study.robot.robot, watch)?;
    let done = |analysis: &'a Analysis| {
        let found = analysis.subject.run(&runner)?;
        Ok(AnalysisResult {
            name: &analysis.name,
            vibration: found.vibration(&study.robot.robot),
            found,
        })
    };
    study.analyses.iter().map(done).collect()
}
