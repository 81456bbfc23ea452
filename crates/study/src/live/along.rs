//! How does the answer hold the tool at a point of a path, or at a hole, and what pushes there?
//!
//! | what the answer found on its way | how far it counts |
//! |---|---|
//! | turns of the tool that a search found | for every posture |
//! | forces of a cut, at rest with the tool that they push away in the posture followed | for every posture |
//! | where joints to spare stand | for every posture |
//! | backlash and geometry | for the posture followed alone: others would have come there otherwise |
//!
//! A path that was not done yet is followed first.

use armill_core::kernel::Answers;
use armill_core::load::PathLoad;
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::optimize::holes_held;
use armill_core::path::Track;
use armill_core::watch::Watch;

use super::posture::{Asked, is_same};
use crate::error::StudyError;
use crate::file::holes::HolesAnalysis;
use crate::file::path::PathAnalysis;
use crate::file::resolve::Study;
use crate::pose::At;
use crate::run::{Done, Found, runner};

/// How the answer holds the tool at a point.
pub(super) struct Held {
    /// Joint positions (rad, m); none where the arm does not come there.
    pub joints: Option<Vec<f64>>,
    /// Where friction dragged the links in their gaps, rad (m), one a joint; none without backlash and geometry, and off paths.
    pub dragged: Option<Vec<f64>>,
}

impl Held {
    /// Where the links of this posture (rad, m) are dragged to in their gaps: known of the one that a path is followed in.
    pub fn dragged_in(&self, q: &[f64]) -> Option<&[f64]> {
        let joints = self.joints.as_ref()?;
        self.dragged.as_deref().filter(|_| is_same(joints, q))
    }
}

/// Point `index` of a path of this study, which may have been done; there is such a point.
pub(super) fn on_path(
    (study, path): (&Study, &PathAnalysis),
    index: usize,
    done: Option<&Done<'_>>,
    watch: Watch<'_>,
) -> Result<Asked, StudyError> {
    let of_now;
    let (along, searched) = match done.map(|done| &done.found) {
        Some(Found::Path(_, found)) => (&found.along, found.searched.as_ref()),
        _ => {
            let runner = runner(study, watch)?;
            let (load, _) = runner.pushed(path)?;
            of_now = runner.follow(path, load)?;
            (&of_now.along, of_now.searched.as_ref())
        }
    };
    let answers = &along.answers;
    let unloaded = along.unloaded.as_ref();
    let evaluation = Held {
        joints: joints_at(answers, index),
        dragged: unloaded.map(|unloaded| unloaded.dragged_at(index, answers.joint_count).to_vec()),
    };
    let spin = searched.map_or(0.0, |searched| searched.posture.spins[index]);
    Ok(turned((&path.track, &along.load), index, spin, evaluation))
}

/// Hole `index` of this study, whose holes may have been done; there is such a hole.
pub(super) fn at_hole(
    (study, holes): (&Study, &HolesAnalysis),
    index: usize,
    done: Option<&Done<'_>>,
    watch: Watch<'_>,
) -> Result<Asked, StudyError> {
    let of = (&holes.path.track, &holes.path.load);
    let of_now;
    let found = match done.map(|done| &done.found) {
        Some(Found::Holes(_, found)) => found.as_ref(),
        _ => {
            let runner = runner(study, watch)?;
            of_now = holes_held(&runner.question(&holes.path.setting), of, &holes.search, watch)?;
            &of_now
        }
    };
    let evaluation = Held {
        joints: joints_at(&found.answers, index),
        dragged: None,
    };
    Ok(turned(of, index, found.spins[index], evaluation))
}

/// A point of this track with the tool turned about its axis by `spin` (rad) more.
fn turned((track, load): (&Track, &PathLoad), index: usize, spin: f64, evaluation: Held) -> Asked {
    let here = track.loaded_stop(index, load);
    let spin = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), spin);
    Asked {
        at: At::Pose(here.stop.base_from_tool * spin),
        normal: here.stop.normal,
        cases: here.cases,
        evaluation: Some(evaluation),
    }
}

/// Joint positions (rad, m) of the answer at this point; none where the arm does not come there.
fn joints_at(answers: &Answers, index: usize) -> Option<Vec<f64>> {
    let joints = || answers.joints_at(index).to_vec();
    answers.points[index].is_ok().then(joints)
}
