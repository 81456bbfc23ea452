//! A path of a study as a robot program: its points, and the approach and retract moves.
//!
//! ```text
//! joint move to a position above the first point -> linear down at the feed -> the cut, in fewer points -> linear up
//! ```
//!
//! for each stretch that is cut without a rapid. Targets are relative to the frame of the path: for a part placed
//! elsewhere the frame is taught, and the program is not changed; compensation is only valid where it was computed. The
//! frame is given relative to that of the controller (frame `controller` of the robot file, else `base_link`).
//! Rapids of the source program are replaced: the tool retracts along its axis and moves to the next cut by joint
//! moves.

use std::f64::consts::TAU;
use std::ops::Range;

use armill_core::frame::Isometry;
use armill_core::kernel::Answers;
use armill_core::nalgebra::Translation3;
use armill_core::path::{Pace, Thinning, Track, thinned};
use armill_core::robot::inverse::{ToolAt, postures};
use armill_core::units::to_mm;
use armill_programs::{Draft, DraftPoint, Language, Written, write};

use crate::analysis::path::answer::obstacles;
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::input::setting::Setting;
use crate::naming::base_from_controller;

/// How the program is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramSettings {
    /// In which language.
    pub language: Language,
    /// What it is called.
    pub name: String,
    /// Number of the user frame on the controller.
    pub frame_number: u32,
    /// Number of the tool on the controller.
    pub tool_number: u32,
    /// Greatest distance of linear moves between its points from the path, m.
    pub within: f64,
    /// Height above the part at which each cut begins and ends, m.
    pub retract: f64,
    /// Blending distance at a point, m.
    pub blend: f64,
    /// Feed if the path does not specify it, m/s.
    pub feed: Option<f64>,
}

/// Orientations between two points may differ by this from the path, rad: the lean of a cutter by a minute of arc.
const TURN: f64 = 3e-4;

/// The program along `track`, whose postures are in `answers`.
///
/// # Errors
/// An obstacle on the path (no posture, joint limits, a jump, the speed of a joint); a point above a cut that is out of reach; a path without feed
/// if none is given; data that the language cannot express.
pub fn program(
    study: &Study,
    setting: &Setting,
    track: &Track,
    answers: &Answers,
    requested: &ProgramSettings,
) -> Result<Written, StudyError> {
    let maker = Maker {
        study,
        setting,
        track,
        answers,
        requested,
    };
    maker.check()?;
    let mut points = Vec::new();
    for stretch in track.path.stretches() {
        maker.stretch(stretch, &mut points)?;
    }
    let draft = Draft {
        name: requested.name.clone(),
        remarks: vec![
            format!("armill {}: {}", env!("CARGO_PKG_VERSION"), study.title),
            format!("robot {}", study.robot.robot.name()),
        ],
        base_from_frame: base_from_controller(&study.robot.robot).inverse() * track.placing.base_from_path,
        frame_number: requested.frame_number,
        flange_from_tool: setting.flange_from_tool,
        tool_number: requested.tool_number,
        points,
    };
    write(requested.language, &draft).map_err(|error| StudyError::value(error.to_string(), HINT))
}

/// What to do where a language refuses a program.
const HINT: &str =
    "the name of the file is that of the program; see `armill compensate --help` for frame and tool";

/// Input of a program.
struct Maker<'a> {
    study: &'a Study,
    setting: &'a Setting,
    track: &'a Track,
    answers: &'a Answers,
    requested: &'a ProgramSettings,
}

impl Maker<'_> {
    /// Above, down, along, and up again.
    fn stretch(&self, stretch: Range<usize>, points: &mut Vec<DraftPoint>) -> Result<(), StudyError> {
        let (first, last) = (stretch.start, stretch.end - 1);
        let begin = DraftPoint {
            speed: None,
            blend: 0.0,
            ..self.above(first)?
        };
        points.push(begin);
        for index in self.kept(stretch) {
            let at_end = index == first || index == last;
            points.push(DraftPoint {
                frame_from_tool: self.frame_from_tool(index),
                joints: self.answers.joints_at(index).to_vec(),
                branch: self.branch(index),
                speed: Some(self.feed(index)?),
                // A cut begins and ends at its nominal points.
                blend: if at_end { 0.0 } else { self.requested.blend },
            });
        }
        points.push(self.above(last)?);
        Ok(())
    }

    /// Sufficient points of a stretch: where the feed changes, and as many as the tolerance of the path needs.
    fn kept(&self, stretch: Range<usize>) -> Vec<usize> {
        let points = &self.track.path.points;
        let within = Thinning {
            place: self.requested.within,
            turn: TURN,
        };
        let changes = (stretch.start + 1..stretch.end).filter(|i| points[*i].pace != points[i - 1].pace);
        let mut ends: Vec<usize> = std::iter::once(stretch.start)
            .chain(changes.map(|i| i - 1))
            .chain([stretch.end - 1])
            .collect();
        ends.dedup();
        let mut kept = vec![stretch.start];
        for pair in ends.windows(2) {
            let part = pair[0]..pair[1] + 1;
            let poses: Vec<Isometry> = part.clone().map(|index| self.frame_from_tool(index)).collect();
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

    /// The arm must be able to follow every cut at its feed without a stop.
    fn check(&self) -> Result<(), StudyError> {
        let robot = &self.study.robot.robot;
        let all = obstacles::found(robot, &self.track.path, self.answers, 0.0);
        if all.is_empty() {
            return Ok(());
        }
        let messages: Vec<&str> = all.iter().map(|obstacle| obstacle.message.as_str()).collect();
        let slower = all.iter().all(|obstacle| obstacle.kind == "joint-speed");
        Err(StudyError::value(
            format!(
                "no program can be written, for the robot cannot follow the path: {}",
                messages.join("; ")
            ),
            match slower {
                true => "reduce the feed there, or change the posture or the placement of the part",
                false => "move the part, or let `posture.search` look for a posture",
            },
        ))
    }

    /// The place above a point, and the joints there.
    fn above(&self, index: usize) -> Result<DraftPoint, StudyError> {
        let robot = &self.study.robot.robot;
        let near = self.answers.joints_at(index);
        let lift = Translation3::new(0.0, 0.0, -self.requested.retract);
        let pose = self.track.stop(index).base_from_tool * lift;
        let tool = ToolAt {
            flange_from_tool: &self.setting.flange_from_tool,
            near: Some(near),
            home: self.setting.home.as_deref(),
        };
        let all = postures(robot, &pose, tool).unwrap_or_default();
        // In the revolutions that the joints have at the point below.
        let nearest_turn = |q: &[f64]| -> Vec<f64> {
            let turned = |(joint, (q, near)): (usize, (&f64, &f64))| match robot.slides(joint) {
                true => *q,
                false => q + TAU * ((near - q) / TAU).round(),
            };
            q.iter().zip(near).enumerate().map(turned).collect()
        };
        let away = |q: &[f64]| q.iter().zip(near).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let nearest = all
            .iter()
            .map(|posture| nearest_turn(&posture.joints))
            .filter(|joints| robot.limit_margin(joints).is_none_or(|(_, margin)| margin >= 0.0))
            .min_by(|a, b| away(a).total_cmp(&away(b)));
        let joints = nearest.filter(|joints| away(joints) < FARTHEST).ok_or_else(|| {
            let line = self.track.path.points[index].line;
            let mm = to_mm(self.requested.retract);
            let message = format!("line {line}: the robot cannot retract by {mm} mm here in its posture");
            StudyError::value(message, "a shorter --retract-mm")
        })?;
        Ok(DraftPoint {
            frame_from_tool: self.track.placing.base_from_path.inverse() * pose,
            joints,
            branch: self.branch(index),
            speed: Some(self.feed(index)?),
            blend: 0.0,
        })
    }

    fn frame_from_tool(&self, index: usize) -> Isometry {
        self.track.placing.base_from_path.inverse() * self.track.stop(index).base_from_tool
    }

    fn branch(&self, index: usize) -> Option<armill_core::robot::Branch> {
        self.answers.points[index].as_ref().ok()?.name.branch()
    }

    fn feed(&self, index: usize) -> Result<f64, StudyError> {
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

/// A joint that has to turn farther than this to go up is in another posture there, rad.
const FARTHEST: f64 = 1.0;
