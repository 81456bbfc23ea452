//! A path in the answer.

use armill_core::kernel::Answers;
use armill_core::map::PathAnswer;
use serde::Serialize;

use super::point::{PointAnswer, SettingAnswer, tidy};
use super::program::ProgramResult;
use crate::file::resolve::{Setting, Study};

/// A path on a plane.
#[derive(Clone, Debug, Serialize)]
pub struct PathResult {
    /// Its name.
    pub name: String,
    /// Posture asked for: words of a branch, or `best`.
    pub branch: String,
    /// How many points.
    pub points: usize,
    /// Points without posture.
    pub unreached: usize,
    /// Points with a posture that stands outside joint limits.
    pub outside_joint_limits: usize,
    /// Largest in-plane deviation of all reached points, all cases.
    pub max_in_plane_um: Option<f64>,
    /// Least in-plane envelope along the path.
    pub min_in_plane_um: Option<f64>,
    /// Largest length of the deviation.
    pub max_full_um: Option<f64>,
    /// Points within the limit over all points.
    pub fraction_within: f64,
    /// On a circle reached everywhere: the largest roundness of all cases (peak to valley about the
    /// least-squares circle).
    pub roundness_um: Option<f64>,
    /// On a circle: each case.
    pub circle_cases: Vec<CircleCase>,
    /// The point with the largest in-plane deviation.
    pub worst: Option<PointAnswer>,
    /// What all points share.
    pub setting: SettingAnswer,
    /// Range of each joint (mm for sliding joints) along the path.
    pub joint_range_deg: Vec<[f64; 2]>,
    /// What only a tool path program has.
    pub program: Option<ProgramResult>,
}

/// What becomes of a circle under one load case.
#[derive(Clone, Debug, Serialize)]
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

pub(super) fn answer(study: &Study, name: &str, setting: &Setting, path: &PathAnswer) -> PathResult {
    let answers = &path.answers;
    let at = |index: usize| {
        path.plane
            .base_from_tool(path.samples[index].at, 0.0)
            .translation
            .vector
            .into()
    };
    let held = || answers.held().map(|(_, held)| held);
    let within = held().filter(|held| held.in_plane <= setting.limit).count();
    let points = path.samples.len();
    PathResult {
        name: name.to_owned(),
        branch: setting.branch(),
        points,
        unreached: points - held().count(),
        outside_joint_limits: held().filter(|held| !held.within_limits()).count(),
        max_in_plane_um: answers.worst().map(|(_, held)| held.in_plane * 1e6),
        min_in_plane_um: answers.best().map(|(_, held)| held.in_plane * 1e6),
        max_full_um: held().map(|held| held.full * 1e6).max_by(f64::total_cmp),
        fraction_within: within as f64 / points.max(1) as f64,
        roundness_um: path.worst_roundness().map(|roundness| roundness * 1e6),
        circle_cases: circle_cases(path),
        worst: answers
            .worst()
            .map(|(i, held)| PointAnswer::of(study, setting, answers, (i, held, at(i)))),
        setting: SettingAnswer::of(study, setting),
        joint_range_deg: joint_ranges(study, answers),
        program: None,
    }
}

fn circle_cases(path: &PathAnswer) -> Vec<CircleCase> {
    let centroid = |points: &mut dyn Iterator<Item = armill_core::nalgebra::Point2<f64>>| {
        let all: Vec<_> = points.collect();
        all.iter()
            .fold(armill_core::nalgebra::Vector2::zeros(), |sum, p| sum + p.coords)
            / all.len().max(1) as f64
    };
    let nominal = centroid(&mut path.samples.iter().map(|sample| sample.at));
    let um = |value: f64| value * 1e6;
    path.radial
        .iter()
        .enumerate()
        .map(|(case, radial)| {
            let shift = radial.roundness.centre.coords - nominal;
            CircleCase {
                case: case + 1,
                max_radial_um: um(radial.outward.iter().copied().fold(f64::MIN, f64::max)),
                min_radial_um: um(radial.outward.iter().copied().fold(f64::MAX, f64::min)),
                centre_shift_um: [um(-shift.x), um(shift.y)],
                roundness_um: um(radial.roundness.peak_to_valley),
            }
        })
        .collect()
}

/// Range of each joint, deg (mm).
pub(super) fn joint_ranges(study: &Study, answers: &Answers) -> Vec<[f64; 2]> {
    (0..answers.joint_count)
        .map(|joint| joint_range(study, answers, joint))
        .collect()
}

fn joint_range(study: &Study, answers: &Answers, joint: usize) -> [f64; 2] {
    let scale = if study.robot.robot.slides(joint) {
        1e3
    } else {
        1f64.to_degrees()
    };
    let positions = answers
        .held()
        .map(|(index, _)| answers.joints_at(index)[joint] * scale);
    let (low, high) = positions.fold((f64::MAX, f64::MIN), |(low, high), q| (low.min(q), high.max(q)));
    if low > high {
        [0.0, 0.0]
    } else {
        [tidy(low), tidy(high)]
    }
}
