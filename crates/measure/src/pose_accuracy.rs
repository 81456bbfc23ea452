//! Pose accuracy and repeatability: the result of `armill pose-accuracy`.
//!
//! Base and measured point are fitted, the chain is that of the robot file; the commanded position of a pose is
//! computed from the joint positions of its cycles. Rows are cycles of one pose if their `pose` cells are the same,
//! or, without such a column, if the robot was in the same posture, and commanded poses, if given, are the
//! same to the last digit.

use std::collections::BTreeMap;

use armill_core::calibrate::{Calibrated, ParameterLocation, ParameterSet, fit};
use armill_core::measure::pose_accuracy::{
    Attained, CYCLES, PoseAccuracy, multi_directional_variation, pose_accuracy,
};
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm};
use armill_formats::measurement::poses::MeasuredPoses;
use armill_study::StudyError;
use serde::Serialize;

use crate::calibrate::answer::{ErrorsAnswer, FrameAnswer, errors_answer, frame_answer, reported};
use crate::calibrate::calibration::refused_by;
use crate::calibrate::question::Question;
use crate::data_check::{self, SlipAnswer};

/// Poses that were measured, in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct PoseAccuracyAnswer {
    /// Its name.
    pub robot: String,
    /// Position of the measurements.
    pub file: String,
    /// Measured visits.
    pub visits: usize,
    /// Different poses.
    pub poses: usize,
    /// Of all visits: measured relative to the prediction of the chain.
    pub absolute: ErrorsAnswer,
    /// Of poses reached more than once.
    pub repeated: Option<RepeatedAnswer>,
    /// Each pose reached more than once.
    pub by_pose: Vec<PoseAnswer>,
    /// The base in the axes of the tracker.
    pub tracker_from_base: FrameAnswer,
    /// Where the measured point is on the flange.
    pub flange_from_point: FrameAnswer,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// Rows without a measured point.
    pub not_measured: usize,
    /// The likely slip in the data: an axis, a unit, a joint or one pose with which they agree much better.
    pub slip: Option<SlipAnswer>,
    /// What to know of these numbers.
    pub notes: Vec<String>,
    /// Sources of the definitions.
    pub sources: Vec<&'static str>,
}

/// Over all poses reached more than once.
#[derive(Clone, Debug, Serialize)]
pub struct RepeatedAnswer {
    /// How many.
    pub poses: usize,
    /// Fewest cycles of one.
    pub fewest_cycles: usize,
    /// AP: mean of the poses.
    pub ap_mean_mm: f64,
    /// AP: the worst pose.
    pub ap_max_mm: f64,
    /// RP: mean of the poses.
    pub rp_mean_mm: f64,
    /// RP: the worst pose.
    pub rp_max_mm: f64,
    /// vAP: the worst pose that was reached from several directions.
    pub vap_max_mm: Option<f64>,
}

/// A pose reached more than once.
#[derive(Clone, Debug, Serialize)]
pub struct PoseAnswer {
    /// Its name, or the line of its first visit.
    pub name: String,
    /// Visits.
    pub cycles: usize,
    /// AP.
    pub ap_mm: f64,
    /// AP along x, y, z of the base.
    pub ap_xyz_mm: [f64; 3],
    /// RP.
    pub rp_mm: f64,
    /// AP of rotations about x, y, z of the base.
    pub ap_turn_deg: Option<[f64; 3]>,
    /// RP of turns.
    pub rp_turn_deg: Option<[f64; 3]>,
    /// vAP, of several directions.
    pub vap_mm: Option<f64>,
}

/// Accuracy of the poses of `measured`, the file `shown`.
///
/// # Errors
/// Poses that determine too little or belong to another robot.
pub fn answer(
    robot: &Robot,
    shown: &str,
    measured: &MeasuredPoses,
    question: &Question,
) -> Result<PoseAccuracyAnswer, StudyError> {
    let check = || {
        let frames = question.for_core(ParameterSet::BaseAndTool);
        data_check::poses::slip(robot, &measured.poses, &measured.lines, &frames)
    };
    let found = fit(
        robot,
        &measured.poses,
        &question.for_core(ParameterSet::BaseAndTool),
    )
    .map_err(|error| refused_by(shown, &error, check().as_ref()))?;
    let groups = groups(measured);
    let visits: Vec<[Attained; 2]> = (0..measured.poses.len())
        .map(|k| visit(measured, &found, k))
        .collect();
    let by_pose: Vec<PoseAnswer> = groups
        .iter()
        .filter(|places| places.len() > 1)
        .filter_map(|places| of_pose(measured, &visits, places))
        .collect();
    let repeated = repeated(&by_pose);
    let mut notes = vec![
        "base and measured point are fitted to these poses; errors that they can absorb are not included"
            .to_owned(),
        "the commanded pose is computed by the robot file from the joint positions".to_owned(),
    ];
    match &repeated {
        None => notes.push("no pose was reached twice: repeatability is not known".to_owned()),
        Some(all) if all.fewest_cycles < CYCLES => {
            notes.push(format!(
                "ISO 9283 requires {CYCLES} cycles per pose; fewest here: {}",
                all.fewest_cycles
            ));
        }
        Some(_) => {}
    }
    let frame = |place, isometry| frame_answer(&found.estimates, place, isometry);
    Ok(PoseAccuracyAnswer {
        robot: robot.name().to_owned(),
        file: shown.to_owned(),
        visits: measured.poses.len(),
        poses: groups.len(),
        absolute: errors_answer(&found.errors),
        repeated,
        by_pose,
        tracker_from_base: frame(ParameterLocation::Base, &found.tracker_from_base),
        flange_from_point: frame(ParameterLocation::Tool, &found.flange_from_point),
        unused: measured.unused.clone(),
        not_measured: measured.not_measured,
        slip: check(),
        notes,
        sources: vec![
            "ISO 9283:1998, definitions from memory: compare with the standard before claiming conformity",
        ],
    })
}

/// Joint positions nearer to each other than this (rad, m) are of one posture.
const SAME_POSTURE: f64 = 1e-2;
/// Width of a cell of joint space, rad, m: so large that few postures are near its edge.
const CELL: f64 = 16.0 * SAME_POSTURE;

/// Visits of the same pose, in the order of their first one.
fn groups(measured: &MeasuredPoses) -> Vec<Vec<usize>> {
    let bits = |numbers: &[f64]| {
        numbers
            .iter()
            .map(|number| number.to_bits())
            .collect::<Vec<u64>>()
    };
    let joints = |place: usize| measured.poses[place].joints.as_slice();
    let key = |place: usize| match (&measured.names, &measured.commanded) {
        (Some(names), _) => (names[place].clone(), Vec::new()),
        (None, Some(commanded)) => (String::new(), bits(&commanded[place])),
        (None, None) => (String::new(), bits(joints(place))),
    };
    let is_one_posture = |a: usize, b: usize| {
        let mut both = joints(a).iter().zip(joints(b));
        measured.names.is_some() || both.all(|(a, b)| (a - b).abs() < SAME_POSTURE)
    };
    // Groups by key and cell of joint space, so that a row is compared with few.
    let mut by_cell: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for place in 0..measured.poses.len() {
        let around = match measured.names {
            Some(_) => vec![Vec::new()],
            None => cells_around(joints(place), SAME_POSTURE),
        };
        let key = key(place);
        let near = around
            .into_iter()
            .filter_map(|cell| by_cell.get(&(key.clone(), cell)))
            .flatten();
        match near
            .filter(|group| is_one_posture(groups[**group][0], place))
            .min()
        {
            Some(group) => groups[*group].push(place),
            None => {
                let own = match measured.names {
                    Some(_) => vec![Vec::new()],
                    None => cells_around(joints(place), 0.0),
                };
                let own = own.into_iter().next().unwrap_or_default();
                by_cell.entry((key, own)).or_default().push(groups.len());
                groups.push(vec![place]);
            }
        }
    }
    groups
}

/// The cells of joint space, [`CELL`] wide, within `reach` of these joints.
fn cells_around(joints: &[f64], reach: f64) -> Vec<Vec<i64>> {
    let mut cells: Vec<Vec<i64>> = vec![Vec::new()];
    for joint in joints {
        let [from, to] = [joint - reach, joint + reach].map(|at| (at / CELL).floor() as i64);
        let next = |cell: &Vec<i64>| -> Vec<Vec<i64>> {
            let with = |at: i64| cell.iter().copied().chain([at]).collect();
            (from..=to).map(with).collect()
        };
        cells = cells.iter().flat_map(next).collect();
    }
    cells
}

/// Commanded and measured position of a visit, m, axes of the base.
fn visit(measured: &MeasuredPoses, found: &Calibrated, place: usize) -> [Attained; 2] {
    let pose = &measured.poses[place];
    let base_from_tracker = found.tracker_from_base.inverse();
    let turned = |rotation: UnitQuaternion<f64>| base_from_tracker.rotation * rotation;
    let commanded = pose.position - found.errors.position[place];
    let rotation = pose.rotation.zip(found.errors.turn.get(place));
    let at = |position: Vector3<f64>, rotation: Option<UnitQuaternion<f64>>| Attained {
        position: base_from_tracker.transform_point(&position.into()).coords,
        turn: rotation.map(turned),
    };
    let given = rotation.map(|(rotation, turn)| UnitQuaternion::from_scaled_axis(-turn) * rotation);
    [at(commanded, given), at(pose.position, pose.rotation)]
}

fn of_pose(measured: &MeasuredPoses, visits: &[[Attained; 2]], places: &[usize]) -> Option<PoseAnswer> {
    let commanded: Vec<Attained> = places.iter().map(|place| visits[*place][0]).collect();
    let attained: Vec<Attained> = places.iter().map(|place| visits[*place][1]).collect();
    // Joint positions of cycles differ by encoder resolution: their mean is the commanded position.
    let mean = pose_accuracy(&commanded[0], &commanded)?;
    let meant = Attained {
        position: mean.barycentre,
        turn: commanded[0]
            .turn
            .zip(mean.turn_offset)
            .map(|(turn, offset)| UnitQuaternion::from_scaled_axis(offset) * turn),
    };
    let found: PoseAccuracy = pose_accuracy(&meant, &attained)?;
    let mm = |vector: Vector3<f64>| [0, 1, 2].map(|axis| reported(to_mm(vector[axis])));
    let deg = |vector: Vector3<f64>| [0, 1, 2].map(|axis| reported(to_deg(vector[axis])));
    Some(PoseAnswer {
        name: match &measured.names {
            Some(names) => names[places[0]].clone(),
            None => format!("line {}", measured.lines[places[0]]),
        },
        cycles: found.cycles,
        ap_mm: reported(to_mm(found.accuracy())),
        ap_xyz_mm: mm(found.offset),
        rp_mm: reported(to_mm(found.repeatability?)),
        ap_turn_deg: found.turn_offset.map(deg),
        rp_turn_deg: found.turn_repeatability.map(deg),
        vap_mm: variation(measured, visits, places).map(|vap| reported(to_mm(vap))),
    })
}

/// vAP (m) of a pose; `None` of one direction.
fn variation(measured: &MeasuredPoses, visits: &[[Attained; 2]], places: &[usize]) -> Option<f64> {
    let directions = measured.directions.as_ref()?;
    let mut by_direction: BTreeMap<&str, Vec<Attained>> = BTreeMap::new();
    for place in places {
        by_direction
            .entry(&directions[*place])
            .or_default()
            .push(visits[*place][1]);
    }
    let centres: Vec<Vector3<f64>> = by_direction
        .values()
        .filter_map(|cycles| pose_accuracy(&cycles[0], cycles))
        .map(|found| found.barycentre)
        .collect();
    (centres.len() > 1).then(|| multi_directional_variation(&centres))
}

fn repeated(by_pose: &[PoseAnswer]) -> Option<RepeatedAnswer> {
    let fewest_cycles = by_pose.iter().map(|pose| pose.cycles).min()?;
    let mean =
        |of: fn(&PoseAnswer) -> f64| reported(by_pose.iter().map(of).sum::<f64>() / by_pose.len() as f64);
    let largest = |of: fn(&PoseAnswer) -> f64| by_pose.iter().map(of).fold(0.0, f64::max);
    Some(RepeatedAnswer {
        poses: by_pose.len(),
        fewest_cycles,
        ap_mean_mm: mean(|pose| pose.ap_mm),
        ap_max_mm: largest(|pose| pose.ap_mm),
        rp_mean_mm: mean(|pose| pose.rp_mm),
        rp_max_mm: largest(|pose| pose.rp_mm),
        vap_max_mm: by_pose.iter().filter_map(|pose| pose.vap_mm).reduce(f64::max),
    })
}
