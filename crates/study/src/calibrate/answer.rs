//! What was found, in numbers.

use armill_core::calibrate::{Estimate, Place, PoseErrors, Spread, Unknown};
use armill_core::frame::{Isometry, fixed_angles};
use armill_core::robot::Robot;
use serde::Serialize;

use super::calibration::{Calibration, Set};
use super::question::Question;
use crate::number::decimals;

/// Poses that are told one by one: the worst of each set.
const WORST: usize = 5;
/// Beyond so many times the rms a pose stands out: one in thousands does by chance.
const STANDS_OUT: f64 = 4.0;

/// A calibration in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct CalibrateAnswer {
    /// Its name.
    pub robot: String,
    /// Poses that it was found from.
    pub training: SetAnswer,
    /// Poses that judge it.
    pub held_out: Option<SetAnswer>,
    /// What was found of the chain.
    pub parameters: Vec<ParameterAnswer>,
    /// What these poses cannot tell: it stays at its nominal value.
    pub not_identifiable: Vec<RedundantAnswer>,
    /// Where the base stands in the axes of the tracker.
    pub tracker_from_base: FrameAnswer,
    /// Where the measured point is on the flange.
    pub flange_from_point: FrameAnswer,
    /// What was known before; none where nothing was.
    pub prior: Option<PriorAnswer>,
    /// How many of all estimates, base and point included, the poses tell; all without a prior.
    // unit: a count
    pub effective_parameters: f64,
    /// Standard deviation of a single reading about what was found.
    pub standard_deviation_mm: f64,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// Rows without a measured point.
    pub not_measured: usize,
    /// What to know of these numbers.
    pub notes: Vec<String>,
    /// Where methods come from.
    pub sources: Vec<&'static str>,
}

/// Standard deviations of small motions of the chain about zero.
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
    /// Where they stand.
    pub file: String,
    /// How many.
    pub poses: usize,
    /// Whether base and tool were found anew for them.
    pub frames_refitted: bool,
    /// Poses with a joint beyond the range of the poses that the geometry was found from.
    pub beyond_found_range: usize,
    /// By the robot file as it is.
    pub before: ErrorsAnswer,
    /// By the calibrated chain.
    pub after: ErrorsAnswer,
    /// The worst after, the worst first.
    pub worst: Vec<PoseAnswer>,
}

/// How far predictions miss.
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
    /// Likewise.
    pub turn_max_deg: Option<f64>,
}

/// A pose that is missed most.
#[derive(Clone, Debug, Serialize)]
pub struct PoseAnswer {
    /// Its line.
    pub line: usize,
    /// After calibration.
    pub error_mm: f64,
    /// Whether it lies beyond four times the rms.
    pub stands_out: bool,
}

/// A small motion that was found.
#[derive(Clone, Debug, Serialize)]
pub struct ParameterAnswer {
    /// Such as `A2 along x`.
    pub name: String,
    /// Whether it is the zero of its joint.
    pub zero: bool,
    /// How far along.
    pub value_mm: Option<f64>,
    /// Standard uncertainty.
    pub u_mm: Option<f64>,
    /// How far about.
    pub value_deg: Option<f64>,
    /// Standard uncertainty.
    pub u_deg: Option<f64>,
    /// Of the zero of a joint that turns: how much farther it stands than its controller counts, in the controller's sense.
    pub offset_deg: Option<f64>,
    /// Of the zero of a joint that slides.
    pub offset_mm: Option<f64>,
}

/// A motion that cannot be told.
#[derive(Clone, Debug, Serialize)]
pub struct RedundantAnswer {
    /// Such as `A1 about z`.
    pub name: String,
    /// Those that do together what it does; empty where no pose shows it.
    pub same_as: Vec<String>,
}

/// A frame that was found.
#[derive(Clone, Debug, Serialize)]
pub struct FrameAnswer {
    /// Its origin.
    pub at_mm: [f64; 3],
    /// Standard uncertainty along its own axes; none of what could not be told.
    pub at_u_mm: [Option<f64>; 3],
    /// Turned about the fixed axes x, y, z.
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
        .filter(|estimate| matches!(estimate.unknown.place, Place::After(_)))
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
        held_out: calibration.held_out.as_ref().map(set_answer),
        parameters,
        not_identifiable: redundant.collect(),
        tracker_from_base: frame(Place::Base, &after.tracker_from_base),
        flange_from_point: frame(Place::Tool, &after.flange_from_point),
        prior: question.prior.map(|prior| PriorAnswer {
            length_mm: reported(prior.length * 1e3),
            angle_deg: reported(prior.angle.to_degrees()),
        }),
        effective_parameters: decimals(after.reported, 3),
        standard_deviation_mm: reported(after.standard_deviation * 1e3),
        unused: calibration.unused.clone(),
        not_measured: calibration.not_measured,
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
        "uncertainties take what the geometry leaves for noise; sag, gears and heat that repeat are not noise".to_owned(),
        "before: the chain as the robot file says, base and measured point fitted to the same poses".to_owned(),
    ];
    if question.prior.is_some() {
        notes.push(
            "small motions are held to zero as far as the poses tell them less well than the prior"
                .to_owned(),
        );
    }
    if question.turn_length.is_none() {
        notes.push("found from positions alone".to_owned());
    }
    match &calibration.held_out {
        None => notes.push("no poses were held out: how well others are met is not known (--hold-out)".to_owned()),
        Some(set) if set.frames_refitted => notes.push(
            "held out from another set-up: base and measured point are fitted to these poses, before and after alike; \
             the chain is not"
                .to_owned(),
        ),
        Some(_) => {}
    }
    if let Some(set) = calibration.held_out.as_ref().filter(|set| set.beyond > 0) {
        notes.push(format!(
            "{} of the {} poses held out have a joint beyond the range of those that the geometry was found from: there \
             it is a guess",
            set.beyond,
            set.lines.len()
        ));
    }
    notes
}

/// The errors of a set.
fn set_answer(set: &Set) -> SetAnswer {
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
        error_mm: reported(lengths[*place] * 1e3),
        stands_out: lengths[*place] > STANDS_OUT * rms,
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
        mean_mm: reported(position.mean * 1e3),
        rms_mm: reported(position.rms * 1e3),
        max_mm: reported(position.largest * 1e3),
        rms_xyz_mm: [0, 1, 2].map(|axis| reported(by_axis[axis] * 1e3)),
        turn_mean_deg: turn.map(|turn| reported(turn.mean.to_degrees())),
        turn_max_deg: turn.map(|turn| reported(turn.largest.to_degrees())),
    }
}

/// A frame with what is known of it.
pub(crate) fn frame_answer(estimates: &[Estimate], place: Place, isometry: &Isometry) -> FrameAnswer {
    let u = |component: usize| {
        let here = Unknown { place, component };
        let found = estimates.iter().find(|estimate| estimate.unknown == here);
        found.map(|estimate| estimate.standard_uncertainty)
    };
    let at = isometry.translation.vector;
    let turned = fixed_angles(&isometry.rotation);
    FrameAnswer {
        at_mm: [0, 1, 2].map(|axis| reported(at[axis] * 1e3)),
        at_u_mm: [0, 1, 2].map(|axis| u(axis).map(|u| reported(u * 1e3))),
        turned_deg: [0, 1, 2].map(|axis| reported(turned[axis].to_degrees())),
        turned_u_deg: [3, 4, 5].map(|axis| u(axis).map(|u| reported(u.to_degrees()))),
    }
}

fn parameter(robot: &Robot, estimate: &Estimate) -> ParameterAnswer {
    let (value, u) = (estimate.value, estimate.standard_uncertainty);
    let turns = estimate.unknown.turns();
    let counted = match estimate.unknown.place {
        Place::After(joint) if estimate.unknown.is_zero_of(robot) => {
            Some(robot.joints()[joint].sign.factor() * value)
        }
        _ => None,
    };
    let length = |length: f64| (!turns).then(|| reported(length * 1e3));
    let angle = |angle: f64| turns.then(|| reported(angle.to_degrees()));
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
        Place::Base => "base",
        Place::Tool => "tool",
        Place::After(joint) => &robot.joints()[joint].name,
    };
    let word = if unknown.turns() { "about" } else { "along" };
    format!("{at} {word} {}", unknown.axis().letter())
}

/// A number in mm or deg to a nanometre, or a microdegree.
pub(crate) fn reported(value: f64) -> f64 {
    decimals(value, 6)
}
