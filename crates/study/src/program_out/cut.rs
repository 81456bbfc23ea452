//! The points of a cut in a program: as few as the tolerance of the path needs, with approximate positioning.
//!
//! ```text
//! d = 2 e / sin(phi / 2)       a corner is rounded by a parabola that leaves it by (d / 2) sin(phi / 2) at most
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `d` | distance from the corner at which approximate positioning begins | m |
//! | `e` | permitted distance from the path | m |
//! | `phi` | angle between the directions before and after the corner | rad |
//!
//! A cut begins and ends with exact stops, and has one before each statement inside it; elsewhere there are none.

use std::ops::Range;

use armill_core::frame::Isometry;
use armill_core::kernel::Answers;
use armill_core::nalgebra::Vector3;
use armill_core::path::{Pace, Thinning, Track, thinned};
use armill_programs::DraftStep;

use super::arm::{Arm, ArmAt};
use super::settings::ProgramSettings;
use super::tooling::Tooling;
use crate::error::StudyError;

/// Orientations between two points may differ by this from the path, rad: the lean of a cutter by a minute of arc.
const TURN: f64 = 3e-4;

/// The cuts of a path.
#[derive(Clone, Copy)]
pub(super) struct Cuts<'a> {
    pub arm: Arm<'a>,
    pub track: &'a Track,
    /// The postures of its points.
    pub answers: &'a Answers,
    pub requested: &'a ProgramSettings,
}

impl Cuts<'_> {
    /// The arm at a point of the path.
    pub fn arm_at(&self, index: usize) -> ArmAt {
        let evaluation = self.answers.points[index].as_ref().ok();
        ArmAt {
            base_from_tool: self.track.stop(index).base_from_tool,
            joints: self.answers.joints_at(index).to_vec(),
            branch: evaluation.and_then(|evaluation| evaluation.name.branch()),
        }
    }

    /// Adds a stretch of cuts without rapids: its points after the first, and the statements between them.
    ///
    /// # Errors
    /// No feed is given.
    pub fn steps(
        &self,
        stretch: Range<usize>,
        tooling: &mut Tooling<'_>,
        steps: &mut Vec<DraftStep>,
    ) -> Result<(), StudyError> {
        let path = &self.track.path;
        // Statements before a point, in addition to those before the stretch.
        let inside = |point: &usize| (stretch.start + 1..stretch.end).contains(point);
        let commands = path.commands.iter().map(|placed| placed.points);
        let operations = path.operations.iter().map(|(first, _)| *first);
        let mut stops: Vec<usize> = commands.chain(operations).filter(inside).collect();
        stops.sort_unstable();
        stops.dedup();
        let kept = self.kept(stretch.clone(), &stops);
        let mut stop = stops.into_iter().peekable();
        for (at, index) in kept.iter().enumerate() {
            while let Some(before) = stop.next_if(|before| *before <= *index) {
                steps.extend(tooling.inside(path, before));
            }
            // The way to the cut ends at its first point.
            if at == 0 {
                continue;
            }
            let is_end = *index + 1 == stretch.end;
            let is_before_statement = stop.peek().is_some_and(|before| *before == index + 1);
            let blend = match is_end || is_before_statement {
                true => 0.0,
                false => self.blend(kept[at - 1], *index, kept[at + 1]),
            };
            let speed = self.feed(*index)?;
            steps.push(DraftStep::Move(self.arm.target(
                &self.arm_at(*index),
                Some(speed),
                blend,
            )));
        }
        Ok(())
    }

    /// Sufficient points of a stretch: where the feed changes, before statements, and as many as the tolerance of the
    /// path needs.
    fn kept(&self, stretch: Range<usize>, stops: &[usize]) -> Vec<usize> {
        let points = &self.track.path.points;
        let within = Thinning {
            place: self.requested.within,
            turn: TURN,
        };
        let changes = (stretch.start + 1..stretch.end).filter(|i| points[*i].pace != points[i - 1].pace);
        let mut ends: Vec<usize> = changes.chain(stops.iter().copied()).map(|i| i - 1).collect();
        ends.extend([stretch.start, stretch.end - 1]);
        ends.sort_unstable();
        ends.dedup();
        let mut kept = vec![stretch.start];
        for pair in ends.windows(2) {
            let part = pair[0]..pair[1] + 1;
            let poses: Vec<Isometry> = part
                .clone()
                .map(|index| self.track.stop(index).base_from_tool)
                .collect();
            let along: Vec<f64> = points[part].iter().map(|point| point.along).collect();
            kept.extend(
                thinned(&poses, &along, within)
                    .into_iter()
                    .skip(1)
                    .map(|i| pair[0] + i),
            );
        }
        kept
    }

    /// Distance from the point `here` at which approximate positioning begins, m.
    fn blend(&self, before: usize, here: usize, after: usize) -> f64 {
        let place = |index: usize| self.track.stop(index).base_from_tool.translation.vector;
        let direction = |from: usize, to: usize| (place(to) - place(from)).try_normalize(0.0);
        let Some((a, b)) = direction(before, here).zip(direction(here, after)) else {
            return self.requested.blend;
        };
        // |b - a| = 2 sin(phi / 2).
        let turned: Vector3<f64> = b - a;
        let rounded = 4.0 * self.requested.rounding / turned.norm();
        rounded.min(self.requested.blend)
    }

    /// The feed to a point, m/s.
    ///
    /// # Errors
    /// None is given.
    pub fn feed(&self, index: usize) -> Result<f64, StudyError> {
        let given = match self.track.path.points[index].pace {
            Pace::Feed(speed) => Some(speed),
            Pace::Rapid | Pace::Unknown => None,
        };
        given.or(self.requested.feed).ok_or_else(|| {
            let line = self.track.path.points[index].line;
            StudyError::value(
                format!("line {line}: the path has no feed"),
                "give one: --feed-mm-per-min 600",
            )
        })
    }
}
