//! The picture of the errors, and the robot file with its file of residuals.

use armill_core::learn::HeldOut;
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::units::to_mm;
use armill_formats::robot::armill::{
    Geometry, GeometryCovarianceTable, LearntTable, residuals_file, with_geometry, with_residual,
};
use armill_report::{ErrorDistribution, ErrorSet, ModelErrors};
use armill_study::StudyError;

use super::answer::LearnAnswer;
use super::learning::{Learning, Question};

/// Errors of poses held out, and of other poses, by the three models, as SVG.
pub fn drawing(given: &LearnAnswer, learning: &Learning) -> String {
    let lengths = |errors: &[Vector3<f64>]| errors.iter().map(|error| to_mm(error.norm())).collect();
    let of = |name: &str, errors: &HeldOut| ErrorSet {
        name: name.to_owned(),
        models: [
            ("nominal", &errors.nominal),
            ("calibrated", &errors.calibrated),
            ("learnt", &errors.learnt),
        ]
        .map(|(name, errors)| ModelErrors {
            name: name.to_owned(),
            errors_mm: lengths(errors),
        })
        .to_vec(),
    };
    let mut sets = vec![of("held out", &learning.held_out)];
    sets.extend(learning.other.as_ref().map(|(file, errors)| of(file, errors)));
    ErrorDistribution {
        title: format!("{}: errors of position", given.robot),
        subtitle: format!("{} poses, held out in {} stretches", given.poses, given.stretches),
        quantity: "distance of measured from predicted (mm)".to_owned(),
        sets,
    }
    .to_svg()
}

/// The robot file `text` (at `path`) with the calibrated chain and the learnt residual, and the text of its file of residuals,
/// which is to be called `residuals` and kept in the same folder.
///
/// # Errors
/// A residual that does not carry to poses held out; a robot file that is not TOML, or that no longer reads with these numbers.
pub fn robot_file(
    robot: &Robot,
    [path, text]: [&str; 2],
    residuals: &str,
    learning: &Learning,
    question: &Question,
) -> Result<[String; 2], StudyError> {
    let reduction = learning.held_out.reduction(question.stretches);
    if !reduction.is_significant() {
        return Err(StudyError::value(
            "--out: the learnt residual does not reduce the error of poses held out beyond its uncertainty"
                .to_owned(),
            "use the calibration alone (armill calibrate), or measure more poses where the robot will work",
        ));
    }
    let rms = |errors: &[Vector3<f64>]| {
        let squares: f64 = errors.iter().map(Vector3::norm_squared).sum();
        to_mm((squares / errors.len().max(1) as f64).sqrt())
    };
    let poses = learning.residuals.len();
    let after: Vec<_> = (0..robot.joints().len())
        .map(|joint| {
            let motions = learning.calibrated.motions_after(joint);
            (robot.joints()[joint].name.clone(), motions)
        })
        .filter(|(_, motions)| !motions.is_empty())
        .collect();
    let mut text = text.to_owned();
    if !after.is_empty() {
        let geometry = Geometry {
            after,
            what: format!(
                "corrections identified by armill from {poses} measured poses; poses held out: {:.3} mm rms",
                rms(&learning.held_out.calibrated)
            ),
            place: learning.file.clone(),
            covariance: (learning.calibrated.uncertainty())
                .map(|geometry| GeometryCovarianceTable::of(robot, &geometry)),
        };
        text = with_geometry(path, &text, &geometry)?;
    }
    let content = residuals_file(robot, &learning.residuals);
    let table = LearntTable::of(robot, learning.learnt.settings(), residuals, &content);
    let what = format!(
        "residual learnt by armill from {poses} measured poses; poses held out: {:.3} mm rms",
        rms(&learning.held_out.learnt)
    );
    let text = with_residual(path, &text, &table, [&what, &learning.file])?;
    Ok([text, content])
}
