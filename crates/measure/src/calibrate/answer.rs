//! The result of a calibration.

use armill_core::calibrate::{Estimate, ParameterLocation, PoseErrors, Spread, Unknown};
use armill_core::frame::{Isometry, fixed_angles};
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm};
use armill_study::number::decimals;
use serde::Serialize;

use super::calibration::{Calibration, PoseSet};
use super::question::Question;
use crate::data_check::SlipAnswer;

/// Number of poses reported individually: the worst of each set.
const WORST: usize = 5;
/// A pose with an error beyond this multiple of the rms is an outlier: one in thousands is by chance.
const OUTLIER: f64 = 4.0;

/// A calibration in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct CalibrateAnswer {
    /// Its name.
    pub robot: String,
    /// Training poses: those from which the parameters were identified.
    pub training: SetAnswer,
    /// Validation poses.
    pub validation: Option<SetAnswer>,
    /// Identified parameters of the chain.
    pub parameters: Vec<ParameterAnswer>,
    /// Parameters that these poses cannot determine: they keep their nominal values.
    pub not_identifiable: Vec<RedundantAnswer>,
    /// The base in the axes of the tracker.
    pub tracker_from_base: FrameAnswer,
    /// Where the measured point is on the flange.
    pub flange_from_point: FrameAnswer,
    /// The prior; none if it was not given.
    pub prior: Option<PriorAnswer>,
    /// Number of parameters, base and point included, that the poses determine; all without a prior.
    // unit: a count
    pub effective_parameters: f64,
    /// Standard deviation of a single reading after calibration.
    pub standard_deviation_mm: f64,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// Rows without a measured point.
    pub not_measured: usize,
    /// The likely slip in the data: an axis, a unit, a joint or one pose with which they agree much better.
    pub slip: Option<SlipAnswer>,
    /// Notes on these numbers.
    pub notes: Vec<String>,
    /// Sources of the methods.
    pub sources: Vec<&'static str>,
}

/// Prior standard deviations of the corrections of the chain about zero.
#[derive(Clone, Debug, Serialize)]
pub struct PriorAnswer {
    /// Along an axis.
    pub length_mm: f64,
    /// About an axis.
    pub angle_deg: f64,
}

/// Poses of one kind.
#[derive(Clone, Debug, Serialize)]
pub struct SetAnswer {
    /// File of the poses.
    pub file: String,
    /// How many.
    pub poses: usize,
    /// Whether base and tool were fitted again for them.
    pub frames_refitted: bool,
    /// Poses with a joint beyond the range of the training poses.
    pub beyond_found_range: usize,
    /// Errors with the robot file unchanged.
    pub before: ErrorsAnswer,
    /// By the calibrated chain.
    pub after: ErrorsAnswer,
    /// The worst after, the worst first.
    pub worst: Vec<PoseAnswer>,
}

/// Errors of the predictions.
#[derive(Clone, Debug, Serialize)]
pub struct ErrorsAnswer {
    /// Mean distance.
    pub mean_mm: f64,
    /// Root mean square.
    pub rms_mm: f64,
    /// Greatest.
    pub max_mm: f64,
    /// Root mean square of x, y, z of the tracker.
    pub rms_xyz_mm: [f64; 3],
    /// Of the turns, where they were used.
    pub turn_mean_deg: Option<f64>,
    /// The same.
    pub turn_max_deg: Option<f64>,
}

/// A pose that is missed most.
#[derive(Clone, Debug, Serialize)]
pub struct PoseAnswer {
    /// Its line.
    pub line: usize,
    /// After calibration.
    pub error_mm: f64,
    /// Whether its error is beyond four times the rms.
    pub is_outlier: bool,
}

/// An identified correction.
#[derive(Clone, Debug, Serialize)]
pub struct ParameterAnswer {
    /// Such as `A2 along x`.
    pub name: String,
    /// Whether it is the zero of its joint.
    pub zero: bool,
    /// Translation along the axis.
    pub value_mm: Option<f64>,
    /// Standard uncertainty.
    pub u_mm: Option<f64>,
    /// Rotation about the axis.
    pub value_deg: Option<f64>,
    /// Standard uncertainty.
    pub u_deg: Option<f64>,
    /// For the zero of a revolute joint: actual minus nominal position, in the sense of the controller.
    pub offset_deg: Option<f64>,
    /// For the zero of a prismatic joint.
    pub offset_mm: Option<f64>,
}

/// A correction that cannot be determined.
#[derive(Clone, Debug, Serialize)]
pub struct RedundantAnswer {
    /// Such as `A1 about z`.
    pub name: String,
    /// Corrections with the same effect; empty if it has no effect on any pose.
    pub same_as: Vec<String>,
}

/// An identified frame.
#[derive(Clone, Debug, Serialize)]
pub struct FrameAnswer {
    /// Its origin.
    pub at_mm: [f64; 3],
    /// Standard uncertainty along its own axes; none for what could not be determined.
    pub at_u_mm: [Option<f64>; 3],
    /// Rotated about the fixed axes x, y, z.
    pub turned_deg: [f64; 3],
    /// Standard uncertainty about its own axes.
    pub turned_u_deg: [Option<f64>; 3],
}

/// The numbers of a calibration.
pub fn answer(robot: &Robot, calibration: &Calibration, question: &Question) -> CalibrateAnswer {
    let after = &calibration.after;
    let name = |unknown: &Unknown| unknown_name(robot, unknown);
    let parameters: Vec<ParameterAnswer> = after
        .estimates
        .iter()
        .filter(|estimate| matches!(estimate.unknown.place, ParameterLocation::After(_)))
        .map(|estimate| parameter(robot, estimate))
        .collect();
    let redundant = after.redundant.iter().map(|redundant| RedundantAnswer {
        name: name(&after.unknowns[redundant.unknown]),
        same_as: redundant
            .same_as
            .iter()
            .map(|k| name(&after.unknowns[*k]))
            .collect(),
    });
    let frame = |place, isometry| frame_answer(&after.estimates, place, isometry);
    let notes = notes(calibration, question);
    CalibrateAnswer {
        robot: robot.name().to_owned(),
        training: set_answer(&calibration.training),
        validation: calibration.validation.as_ref().map(set_answer),
        parameters,
        not_identifiable: redundant.collect(),
        tracker_from_base: frame(ParameterLocation::Base, &after.tracker_from_base),
        flange_from_point: frame(ParameterLocation::Tool, &after.flange_from_point),
        prior: question.prior.map(|prior| PriorAnswer {
            length_mm: reported(to_mm(prior.length)),
            angle_deg: reported(to_deg(prior.angle)),
        }),
        effective_parameters: decimals(after.effective_parameters, 3),
        standard_deviation_mm: reported(to_mm(after.standard_deviation)),
        unused: calibration.unused.clone(),
        not_measured: calibration.not_measured,
        slip: calibration.slip.clone(),
        notes,
        sources: vec![
            "Everett, Driels, Mooring 1987: how many parameters a chain has",
            "Mooring, Roth, Driels 1991: Fundamentals of Manipulator Calibration",
            "theory: docs/theory/calibration.md",
        ],
    }
}

fn notes(calibration: &Calibration, question: &Question) -> Vec<String> {
    let mut notes = vec![
        "uncertainties treat all residuals as noise; systematic effects of gravity, gears and temperature are not noise".to_owned(),
        "before: the chain of the robot file, base and measured point fitted to the same poses".to_owned(),
    ];
    if question.prior.is_some() {
        notes.push(
            "corrections that the poses determine less well than the prior are kept near zero by the prior"
                .to_owned(),
        );
    }
    if question.turn_length.is_none() {
        notes.push("identified from positions only".to_owned());
    }
    match &calibration.validation {
        None => notes.push("no validation poses: the accuracy for other poses is not known (--validation)".to_owned()),
        Some(set) if set.frames_refitted => notes.push(
            "validation poses of another set-up: base and measured point are fitted to these poses, before and after; \
             the chain is not"
                .to_owned(),
        ),
        Some(_) => {}
    }
    if let Some(set) = calibration.validation.as_ref().filter(|set| set.beyond > 0) {
        notes.push(format!(
            "{} of the {} validation poses have a joint beyond the range of the training poses: the calibration extrapolates \
             there",
            set.beyond,
            set.lines.len()
        ));
    }
    notes
}

/// The errors of a set.
fn set_answer(set: &PoseSet) -> SetAnswer {
    let lengths: Vec<f64> = set
        .after
        .position
        .iter()
        .map(armill_core::nalgebra::Vector3::norm)
        .collect();
    let mut order: Vec<usize> = (0..lengths.len()).collect();
    order.sort_by(|a, b| lengths[*b].total_cmp(&lengths[*a]));
    let rms = set.after.of_position().map_or(0.0, |spread| spread.rms);
    let pose = |place: &usize| PoseAnswer {
        line: set.lines[*place],
        error_mm: reported(to_mm(lengths[*place])),
        is_outlier: lengths[*place] > OUTLIER * rms,
    };
    SetAnswer {
        file: set.file.clone(),
        poses: lengths.len(),
        frames_refitted: set.frames_refitted,
        beyond_found_range: set.beyond,
        before: errors_answer(&set.before),
        after: errors_answer(&set.after),
        worst: order.iter().take(WORST).map(pose).collect(),
    }
}

/// Errors in mm and deg.
pub(crate) fn errors_answer(errors: &PoseErrors) -> ErrorsAnswer {
    let none = Spread {
        mean: 0.0,
        rms: 0.0,
        largest: 0.0,
    };
    let position = errors.of_position().unwrap_or(none);
    let turn = errors.of_turn();
    let by_axis = errors.rms_by_axis();
    ErrorsAnswer {
        mean_mm: reported(to_mm(position.mean)),
        rms_mm: reported(to_mm(position.rms)),
        max_mm: reported(to_mm(position.largest)),
        rms_xyz_mm: [0, 1, 2].map(|axis| reported(to_mm(by_axis[axis]))),
        turn_mean_deg: turn.map(|turn| reported(to_deg(turn.mean))),
        turn_max_deg: turn.map(|turn| reported(to_deg(turn.largest))),
    }
}

/// A frame with its uncertainties.
pub(crate) fn frame_answer(
    estimates: &[Estimate],
    place: ParameterLocation,
    isometry: &Isometry,
) -> FrameAnswer {
    let u = |component: usize| {
        let here = Unknown { place, component };
        let found = estimates.iter().find(|estimate| estimate.unknown == here);
        found.map(|estimate| estimate.standard_uncertainty)
    };
    let at = isometry.translation.vector;
    let turned = fixed_angles(&isometry.rotation);
    FrameAnswer {
        at_mm: [0, 1, 2].map(|axis| reported(to_mm(at[axis]))),
        at_u_mm: [0, 1, 2].map(|axis| u(axis).map(|u| reported(to_mm(u)))),
        turned_deg: [0, 1, 2].map(|axis| reported(to_deg(turned[axis]))),
        turned_u_deg: [3, 4, 5].map(|axis| u(axis).map(|u| reported(to_deg(u)))),
    }
}

fn parameter(robot: &Robot, estimate: &Estimate) -> ParameterAnswer {
    let (value, u) = (estimate.value, estimate.standard_uncertainty);
    let turns = estimate.unknown.turns();
    let counted = match estimate.unknown.place {
        ParameterLocation::After(joint) if estimate.unknown.is_zero_of(robot) => {
            Some(robot.joints()[joint].sign.factor() * value)
        }
        _ => None,
    };
    let length = |length: f64| (!turns).then(|| reported(to_mm(length)));
    let angle = |angle: f64| turns.then(|| reported(to_deg(angle)));
    ParameterAnswer {
        name: unknown_name(robot, &estimate.unknown),
        zero: estimate.unknown.is_zero_of(robot),
        value_mm: length(value),
        u_mm: length(u),
        value_deg: angle(value),
        u_deg: angle(u),
        offset_deg: counted.and_then(angle),
        offset_mm: counted.and_then(length),
    }
}

/// What an unknown is called.
fn unknown_name(robot: &Robot, unknown: &Unknown) -> String {
    let at = match unknown.place {
        ParameterLocation::Base => "base",
        ParameterLocation::Tool => "tool",
        ParameterLocation::After(joint) => &robot.joints()[joint].name,
    };
    let word = if unknown.turns() { "about" } else { "along" };
    format!("{at} {word} {}", unknown.axis().letter())
}

/// A number in mm or deg to a nanometre, or a microdegree.
pub(crate) fn reported(value: f64) -> f64 {
    decimals(value, 6)
}
