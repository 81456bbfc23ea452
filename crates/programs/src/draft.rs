//! Programs to write: moves with poses, postures and speeds, the statements between them, and the definitions of frame
//! and tool.

use armill_core::frame::Isometry;
use armill_core::robot::Branch;

use crate::controller::Controller;

/// A program to write. Lengths m, angles rad, speeds m/s.
#[derive(Clone, Debug)]
pub struct Draft {
    /// Program name: a letter, then letters, digits and underscores.
    pub name: String,
    /// Remarks for its header: origin of the program.
    pub remarks: Vec<String>,
    /// From what [`Draft::frame_on`] says to the user frame of the targets.
    pub base_from_frame: Isometry,
    /// What the user frame is fixed to.
    pub frame_on: FrameOn,
    /// Flange to TCP; of a tool that stands in the cell, the controller's reference frame to it.
    pub flange_from_tool: Isometry,
    /// How the cell writes its programs.
    pub controller: Controller,
    /// For each external axis, in the order of [`DraftPoint::external`], whether it is prismatic.
    pub external_slides: Vec<bool>,
    /// Moves and statements in order; the first move is a joint move.
    pub steps: Vec<DraftStep>,
}

/// What the user frame of a program is fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameOn {
    /// The controller's reference frame: it does not move.
    Cell,
    /// The table of a positioner, which external axes move.
    Table,
    /// The flange of the robot, which holds the part; the tool stands in the cell.
    Flange,
}

/// An element of a program.
#[derive(Clone, Debug, PartialEq)]
pub enum DraftStep {
    /// A move.
    Move(DraftPoint),
    /// A comment.
    Comment(String),
    /// The program shows this message and stops until the operator continues it.
    Stop(String),
    /// The robot rests, s.
    Dwell(f64),
    /// A statement in the language of the program, written as it is: one line of ASCII characters.
    Statement(String),
}

/// A target to write.
#[derive(Clone, Debug, PartialEq)]
pub struct DraftPoint {
    /// Frame to tool.
    pub frame_from_tool: Isometry,
    /// Joint positions of the arm, rad (m for prismatic joints), as the controller reports them.
    pub joints: Vec<f64>,
    /// Positions of the external axes, rad (m for prismatic ones).
    pub external: Vec<f64>,
    /// Posture, for an arm with named postures.
    pub branch: Option<Branch>,
    /// Tip speed along a straight line, m/s; `None` for a joint move.
    pub speed: Option<f64>,
    /// Distance from the point at which the next move may begin, m; zero is an exact stop.
    pub blend: f64,
}

/// A blend that begins farther than this part of the distance to a neighbour would meet the blend of the neighbour.
pub(super) const PART_OF_WAY: f64 = 0.45;

impl Draft {
    /// The moves with their numbers, from 0.
    pub fn points(&self) -> impl Iterator<Item = &DraftPoint> {
        points(&self.steps)
    }

    /// The remarks, line by line: a line break inside a remark must not begin a statement.
    pub(super) fn remark_lines(&self) -> impl Iterator<Item = &str> {
        self.remarks.iter().flat_map(|remark| text_lines(remark))
    }

    /// The steps in parts of at most this number, each with its name: that of the program, `separator` and a number.
    /// A single part has the name of the program.
    pub(super) fn parts(&self, most: usize, separator: &str) -> impl Iterator<Item = (String, &[DraftStep])> {
        let is_split = self.steps.len() > most;
        self.steps.chunks(most).enumerate().map(move |(index, steps)| {
            let name = match is_split {
                true => format!("{}{separator}{:03}", self.name, index + 1),
                false => self.name.clone(),
            };
            (name, steps)
        })
    }

    /// All statements of the cell: its header, those among the steps, and its footer.
    pub(super) fn statements(&self) -> impl Iterator<Item = &str> {
        let steps = self.steps.iter().filter_map(|step| match step {
            DraftStep::Statement(line) => Some(line),
            _ => None,
        });
        let controller = &self.controller;
        let all = controller.header.iter().chain(steps).chain(&controller.footer);
        all.map(String::as_str)
    }

    /// Each move with its blend distance (m), at most 0.45 of the distance to each neighbour, and whether it is as
    /// large as they permit: the tool then need not slow down. The last move is an exact stop, and so is a move before
    /// a stop, a dwell or a statement of the cell. A comment does not stop the robot.
    pub(super) fn blends(&self) -> Vec<Blend> {
        let mut moves: Vec<(&DraftPoint, bool)> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            match (step, moves.last_mut()) {
                (DraftStep::Move(point), _) => moves.push((point, true)),
                (DraftStep::Comment(_), _) | (_, None) => {}
                (_, Some((_, continues))) => *continues = false,
            }
        }
        let blend = |index: usize| {
            let (point, continues) = moves[index];
            let next = moves.get(index + 1).map(|(next, _)| *next);
            let (Some(next), true) = (next, continues) else {
                return Blend::default();
            };
            let before = index.checked_sub(1).map(|before| moves[before].0);
            let way = |other: &DraftPoint| {
                let [one, other] = [point, other].map(|point| point.frame_from_tool.translation.vector);
                (one - other).norm() * PART_OF_WAY
            };
            let room = before.map_or(f64::INFINITY, way).min(way(next));
            let is_path = before.is_some() && point.speed.is_some() && next.speed.is_some();
            Blend {
                distance: point.blend.min(room),
                is_full: is_path && point.blend >= room && room > 0.0,
            }
        };
        (0..moves.len()).map(blend).collect()
    }
}

/// Approximate positioning at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Blend {
    /// Distance from the point at which the blend begins, m; zero is an exact stop.
    pub distance: f64,
    /// Whether the neighbours limit this distance, not the tolerance of the path.
    pub is_full: bool,
}

/// The moves of these steps.
pub(super) fn points(steps: &[DraftStep]) -> impl Iterator<Item = &DraftPoint> {
    steps.iter().filter_map(|step| match step {
        DraftStep::Move(point) => Some(point),
        _ => None,
    })
}

/// Lines of a text for people, without control characters.
pub(super) fn text_lines(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| c.is_control() || c == '\u{2028}' || c == '\u{2029}')
        .filter(|line| !line.is_empty())
}

/// The written files of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// File names in the program's folder, and contents.
    pub files: Vec<(String, Vec<u8>)>,
    /// Warnings to read before running it, one sentence each.
    pub notes: Vec<String>,
}

#[cfg(test)]
mod tests {
    use armill_core::nalgebra::Isometry3;

    use super::*;

    /// A move to this x, m; with a speed a straight one.
    fn to(x: f64, speed: Option<f64>) -> DraftStep {
        DraftStep::Move(DraftPoint {
            frame_from_tool: Isometry3::translation(x, 0.0, 0.0),
            joints: vec![0.0; 6],
            external: Vec::new(),
            branch: None,
            speed,
            blend: 1.0,
        })
    }

    /// The blends of these steps, m, and whether they are full.
    fn blends(steps: Vec<DraftStep>) -> Vec<(f64, bool)> {
        let draft = Draft {
            name: String::new(),
            remarks: Vec::new(),
            base_from_frame: Isometry::identity(),
            frame_on: FrameOn::Cell,
            flange_from_tool: Isometry::identity(),
            controller: Controller::default(),
            external_slides: Vec::new(),
            steps,
        };
        let all = draft.blends().into_iter();
        all.map(|blend| (blend.distance, blend.is_full)).collect()
    }

    #[test]
    fn blends_end_before_those_of_both_neighbours_and_the_approach_is_not_full() {
        let path = Some(0.1);
        let steps = vec![
            to(0.0, None),
            to(1.0, path),
            to(3.0, path),
            to(3.5, path),
            to(9.0, None),
            to(9.0, None),
        ];
        let found = blends(steps);
        let expected = [
            (0.45, false),
            (0.45, true),
            (0.225, true),
            (0.225, false),
            // The next move only turns the tool or the arm.
            (0.0, false),
            (0.0, false),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn comments_do_not_stop_the_robot_and_other_steps_do() {
        let with = |step: Option<DraftStep>| {
            let path = Some(0.1);
            let steps = [
                Some(to(0.0, None)),
                Some(to(1.0, path)),
                step,
                Some(to(2.0, path)),
            ];
            blends(steps.into_iter().flatten().collect())[1]
        };
        let text = || "text".to_owned();
        assert_eq!(with(None), (0.45, true));
        assert_eq!(with(Some(DraftStep::Comment(text()))), (0.45, true));
        for step in [
            DraftStep::Stop(text()),
            DraftStep::Dwell(0.5),
            DraftStep::Statement(text()),
        ] {
            assert_eq!(with(Some(step.clone())), (0.0, false), "{step:?}");
        }
        assert!(blends(vec![DraftStep::Comment(text()), DraftStep::Dwell(1.0)]).is_empty());
    }
}
