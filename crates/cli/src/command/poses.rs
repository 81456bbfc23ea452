//! Options of measured poses in SI, and the text of frames and errors; for `calibrate` and `pose_accuracy`.

use armill_core::calibrate::ParameterSet;
use armill_core::nalgebra::Vector3;
use armill_core::units::from_mm;
use armill_formats::measurement::poses::{PoseReadOptions, TurnOrder};
use armill_measure::calibrate::answer::FrameAnswer;
use armill_measure::calibrate::{ErrorsAnswer, Question};
use armill_study::StudyError;

use crate::arguments::numbers::{above_zero, three};
use crate::arguments::{PosesOptions, TurnArgument};

/// Settings of the fit, and how the file is read.
///
/// # Errors
/// Invalid numbers.
pub(super) fn question(
    options: &PosesOptions,
    requested: ParameterSet,
) -> Result<(Question, PoseReadOptions), StudyError> {
    let tool_point_mm = match &options.tool_mm {
        Some(tool_mm) => three("--tool-mm", tool_mm)?,
        None => Vector3::zeros(),
    };
    let turn_length = from_mm(above_zero("--turn-mm", options.turn_mm)?);
    let question = Question {
        requested,
        tool_point: from_mm(tool_point_mm),
        turn_length: options.turns.then_some(turn_length),
        prior: None,
    };
    let given = PoseReadOptions {
        columns: options.columns.clone(),
        turns: options.turn_order.map(|order| match order {
            TurnArgument::FixedXyz => TurnOrder::FixedXyz,
            TurnArgument::MovingXyz => TurnOrder::MovingXyz,
        }),
    };
    Ok((question, given))
}

/// A line of errors.
pub(super) fn errors_text(name: &str, errors: &ErrorsAnswer) -> String {
    let turn = match (errors.turn_mean_deg, errors.turn_max_deg) {
        (Some(mean), Some(max)) => format!("; turn mean {mean:.3}, max {max:.3} deg"),
        _ => String::new(),
    };
    let [x, y, z] = errors.rms_xyz_mm;
    format!(
        "{name:<22} {:>8.3} {:>8.3} {:>8.3}   ({x:.3}, {y:.3}, {z:.3}){turn}",
        errors.mean_mm, errors.rms_mm, errors.max_mm
    )
}

/// The headings of such lines.
pub(super) fn errors_head(name: &str) -> String {
    format!(
        "{name:<22} {:>8} {:>8} {:>8}   rms of x, y, z",
        "mean mm", "rms mm", "max mm"
    )
}

/// Identified base and measured point.
pub(super) fn frames_text(base: &FrameAnswer, point: &FrameAnswer) -> [String; 2] {
    let three = |[x, y, z]: [f64; 3]| format!("({x:.3}, {y:.3}, {z:.3})");
    [
        format!(
            "base   at {} mm in the tracker, rotated {} deg",
            three(base.at_mm),
            three(base.turned_deg)
        ),
        format!("point  at {} mm on the flange", three(point.at_mm)),
    ]
}
