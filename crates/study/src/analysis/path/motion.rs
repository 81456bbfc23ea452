//! The motion along a path: what the controller makes of it, and the cut at the feed that is reached.

use armill_core::kernel::Answers;
use armill_core::load::PathLoad;
use armill_core::map::{AlongPath, ObstacleKind, along_postures, obstacles};
use armill_core::motion::along::Postures;
use armill_core::motion::{Motion, motion_along};
use armill_core::nalgebra::Point3;
use armill_core::path::Track;
use armill_core::robot::forward::forward;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::SearchResult;
use crate::analysis::runner::Runner;
use crate::error::StudyError;
use crate::input::motion::MotionSetting;
use crate::input::setting::Setting;

/// Where a path without any feed gets one.
pub const FEED_HINT: &str = "motion.feed_mm_per_min gives the feed of cuts for which the program states none";

impl Runner<'_> {
    /// The motion along `track` in the postures of `along`, which then has the forces at the feed that is reached and the displacement by the motion; `load` is the
    /// load at the programmed feed. `None` where the study does not ask for it.
    pub fn move_along(
        &self,
        analysis: &PathAnalysis,
        track: &Track,
        load: &PathLoad,
        along: &mut AlongPath,
    ) -> Result<Option<Motion>, StudyError> {
        let Some(setting) = &analysis.setting.motion else {
            return Ok(None);
        };
        let motion = self.motion_of(analysis, setting, track, &along.answers)?;
        if let PathLoad::Cuts(cuts) = track.leaning_load(load.clone()) {
            let factors: Vec<f64> = (motion.speeds.iter().zip(&motion.feeds))
                .map(|(speed, feed)| (speed / feed).min(1.0))
                .collect();
            let slower = PathLoad::Cuts(cuts.at_feeds(&factors));
            let question = self.question(&analysis.setting);
            *along = along_postures(&question, track, slower, along.choices.clone(), self.watch)?;
            self.keep_clear_of_stock(analysis, along)?;
        }
        along.add_motion(track, &motion);
        Ok(Some(motion))
    }

    /// The same along the path that is not followed; `load` is that without the search.
    pub fn move_along_other(
        &self,
        analysis: &PathAnalysis,
        load: &PathLoad,
        searched: &mut SearchResult,
    ) -> Result<(), StudyError> {
        let other = &mut searched.other;
        searched.other_motion = if searched.applied {
            self.move_along(analysis, &analysis.track, load, other)?
        } else {
            let turned = searched.posture.turned(&analysis.track);
            self.move_along(analysis, &turned, &searched.posture.load(load), other)?
        };
        Ok(())
    }

    fn motion_of(
        &self,
        analysis: &PathAnalysis,
        setting: &MotionSetting,
        track: &Track,
        answers: &Answers,
    ) -> Result<Motion, StudyError> {
        // A circle ends where it began.
        let closed = analysis.shape().filter(|shape| shape.is_closed());
        let closed_track = closed.map(|shape| track.closed(shape.length()));
        let track = closed_track.as_ref().unwrap_or(track);
        let count = answers.points.len();
        let mut positions = answers.joints.clone();
        if closed.is_some() {
            positions.extend_from_slice(answers.joints_at(0));
        }
        let points: Vec<Point3<f64>> = (0..track.len())
            .map(|index| track.stop(index).base_from_tool.translation.vector.into())
            .collect();
        let jumps: Vec<usize> = obstacles(self.robot, &track.path, answers, 0.0)
            .filter(|obstacle| matches!(obstacle.kind, ObstacleKind::Jump { .. }))
            .map(|obstacle| obstacle.index)
            .collect();
        let tip = |q: &[f64]| tip(self, &analysis.setting, q);
        let postures = Postures {
            path: &track.path,
            points: &points,
            positions: &positions,
            has_posture: &|index| answers.points[index % count].is_ok(),
            jumps: &|index| jumps.binary_search(&index).is_ok(),
            tip: &tip,
        };
        let feed = setting
            .model
            .feed
            .or(analysis.cut.as_ref().and_then(|cut| cut.cutting.feed));
        let model = armill_core::motion::MotionModel {
            feed,
            ..setting.model.clone()
        };
        let found = motion_along(&postures, &model);
        let mut motion =
            found.map_err(|error| StudyError::value(format!("{}: {error}", analysis.shown()), FEED_HINT))?;
        motion.truncate(count);
        Ok(motion)
    }
}

/// The tip in the base at joint positions, rad (m).
fn tip(runner: &Runner<'_>, setting: &Setting, q: &[f64]) -> Point3<f64> {
    let flange = forward(runner.robot, q).base_from_flange;
    flange * Point3::from(setting.flange_from_tool.translation.vector)
}
