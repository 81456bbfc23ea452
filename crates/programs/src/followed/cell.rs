//! The cell in which a program runs, and the poses of the program's frames and tools in it.

use armill_core::frame::{Isometry, fixed_angles};
use armill_core::units::{to_deg, to_mm};

use super::angle::angle;
use super::error::FollowError;
use crate::number::fixed;
use crate::program::{Frame, Motion, RobotMove, RobotProgram, Target};

/// The cell in which a program runs. Lengths m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Flange to the tool centre point, z from the spindle to the tip.
    pub flange_from_tool: Isometry,
    /// Base to the controller's reference frame.
    pub base_from_controller: Isometry,
    /// Controller's reference frame to the frame that the program only numbers or does not define.
    pub controller_from_frame: Option<Isometry>,
    /// Base to the frame of the first target, replacing that of the program.
    pub base_from_path: Option<Isometry>,
}

/// Tips further apart than this are different, m.
const SAME_TIP: f64 = 1e-5;
/// A rotation between tools above this value is reported, rad: 0.01 deg.
const SAME_TURN: f64 = 1.75e-4;

/// Poses of the frames and tools of a program.
pub(super) struct Placed {
    /// Base to the frame of the first target.
    pub base_from_path: Isometry,
    flange_from_tool: Isometry,
    base_from_controller: Isometry,
    controller_from_frame: Option<Isometry>,
    /// Frame of the first target, and its line.
    first: Option<(Frame, u32)>,
    /// Pose of that frame given by the cell.
    replaced: Option<Isometry>,
    /// Numbers of tools that are assumed to be the cell's tool; `None` for a tool without number.
    taken: Vec<Option<u32>>,
    /// Largest rotation between the axes of the program's tool and the cell's tool, rad.
    turned: f64,
}

impl Cell {
    /// The poses of the frames of `program`.
    ///
    /// # Errors
    /// Frames that neither the program nor the cell defines, or both define; cuts with another tip.
    pub(super) fn placed(&self, program: &RobotProgram) -> Result<Placed, Vec<FollowError>> {
        let poses = || program.moves.iter().filter(|given| has_pose(given));
        // Rapid moves may begin at a home position in another frame: cutting moves decide.
        let first = poses()
            .find(|given| given.motion != Motion::Joint)
            .or_else(|| poses().next());
        let mut known: Vec<(Frame, u32)> = Vec::new();
        for given in first.into_iter().chain(poses()) {
            if !known.iter().any(|(frame, _)| *frame == given.frame) {
                known.push((given.frame, given.line));
            }
        }
        let mut errors = self.undefined_frames(&known);
        let mut placed = Placed {
            base_from_path: self.base_from_controller,
            flange_from_tool: self.flange_from_tool,
            base_from_controller: self.base_from_controller,
            controller_from_frame: self.controller_from_frame,
            first: known.first().copied(),
            replaced: self.base_from_path,
            taken: Vec::new(),
            turned: 0.0,
        };
        let mut tips: Vec<Frame> = Vec::new();
        for given in poses() {
            if !tips.contains(&given.tool) {
                match placed.tcp_from_tool(given) {
                    Ok(between) => placed.record_tool(given, &between),
                    Err(error) => errors.push(error),
                }
                if given.motion != Motion::Joint {
                    tips.push(given.tool);
                }
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        if let Some(first) = first {
            placed.base_from_path = placed.base_from_frame(first);
        }
        Ok(placed)
    }

    /// Frames whose poses are not known; that of the path first.
    fn undefined_frames(&self, frames: &[(Frame, u32)]) -> Vec<FollowError> {
        let Some((first, first_line)) = frames.first().copied() else {
            return Vec::new();
        };
        let mut open = frames
            .iter()
            .filter(|(frame, _)| !matches!(frame, Frame::Given(_)));
        let several = |other: &(Frame, u32), line: u32| FollowError::Several {
            lines: [line, other.1],
        };
        if self.base_from_path.is_some() {
            let others = open.filter(|(frame, _)| *frame != first);
            return others.map(|other| several(other, first_line)).collect();
        }
        if self.controller_from_frame.is_some() {
            return match open.next() {
                None => vec![FollowError::FrameGivenTwice { line: first_line }],
                Some((_, line)) => open.map(|other| several(other, *line)).collect(),
            };
        }
        open.map(|(frame, line)| match frame {
            Frame::Numbered(number) => FollowError::Numbered {
                line: *line,
                number: *number,
            },
            _ => FollowError::UnknownFrame { line: *line },
        })
        .collect()
    }
}

impl Placed {
    /// Base to the frame of the targets of this move.
    pub fn base_from_frame(&self, given: &RobotMove) -> Isometry {
        let by_program = |frame: &Frame| match frame {
            Frame::Given(frame) => self.base_from_controller * frame,
            Frame::Numbered(_) | Frame::Unknown => {
                self.base_from_controller * self.controller_from_frame.unwrap_or_else(Isometry::identity)
            }
        };
        let (Some(base_from_first), Some((first, _))) = (self.replaced, self.first) else {
            return by_program(&given.frame);
        };
        match (first, given.frame) {
            (first, frame) if first == frame => base_from_first,
            // Other frames move with it.
            (Frame::Given(_), frame) => base_from_first * by_program(&first).inverse() * by_program(&frame),
            (_, frame) => by_program(&frame),
        }
    }

    /// The program's tool at this move to the cell's.
    ///
    /// # Errors
    /// A cut with another tip.
    pub fn tcp_from_tool(&self, given: &RobotMove) -> Result<Isometry, FollowError> {
        let Frame::Given(flange_from_tcp) = given.tool else {
            return Ok(Isometry::identity());
        };
        let between = flange_from_tcp.inverse() * self.flange_from_tool;
        let apart = between.translation.vector.norm();
        if given.motion == Motion::Joint || apart <= SAME_TIP {
            return Ok(between);
        }
        let [x, y, z, rx, ry, rz] = mm_deg(&flange_from_tcp);
        Err(FollowError::Tip {
            line: given.line,
            tip_mm: format!("{x}, {y}, {z}"),
            apart_mm: to_mm(apart),
            tool_mm_deg: format!("[{x}, {y}, {z}, {rx}, {ry}, {rz}]"),
        })
    }

    /// Records the tool of a cut for the notes.
    fn record_tool(&mut self, given: &RobotMove, between: &Isometry) {
        if given.motion == Motion::Joint {
            return;
        }
        match given.tool {
            Frame::Given(_) => {
                let turned = angle(&between.rotation, &Isometry::identity().rotation);
                self.turned = self.turned.max(turned);
            }
            Frame::Numbered(number) => self.taken.push(Some(number)),
            Frame::Unknown => self.taken.push(None),
        }
    }

    /// What a user must know of frames and tools, each a sentence.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if let (Some((Frame::Given(frame), line)), None) = (self.first, self.replaced) {
            let numbers = mm_deg(&frame).join(", ");
            notes.push(format!(
                "line {line}: the program defines its frame ({numbers} mm, deg, in the reference frame of the \
                 controller); the plane of the study does not change it"
            ));
        }
        for number in &self.taken {
            notes.push(match number {
                Some(number) => format!("tool {number} of the controller is assumed to be the study's tool"),
                None => "the program defines no tool: the study's tool is used".to_owned(),
            });
        }
        if self.turned > SAME_TURN {
            notes.push(format!(
                "the axes of the program's tool are rotated by {:.2} deg relative to those of the study's tool, whose \
                 z is the tool direction",
                to_deg(self.turned)
            ));
        }
        notes
    }
}

/// Whether a target or via point of this move is given as a pose.
fn has_pose(given: &RobotMove) -> bool {
    let via = match &given.motion {
        Motion::Circular { via } => via.pose(),
        Motion::Joint | Motion::Linear => None,
    };
    let Target::Pose { .. } = &given.target else {
        return via.is_some();
    };
    true
}

/// Decimals of a frame or tool in messages, mm and deg.
const DECIMALS: usize = 3;

/// x, y, z in mm and rotations about fixed x, y, z in deg.
fn mm_deg(pose: &Isometry) -> [String; 6] {
    let at = to_mm(pose.translation.vector);
    let turned = fixed_angles(&pose.rotation).map(to_deg);
    [at.x, at.y, at.z, turned.x, turned.y, turned.z].map(|value| {
        let said = fixed(value, DECIMALS);
        let short = said.trim_end_matches('0').trim_end_matches('.');
        short.to_owned()
    })
}
