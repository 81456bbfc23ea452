//! The robot file with identified compliances, for predictions.
//!
//! It contains springs with their uncertainties, the covariance of those of revolute joints, the error of left-out
//! tests as the error of the model, and a source that names the tests. Lost motion is left out.

use armill_core::identify::Role;
use armill_core::robot::Robot;
use armill_formats::robot::armill::{Identified, IdentifiedSpring, with_springs};
use armill_study::StudyError;

use super::answer::Answer;
use super::question::{attachment_name, spring_kind};

/// The robot file `text` (at `path`) with the springs of `answer`, identified from the tests in `tests_path`.
///
/// # Errors
/// A robot file that is not TOML, or that no longer reads with these compliances in it.
pub fn robot_file(
    robot: &Robot,
    [path, text]: [&str; 2],
    answer: &Answer,
    tests_path: &str,
) -> Result<String, StudyError> {
    let kept: Vec<usize> = (0..answer.unknowns.len())
        .filter(|k| !matches!(answer.unknowns[*k].role, Role::LostMotion { .. }))
        .collect();
    let springs: Vec<IdentifiedSpring> = kept
        .iter()
        .map(|k| {
            let (unknown, estimate) = (&answer.unknowns[*k], answer.identified.estimates[*k]);
            IdentifiedSpring {
                at: attachment_name(robot, unknown),
                kind: spring_kind(unknown),
                compliance: estimate.value,
                standard_uncertainty: estimate.standard_uncertainty,
            }
        })
        .collect();
    let turning: Vec<usize> = kept
        .iter()
        .copied()
        .filter(|k| answer.unknowns[*k].turns())
        .collect();
    let covariance: Vec<Vec<f64>> = turning
        .iter()
        .map(|a| {
            turning
                .iter()
                .map(|b| answer.identified.covariance[(*a, *b)])
                .collect()
        })
        .collect();
    let left_out = answer.left_out.as_ref().map_or(String::new(), |errors| {
        format!(
            "; a left-out test is predicted within {:.1} um on average, {:.1} % of the measured displacement",
            errors.mean_um,
            errors.fraction_of_measured * 100.0
        )
    });
    let what = format!(
        "compliances identified by armill from {} load tests with {} readings{left_out}",
        answer.tests, answer.readings
    );
    let identified = Identified {
        springs,
        covariance,
        model_error: answer.left_out.as_ref().map(|errors| errors.fraction_of_measured),
        what,
        place: tests_path.to_owned(),
    };
    Ok(with_springs(path, text, &identified)?)
}
