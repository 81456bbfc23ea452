//! A path in the answer: the deviation of the tool along it, where and why, and its effect on features.
//!
//! | part of the deviation | meaning |
//! |---|---|
//! | in-plane | across the tool, of a shape in its plane: the largest of all cases, compared with the tolerance |
//! | along, cross | its components forwards on the track and to the left of it: hardly visible, and the error of walls |
//! | axial | along the tool, from the part towards the spindle: the error of floors |
//!
//! `worst`: where it is worst; `feature`: circles, lines, planes, holes; `cut`, `measured`: the load; `limits`: the
//! process limits; `program`: data of a program; `obstacles`: where the arm cannot follow it; `search`: the result of a search
//! for spins of the tool and branches; `motion`: what the controller makes of it; `unloaded`: the effect of backlash and geometry.

mod cut;
mod feature;
pub(crate) mod limits;
pub mod measured;
pub mod motion;
pub mod obstacles;
mod program;
pub mod search;
mod unloaded;
mod worst;

pub use cut::{CutAnswer, RestAnswer, StockAnswer};
pub use feature::FeatureAnswer;
pub use limits::{LimitAnswer, LimitsAnswer};
pub use measured::MeasuredAnswer;
pub use motion::{LostTime, MotionAnswer, SlowPlace};
pub use obstacles::ObstacleAnswer;
pub use program::{OperationAnswer, ProgramAnswer};
pub use search::{SearchAnswer, StatisticsAnswer};
pub use unloaded::UnloadedAnswer;
pub use worst::WorstPoint;

use armill_core::kernel::Answers;
use armill_core::map::AlongPath;
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::clearance::{LeastClearance, in_collision};
use crate::analysis::path::PathAnalysis;
use crate::analysis::path::machined_part::answer::MachinedPartAnswer;
use crate::analysis::path::run::PathResult;
use crate::analysis::point::{PointAnswer, SettingAnswer};
use crate::analysis::vibration::{SeriesVibration, VibrationAnswer};
use crate::input::setting::Setting;
use crate::joint_order::joint_order;
use crate::number::without_rounding;

/// A path.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PathAnswer {
    /// Its name.
    pub name: String,
    /// Requested posture: words of a branch, or `best`.
    pub branch: String,
    /// Branch in which the whole path is followed; none for an arm whose branches have no names.
    pub followed_branch: Option<String>,
    /// How many points.
    pub points: usize,
    /// Points without posture.
    pub unreachable: usize,
    /// Of these, points where no posture keeps the demanded clearance.
    pub in_collision: usize,
    /// Least distance of two bodies along the path, 0 where they touch; none without bodies.
    pub least_clearance_mm: Option<f64>,
    /// The two bodies.
    pub nearest: Option<[String; 2]>,
    /// Points with a posture outside joint limits.
    pub outside_joint_limits: usize,
    /// Length of all cuts, or of the shape.
    pub length_mm: f64,
    /// Largest in-plane deviation of all reached points, all cases: across the tool.
    pub max_in_plane_um: Option<f64>,
    /// Least in-plane envelope along the path.
    pub min_in_plane_um: Option<f64>,
    /// Largest length of the deviation.
    pub max_full_um: Option<f64>,
    /// Largest deviation along the track, by size.
    pub max_along_um: Option<f64>,
    /// Largest deviation across the track, by size: the error of walls.
    pub max_cross_um: Option<f64>,
    /// Largest deviation along the tool, by size: the error of floors.
    pub max_axial_um: Option<f64>,
    /// Points within the tolerance over all points.
    pub fraction_within: f64,
    /// The same, of points inside the joint limits only.
    pub fraction_within_and_inside_joint_limits: f64,
    /// Of circles reached everywhere, the path itself or its features: the largest roundness of all cases (peak to
    /// valley about the least-squares circle).
    pub roundness_um: Option<f64>,
    /// On a circle: each case.
    pub circle_cases: Vec<CircleCase>,
    /// Deviations of the requested features.
    pub features: Vec<FeatureAnswer>,
    /// The point with the largest in-plane deviation.
    pub worst: Option<PointAnswer>,
    /// The worst points, each from another part of the path.
    pub worst_points: Vec<WorstPoint>,
    /// Where the arm cannot follow the path at its feed without a stop; empty if it can.
    pub obstacles: Vec<ObstacleAnswer>,
    /// The common setting of all points.
    pub setting: SettingAnswer,
    /// Range of each joint (mm for prismatic joints) along the path; empty if no point is reached.
    pub joint_range_deg: Vec<[f64; 2]>,
    /// The cut or drill, if the forces were computed from it.
    pub cut: Option<CutAnswer>,
    /// The record of the forces; none if they were not measured.
    pub measured: Option<MeasuredAnswer>,
    /// The process limits that meet the tolerance everywhere.
    pub limits: Option<LimitsAnswer>,
    /// The program of the path; none for a shape.
    pub program: Option<ProgramAnswer>,
    /// The search for spins of the tool and branches; none without a search.
    pub search: Option<SearchAnswer>,
    /// What the controller makes of the path; none if the study does not ask for it.
    pub motion: Option<MotionAnswer>,
    /// Modes of the arm, stability and vibration of the cut; none without `[vibration]`.
    pub vibration: Option<VibrationAnswer>,
    /// Effect of backlash and geometry on the deviations; none if load and gravity alone move the tool.
    pub unloaded: Option<UnloadedAnswer>,
    /// The part that comes out; none if the study does not ask for it.
    pub machined_part: Option<MachinedPartAnswer>,
    /// What was skipped or assumed.
    pub notes: Vec<String>,
}

/// The deviation of a circle under one load case.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CircleCase {
    /// The case, from 1.
    pub case: usize,
    /// Largest outward deviation.
    pub max_radial_um: f64,
    /// Largest inward deviation, negative.
    pub min_radial_um: f64,
    /// Shift of the least-squares centre along y' and z'.
    pub centre_shift_um: [f64; 2],
    /// Peak to valley about the least-squares circle.
    pub roundness_um: f64,
}

/// The vibration along a path, if the study asks for it.
#[derive(Debug, Default)]
pub struct PathVibration<'a> {
    /// At its points.
    pub series: Option<&'a SeriesVibration>,
    /// In numbers.
    pub answer: Option<VibrationAnswer>,
}

/// The result of the path of the analysis called `name`.
pub fn answer(
    robot: &Robot,
    name: &str,
    analysis: &PathAnalysis,
    found: &PathResult,
    vibration: PathVibration<'_>,
) -> PathAnswer {
    let (setting, answers) = (&analysis.setting, &found.along.answers);
    let evaluation = || answers.evaluations().map(|(_, evaluation)| evaluation);
    let points = answers.points.len();
    let within = || evaluation().filter(|evaluation| evaluation.in_plane <= setting.tolerance);
    let part = |count: usize| count as f64 / points.max(1) as f64;
    let features = feature::features(analysis, found);
    let of_features = features.iter().filter_map(|feature| feature.roundness_um);
    let of_cases = found
        .radial
        .iter()
        .map(|radial| to_um(radial.roundness.peak_to_valley));
    let worst_points = worst::worst_points(robot, analysis, found);
    let [along, cross, axial] = largest_parts(analysis, found);
    let clearance = LeastClearance::of(setting, answers);
    PathAnswer {
        name: name.to_owned(),
        branch: setting.branch(),
        followed_branch: followed(robot, &found.along, setting),
        points,
        unreachable: points - evaluation().count(),
        in_collision: in_collision(answers),
        least_clearance_mm: clearance.as_ref().map(|least| least.distance_mm),
        nearest: clearance.map(|least| least.bodies),
        outside_joint_limits: evaluation()
            .filter(|evaluation| !evaluation.within_limits())
            .count(),
        length_mm: to_mm(analysis.length()),
        max_in_plane_um: answers.worst().map(|(_, evaluation)| to_um(evaluation.in_plane)),
        min_in_plane_um: answers.best().map(|(_, evaluation)| to_um(evaluation.in_plane)),
        max_full_um: evaluation()
            .map(|evaluation| to_um(evaluation.full))
            .max_by(f64::total_cmp),
        max_along_um: along,
        max_cross_um: cross,
        max_axial_um: axial,
        fraction_within: part(within().count()),
        fraction_within_and_inside_joint_limits: part(
            within().filter(|evaluation| evaluation.within_limits()).count(),
        ),
        roundness_um: of_cases.chain(of_features).max_by(f64::total_cmp),
        circle_cases: circle_cases(found),
        worst: worst_points.first().map(|worst| worst.point.clone()),
        obstacles: obstacles::found(robot, &analysis.track.path, answers, 0.0),
        setting: SettingAnswer::of(robot, setting),
        joint_range_deg: joint_ranges(robot, answers),
        cut: CutAnswer::of(analysis, found),
        measured: analysis.measured.as_deref().map(MeasuredAnswer::of),
        limits: LimitsAnswer::of(analysis, found),
        program: ProgramAnswer::of(analysis, found),
        search: SearchAnswer::of(robot, analysis, found),
        motion: MotionAnswer::of(robot, analysis, found),
        machined_part: MachinedPartAnswer::of(robot, analysis, found, vibration.series),
        vibration: vibration.answer,
        unloaded: UnloadedAnswer::of(robot, analysis, found),
        notes: notes(analysis, found),
        worst_points,
        features,
    }
}

/// The branch of the whole path, if its robot has names for them.
fn followed(robot: &Robot, along: &AlongPath, setting: &Setting) -> Option<String> {
    if !robot.inverse().has_branches() {
        return None;
    }
    let mut names: Vec<String> = Vec::new();
    for (_, choice) in &along.choices {
        let of_run = Setting {
            choice: *choice,
            ..setting.clone()
        };
        let name = of_run.branch();
        if !names.contains(&name) {
            names.push(name);
        }
    }
    Some(names.join(", then "))
}

/// Largest deviation of all cases along the track, across it and along the tool, by size.
fn largest_parts(analysis: &PathAnalysis, found: &PathResult) -> [Option<f64>; 3] {
    let answers = &found.along.answers;
    let mut largest: Option<[f64; 3]> = None;
    for (index, _) in answers.evaluations() {
        for deviation in answers.deviations_at(index) {
            let parts = analysis.track.parts(index, deviation);
            let [along, cross, axial] = largest.unwrap_or_default();
            largest = Some([
                along.max(parts.along.abs()),
                cross.max(parts.cross.abs()),
                axial.max(parts.axial.abs()),
            ]);
        }
    }
    std::array::from_fn(|i| largest.map(|largest| to_um(largest[i])))
}

/// Each case of a circle that is a shape; none for other paths, and for a circle that is not reached everywhere.
fn circle_cases(found: &PathResult) -> Vec<CircleCase> {
    let of_case = |(case, radial): (usize, &armill_core::map::RadialDeviation)| CircleCase {
        case: case + 1,
        max_radial_um: to_um(radial.outward.iter().copied().fold(f64::MIN, f64::max)),
        min_radial_um: to_um(radial.outward.iter().copied().fold(f64::MAX, f64::min)),
        centre_shift_um: [to_um(-radial.centre_shift.x), to_um(radial.centre_shift.y)],
        roundness_um: to_um(radial.roundness.peak_to_valley),
    };
    found.radial.iter().enumerate().map(of_case).collect()
}

/// Range of each joint, deg (mm), in the order of the robot; empty if no point is reached.
pub(crate) fn joint_ranges(robot: &Robot, answers: &Answers) -> Vec<[f64; 2]> {
    let range = |joint: usize| {
        let slides = robot.slides(joint);
        let scale = if slides { 1e3 } else { to_deg(1f64) };
        let positions = answers
            .evaluations()
            .map(|(index, _)| answers.joints_at(index)[joint] * scale);
        let [low, high] = positions.fold([f64::MAX, f64::MIN], |[low, high], q| [low.min(q), high.max(q)]);
        (low <= high).then(|| [without_rounding(low), without_rounding(high)])
    };
    let ranges: Option<Vec<[f64; 2]>> = joint_order(robot).into_iter().map(range).collect();
    ranges.unwrap_or_default()
}

/// What was skipped or assumed: in the program, in the cut, in the record.
fn notes(analysis: &PathAnalysis, found: &PathResult) -> Vec<String> {
    let mut notes = program::notes(analysis);
    notes.extend(cut::notes(analysis, found));
    if found.along.backlash_geometry.is_some() && found.limits.is_some() {
        notes.push(
            "the process limits (limits) are computed for the load alone: backlash and geometry are additional"
                .to_owned(),
        );
    }
    if found.motion.is_some() && found.limits.is_some() {
        notes.push(
            "the process limits (limits) are computed for the load at the programmed feed alone: rounded corners and joints that follow late are additional"
                .to_owned(),
        );
    }
    if let Some(motion) = analysis
        .setting
        .motion
        .as_ref()
        .filter(|motion| !motion.assumed.is_empty())
    {
        notes.push(format!(
            "assumed of the controller: {}",
            motion.assumed.join("; ")
        ));
    }
    notes.extend(analysis.measured.as_deref().into_iter().flat_map(measured::notes));
    notes
}
