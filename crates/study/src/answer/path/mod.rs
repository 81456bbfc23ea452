//! A path in the answer: how far the tool deviates along it, where and why, and what became of what it makes.
//!
//! | part of the deviation | meaning |
//! |---|---|
//! | in-plane | across the tool, of a shape in its plane: the largest of all cases, what the limit is held against |
//! | along, cross | its parts forwards on the track and to the left of it: what is hardly seen, and what walls get |
//! | axial | along the tool, from the part towards the spindle: what floors get |
//!
//! `worst`: where it is worst; `feature`: circles, lines, planes, holes; `cut`, `measured`: what pushes; `limits`: what
//! keeps the tolerance; `program`: what a program tells of it; `search`: what a search for turns of the tool and branches brought;
//! `unloaded`: what backlash and geometry make of it.

mod cut;
mod feature;
pub(crate) mod limits;
mod measured;
mod program;
pub(crate) mod search;
mod unloaded;
mod worst;

pub use cut::{CutAnswer, RestAnswer, StockAnswer};
pub use feature::FeatureAnswer;
pub use limits::{LimitAnswer, LimitsAnswer};
pub use measured::MeasuredAnswer;
pub use program::{OperationAnswer, ProgramAnswer};
pub use search::{SearchAnswer, StatisticsAnswer};
pub use unloaded::UnloadedAnswer;
pub use worst::WorstPoint;

use armill_core::kernel::Answers;
use armill_core::map::AlongPath;
use schemars::JsonSchema;
use serde::Serialize;

use super::point::{PointAnswer, SettingAnswer};
use crate::file::path::PathAnalysis;
use crate::file::resolve::{Setting, Study};
use crate::number::without_rounding;
use crate::run::{MOST_JUMPS, PathFound};

/// A path.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PathAnswer {
    /// Its name.
    pub name: String,
    /// Posture asked for: words of a branch, or `best`.
    pub branch: String,
    /// Branch in which the whole path is followed; none of an arm whose branches have no names.
    pub followed_branch: Option<String>,
    /// How many points.
    pub points: usize,
    /// Points without posture.
    pub unreachable: usize,
    /// Points with a posture that stands outside joint limits.
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
    /// Largest deviation across the track, by size: what walls get.
    pub max_cross_um: Option<f64>,
    /// Largest deviation along the tool, by size: what floors get.
    pub max_axial_um: Option<f64>,
    /// Points within the limit over all points.
    pub fraction_within: f64,
    /// Of circles reached everywhere, the path itself or its features: the largest roundness of all cases (peak to
    /// valley about the least-squares circle).
    pub roundness_um: Option<f64>,
    /// On a circle: each case.
    pub circle_cases: Vec<CircleCase>,
    /// What became of the features asked for.
    pub features: Vec<FeatureAnswer>,
    /// The point with the largest in-plane deviation.
    pub worst: Option<PointAnswer>,
    /// Where it is worst, each from another part of the path.
    pub worst_points: Vec<WorstPoint>,
    /// Where a joint jumps from one point to the next.
    pub jumps: Vec<String>,
    /// What all points share.
    pub setting: SettingAnswer,
    /// Range of each joint (mm for sliding joints) along the path; empty where no point is reached.
    pub joint_range_deg: Vec<[f64; 2]>,
    /// What cuts or drills, where the forces were computed from it.
    pub cut: Option<CutAnswer>,
    /// The record that the forces come from; none where they were not measured.
    pub measured: Option<MeasuredAnswer>,
    /// What keeps the tolerance everywhere.
    pub limits: Option<LimitsAnswer>,
    /// The program that tells the path; none of a shape.
    pub program: Option<ProgramAnswer>,
    /// Turns of the tool and branches that were searched for; none where nothing was.
    pub search: Option<SearchAnswer>,
    /// What backlash and geometry make of the deviations; none where load and gravity alone move the tool.
    pub unloaded: Option<UnloadedAnswer>,
    /// What was passed over, or taken for granted.
    pub notes: Vec<String>,
}

/// What becomes of a circle under one load case.
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

/// What became of the path that the ask called `name` asks for.
pub(super) fn answer(study: &Study, name: &str, analysis: &PathAnalysis, found: &PathFound) -> PathAnswer {
    let (setting, answers) = (&analysis.setting, &found.along.answers);
    let evaluation = || answers.evaluation().map(|(_, evaluation)| evaluation);
    let points = answers.points.len();
    let within = evaluation().filter(|evaluation| evaluation.in_plane <= setting.limit).count();
    let features = feature::features(analysis, found);
    let of_features = features.iter().filter_map(|feature| feature.roundness_um);
    let of_cases = found
        .radial
        .iter()
        .map(|radial| radial.roundness.peak_to_valley * 1e6);
    let worst_points = worst::worst_points(study, analysis, found);
    let [along, cross, axial] = largest_parts(analysis, found);
    PathAnswer {
        name: name.to_owned(),
        branch: setting.branch(),
        followed_branch: followed(study, &found.along, setting),
        points,
        unreachable: points - evaluation().count(),
        outside_joint_limits: evaluation().filter(|evaluation| !evaluation.within_limits()).count(),
        length_mm: analysis.length() * 1e3,
        max_in_plane_um: answers.worst().map(|(_, evaluation)| evaluation.in_plane * 1e6),
        min_in_plane_um: answers.best().map(|(_, evaluation)| evaluation.in_plane * 1e6),
        max_full_um: evaluation().map(|evaluation| evaluation.full * 1e6).max_by(f64::total_cmp),
        max_along_um: along,
        max_cross_um: cross,
        max_axial_um: axial,
        fraction_within: within as f64 / points.max(1) as f64,
        roundness_um: of_cases.chain(of_features).max_by(f64::total_cmp),
        circle_cases: circle_cases(found),
        worst: worst_points.first().map(|worst| worst.point.clone()),
        jumps: jumps(study, analysis, found),
        setting: SettingAnswer::of(study, setting),
        joint_range_deg: joint_ranges(study, answers),
        cut: CutAnswer::of(analysis, found),
        measured: analysis.measured.as_deref().map(MeasuredAnswer::of),
        limits: LimitsAnswer::of(analysis, found),
        program: ProgramAnswer::of(analysis, found),
        search: SearchAnswer::of(analysis, found),
        unloaded: UnloadedAnswer::of(study, analysis, found),
        notes: notes(analysis, found),
        worst_points,
        features,
    }
}

/// The branch of the whole path, if its robot has names for them.
fn followed(study: &Study, along: &AlongPath, setting: &Setting) -> Option<String> {
    if !study.robot.robot.inverse().has_branches() {
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
fn largest_parts(analysis: &PathAnalysis, found: &PathFound) -> [Option<f64>; 3] {
    let answers = &found.along.answers;
    let mut largest: Option<[f64; 3]> = None;
    for (index, _) in answers.evaluation() {
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
    std::array::from_fn(|i| largest.map(|largest| largest[i] * 1e6))
}

/// Each case of a circle that is a shape; none of other paths, nor of a circle that is not reached everywhere.
fn circle_cases(found: &PathFound) -> Vec<CircleCase> {
    let um = |value: f64| value * 1e6;
    let of_case = |(case, radial): (usize, &armill_core::map::RadialDeviation)| CircleCase {
        case: case + 1,
        max_radial_um: um(radial.outward.iter().copied().fold(f64::MIN, f64::max)),
        min_radial_um: um(radial.outward.iter().copied().fold(f64::MAX, f64::min)),
        centre_shift_um: [um(-radial.centre_shift.x), um(radial.centre_shift.y)],
        roundness_um: um(radial.roundness.peak_to_valley),
    };
    found.radial.iter().enumerate().map(of_case).collect()
}

/// Joints that jump between points next to each other on the path, in sentences.
fn jumps(study: &Study, analysis: &PathAnalysis, found: &PathFound) -> Vec<String> {
    let joints = study.robot.robot.joints();
    let given = found.jumps.iter().take(MOST_JUMPS).map(|jump| {
        format!(
            "joint {} turns by {:.0} deg at once in line {}",
            joints[jump.joint].name,
            jump.by.to_degrees(),
            analysis.track.path.points[jump.index].line
        )
    });
    // One more was looked for than is told.
    let more = (found.jumps.len() > MOST_JUMPS).then(|| "more jumps follow".to_owned());
    given.chain(more).collect()
}

/// Range of each joint, deg (mm); empty where no point is reached.
fn joint_ranges(study: &Study, answers: &Answers) -> Vec<[f64; 2]> {
    let range = |joint: usize| {
        let slides = study.robot.robot.slides(joint);
        let scale = if slides { 1e3 } else { 1f64.to_degrees() };
        let positions = answers
            .evaluation()
            .map(|(index, _)| answers.joints_at(index)[joint] * scale);
        let [low, high] = positions.fold([f64::MAX, f64::MIN], |[low, high], q| [low.min(q), high.max(q)]);
        (low <= high).then(|| [without_rounding(low), without_rounding(high)])
    };
    let ranges: Option<Vec<[f64; 2]>> = (0..answers.joint_count).map(range).collect();
    ranges.unwrap_or_default()
}

/// What was passed over or taken for granted: in the program, in the cut, in the record.
fn notes(analysis: &PathAnalysis, found: &PathFound) -> Vec<String> {
    let mut notes = program::notes(analysis);
    notes.extend(cut::notes(analysis, found));
    if found.along.unloaded.is_some() && found.limits.is_some() {
        notes.push(
            "what keeps the tolerance (limits) is told of the load alone: backlash and geometry come on top"
                .to_owned(),
        );
    }
    notes.extend(analysis.measured.as_deref().into_iter().flat_map(measured::notes));
    notes
}
