//! The pose of the tool and the load at a point of a path, or at a hole, as in the answer.
//!
//! | result of the answer | valid for |
//! |---|---|
//! | spins of the tool that a search found | every posture |
//! | forces of a cut, in equilibrium with the deflection of the posture followed | every posture |
//! | positions of redundant joints | every posture |
//! | backlash, geometry and motion | the posture followed alone: they depend on the way before |
//!
//! A path that was not evaluated yet is followed first.

use std::f64::consts::{PI, TAU};

use armill_core::kernel::{Answers, OnPath, Question, evaluate};
use armill_core::load::PathLoad;
use armill_core::nalgebra::{Unit, UnitQuaternion, Vector3};
use armill_core::optimize::hole_postures;
use armill_core::path::{LoadedTrack, Track};
use armill_core::robot::Robot;
use armill_core::source::MotionDisplacement;
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;

use crate::analysis::holes::HolesAnalysis;
use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::analysis::runner::Runner;
use crate::analysis::{AnalysisData, AnalysisResult};
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::input::setting::Setting;
use crate::pose::At;

/// A target of the tool in the terms of the core.
pub(super) struct ToolTarget {
    pub at: At,
    pub normal: Unit<Vector3<f64>>,
    /// Wrenches on the tool, base, one a case.
    pub cases: Vec<Wrench>,
    /// The pose of the arm there in the answer, of a path and of holes.
    pub pose: Option<AnsweredPose>,
}

/// The pose of the arm at a point in the answer.
pub(super) struct AnsweredPose {
    /// Joint positions (rad, m); none if the point is out of reach.
    pub joints: Option<Vec<f64>>,
    /// Offsets of the links within their backlash, kept there by friction, rad (m), one for each joint; none without
    /// backlash and geometry, and off paths.
    pub link_offsets: Option<Vec<f64>>,
    /// Displacement by the motion; none where the study asks for no motion, and off paths.
    pub motion: Option<MotionDisplacement>,
}

impl AnsweredPose {
    /// What the way along the path adds in this posture (rad, m): known for the posture in which the path is followed.
    pub fn on_path_in(&self, q: &[f64]) -> OnPath<'_> {
        let is_followed = self.joints.as_ref().is_some_and(|joints| is_same(joints, q));
        OnPath {
            link_offsets: self.link_offsets.as_deref().filter(|_| is_followed),
            motion: (self.motion).map(|motion| {
                if is_followed {
                    motion
                } else {
                    MotionDisplacement::default()
                }
            }),
        }
    }
}

/// Positions (rad, m) that are the same posture, whatever was computed on the way there.
const SAME_POSTURE: f64 = 1e-6;

/// Whether these positions (rad, m) are the same posture.
fn is_same(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < SAME_POSTURE)
}

/// Postures that differ by more than this are not the one of the answer, rad (m). Through a singularity of the wrist
/// joint 4 keeps its position along a path, which no posture of the single pose has exactly.
const NEAR_POSTURE: f64 = 1e-3;

/// Which of these postures (rad, m) the analysis uses at its target: the one of the answer, or, where points have no
/// influence on each other, the one that the study selects.
///
/// # Errors
/// Cancelled by the watch.
pub(super) fn answered_posture(
    robot: &Robot,
    setting: &Setting,
    target: &ToolTarget,
    postures: &[Vec<f64>],
    watch: Watch<'_>,
) -> Result<Option<usize>, StudyError> {
    let own;
    let joints = match (&target.pose, &target.at) {
        (Some(pose), _) => pose.joints.as_deref(),
        (None, At::Pose(base_from_tool)) if robot.compliance().is_some() && !target.cases.is_empty() => {
            let runner = Runner::new(robot, watch)?;
            let question = Question {
                cases: &target.cases,
                normal: target.normal,
                ..runner.question(setting)
            };
            own = evaluate(&question, 1, |_| *base_from_tool, watch)?;
            own.points[0].is_ok().then(|| own.joints_at(0))
        }
        _ => None,
    };
    let Some(joints) = joints else { return Ok(None) };
    let apart = |q: &Vec<f64>| {
        let of = |(i, (a, b)): (usize, (&f64, &f64))| match robot.slides(i) {
            true => (a - b).abs(),
            // Whole turns are the same posture.
            false => ((a - b + PI).rem_euclid(TAU) - PI).abs(),
        };
        q.iter().zip(joints).enumerate().map(of).fold(0.0, f64::max)
    };
    let near = postures
        .iter()
        .map(apart)
        .enumerate()
        .min_by(|a, b| a.1.total_cmp(&b.1));
    Ok(near
        .filter(|(_, apart)| *apart < NEAR_POSTURE)
        .map(|(index, _)| index))
}

/// Point `index` of a path of this study, which may have been evaluated; the point must exist.
pub(super) fn on_path(
    study: &Study,
    path: &PathAnalysis,
    index: usize,
    done: Option<&AnalysisResult<'_>>,
    watch: Watch<'_>,
) -> Result<ToolTarget, StudyError> {
    followed(study, path, done, watch, |found, track| {
        let along = &found.along;
        let answers = &along.answers;
        let unloaded = along.backlash_geometry.as_ref();
        let pose = AnsweredPose {
            joints: joints_at(answers, index),
            link_offsets: unloaded
                .map(|unloaded| unloaded.link_offsets_at(index, answers.joint_count).to_vec()),
            motion: path.setting.motion_displacement(found.motion.as_ref(), index),
        };
        turned(track, &along.load, index, 0.0, pose)
    })
}

/// What `work` gives of this path, which may have been evaluated, and of the track on which it is followed.
pub(super) fn followed<T>(
    study: &Study,
    path: &PathAnalysis,
    done: Option<&AnalysisResult<'_>>,
    watch: Watch<'_>,
    work: impl FnOnce(&PathResult, &Track) -> T,
) -> Result<T, StudyError> {
    let of_now;
    let found = match done.map(|done| &done.found) {
        Some(AnalysisData::Path(_, found)) => found,
        _ => {
            of_now = Runner::new(&study.robot.robot, watch)?.path(path)?;
            &of_now
        }
    };
    let searched = found.searched.as_ref().filter(|searched| searched.applied);
    let track = searched.map(|searched| searched.posture.turned(&path.track));
    Ok(work(found, track.as_ref().unwrap_or(&path.track)))
}

/// Hole `index` of this study, whose holes may have been evaluated; the hole must exist.
pub(super) fn at_hole(
    study: &Study,
    holes: &HolesAnalysis,
    index: usize,
    done: Option<&AnalysisResult<'_>>,
    watch: Watch<'_>,
) -> Result<ToolTarget, StudyError> {
    let (track, load) = (&holes.path.track, &holes.path.load);
    let of_now;
    let found = match done.map(|done| &done.found) {
        Some(AnalysisData::Holes(_, found)) => found.as_ref(),
        _ => {
            let runner = Runner::new(&study.robot.robot, watch)?;
            let question = runner.question(&holes.path.setting);
            of_now = hole_postures(
                &question,
                LoadedTrack { track, load },
                &holes.search,
                &holes.path.setting.least_gain,
                watch,
            )?;
            &of_now
        }
    };
    let pose = AnsweredPose {
        joints: joints_at(&found.answers, index),
        link_offsets: None,
        motion: None,
    };
    Ok(turned(track, load, index, found.spins[index], pose))
}

/// A point of this track with the tool turned about its axis by a further `spin` (rad).
fn turned(track: &Track, load: &PathLoad, index: usize, spin: f64, pose: AnsweredPose) -> ToolTarget {
    let here = track.loaded_stop(index, load);
    let spin = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), spin);
    ToolTarget {
        at: At::Pose(here.stop.base_from_tool * spin),
        normal: here.stop.normal,
        cases: here.cases,
        pose: Some(pose),
    }
}

/// Joint positions (rad, m) of the answer at this point; none if it is out of reach.
fn joints_at(answers: &Answers, index: usize) -> Option<Vec<f64>> {
    let joints = || answers.joints_at(index).to_vec();
    answers.points[index].is_ok().then(joints)
}
