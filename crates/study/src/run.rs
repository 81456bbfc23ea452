//! Runs a study: every analysis with the core, in the order of the study.
//!
//! Analyses are run one after the other, the points of each on all threads. A result borrows its analysis,
//! so that answers and pictures need nothing else.

use armill_core::watch::Watch;

use crate::analysis::runner::Runner;
use crate::analysis::{Analysis, AnalysisData, AnalysisResult, Subject};
use crate::error::StudyError;
use crate::file::resolve::Study;

/// The number of points of the study that are evaluated: those of a path in a stock count twice, since the stock is cut in a
/// pass of its own.
pub fn points_to_evaluate(study: &Study) -> usize {
    let analyses = study.analyses.iter();
    analyses
        .map(|analysis| analysis.subject.points_to_evaluate())
        .sum()
}

/// What the progress of [`run`] ends at: the points, and the moves that cut the parts of paths.
pub fn point_count(study: &Study) -> usize {
    points_to_evaluate(study) + study.analyses.iter().map(machining_steps).sum::<usize>()
}

/// Steps of the removal of the part of a path.
fn machining_steps(analysis: &Analysis) -> usize {
    match &analysis.subject {
        Subject::Path(path) => path.machining_steps(),
        _ => 0,
    }
}

/// All analyses of the study, done in its order on the threads of the current rayon pool.
///
/// # Errors
/// Cancelled by the watch; a robot without compliance; a path that misses its stock.
///
/// `watch` is notified of every point and may cancel. The same study gives the same values on any number of threads.
pub fn run<'a>(study: &'a Study, watch: Watch<'_>) -> Result<Vec<AnalysisResult<'a>>, StudyError> {
    let mut all = run_without_parts(study, watch)?;
    let runner = Runner::new(&study.robot.robot, watch)?;
    for done in &mut all {
        if let AnalysisData::Path(path, found) = &mut done.found {
            runner.cut_part(path, found)?;
        }
    }
    Ok(all)
}

/// The same without the parts that come out of paths: for views that show the paths alone.
///
/// # Errors
/// As [`run`].
pub fn run_without_parts<'a>(
    study: &'a Study,
    watch: Watch<'_>,
) -> Result<Vec<AnalysisResult<'a>>, StudyError> {
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
