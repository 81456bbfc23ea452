//! Moves: their targets and speeds.

use armill_core::frame::Isometry;
use armill_core::path::Passage;
use armill_core::robot::BranchPattern;

use super::expression::is_name;
use super::read::Reader;
use super::value::{Argument, Reference, Value};
use crate::messages::shown;
use crate::program::{Frame, Motion, RobotMove, Speed, Target};
use crate::tokens::Token;

/// Number of joints of a Universal Robots arm.
const JOINTS: usize = 6;

impl Reader<'_> {
    /// The move with this name and these arguments.
    pub fn motion(&mut self, at: Token, word: &str, arguments: &[Argument]) {
        let (via, end, rest) = match (word, arguments) {
            ("movec", [via, end, rest @ ..]) => (Some(via), end, rest),
            ("movej" | "movel" | "movep", [end, rest @ ..]) => (None, end, rest),
            _ => {
                let message = format!("`{word}` has no target");
                let hint = "write `movel(p[...], a=1.2, v=0.25)` or `movec(p[...], p[...])`";
                self.messages.problem(at.span(), message, hint);
                return;
            }
        };
        let via = via.map(|via| self.target(via));
        let Some((target, frame)) = self.target(end) else {
            return;
        };
        let motion = match via {
            Some(Some((via, via_frame))) if via_frame == frame => Motion::Circular { via },
            Some(Some(_)) => {
                let message = "the two positions of this circle are relative to different frames";
                let hint = "give both in the same frame, or both in the base";
                self.messages.problem(at.span(), message, hint);
                return;
            }
            Some(None) => return,
            None if word == "movej" => Motion::Joint,
            None => Motion::Linear,
        };
        let speed = match motion {
            Motion::Joint => Speed::Joints,
            Motion::Linear | Motion::Circular { .. } => speed(word, rest),
        };
        let frame = match frame {
            Reference::Given(frame) => Frame::Given(frame),
            Reference::Feature(name) => {
                let sentence =
                    format!("the frame `{name}` is a feature of the installation: it is not known");
                self.messages.note(at.line, sentence);
                Frame::Unknown
            }
        };
        self.moves.push(RobotMove {
            motion,
            target,
            frame,
            tool: self.tool,
            speed,
            passage: passage(rest),
            line: at.line,
        });
    }

    /// The target in an argument, and its frame.
    fn target(&mut self, argument: &Argument) -> Option<(Target, Reference)> {
        let text = &self.messages.text().text()[argument.bytes.clone()];
        let mut wrong = |message: String, hint: &str| {
            self.messages.problem(argument.bytes.clone(), message, hint);
            None
        };
        match &argument.value {
            Value::Pose(posed) => Some((
                Target::Pose {
                    pose: posed.pose,
                    branch: BranchPattern::default(),
                    turns: Vec::new(),
                    spelled: posed.spelled.clone(),
                },
                posed.frame.clone(),
            )),
            Value::Numbers(joints) if joints.len() == JOINTS => Some((
                Target::Joints(joints.clone()),
                Reference::Given(Isometry::identity()),
            )),
            Value::Numbers(joints) => wrong(
                format!("{} joints in a target, but 6 are required", joints.len()),
                "write `[base, shoulder, elbow, wrist 1, wrist 2, wrist 3]`, rad",
            ),
            Value::Number(_) => wrong(
                format!("`{}` is a number, but a target is required", shown(text)),
                "write `p[x, y, z, rx, ry, rz]`, m and rad",
            ),
            Value::Wrong => None,
            Value::Unknown => {
                let message = match is_name(text) && !self.known.contains_key(text) {
                    true => format!(
                        "`{}` is not defined: no line before gives it a value",
                        shown(text)
                    ),
                    false => format!("`{}` is computed while the program runs", shown(text)),
                };
                wrong(
                    message,
                    "a target is `p[x, y, z, rx, ry, rz]`, joints, or a name with such a value",
                )
            }
        }
    }
}

/// The blend radius `r`, the fourth number after the target, m; without one the arm stops there.
fn passage(rest: &[Argument]) -> Passage {
    let named = rest.iter().find(|argument| argument.name.as_deref() == Some("r"));
    let placed = || rest.get(3).filter(|argument| argument.name.is_none());
    match named.or_else(placed).map(|argument| &argument.value) {
        None => Passage::Stop,
        Some(Value::Number(radius)) if *radius > 0.0 => Passage::Zone(*radius),
        Some(Value::Number(_)) => Passage::Stop,
        Some(_) => Passage::Unknown,
    }
}

/// The tip speed: `v`, the second number after the target, unless `t`, the third, gives the duration.
fn speed(word: &str, rest: &[Argument]) -> Speed {
    let number = |name: &str, place: usize| {
        let by_name = rest
            .iter()
            .find(|argument| argument.name.as_deref() == Some(name));
        let by_place = || rest.get(place).filter(|argument| argument.name.is_none());
        match by_name.or_else(by_place).map(|argument| &argument.value) {
            Some(Value::Number(number)) => Some(*number),
            _ => None,
        }
    };
    if word == "movel" && number("t", 2).is_some_and(|time| time > 0.0) {
        return Speed::Joints;
    }
    match number("v", 1) {
        Some(speed) if speed > 0.0 => Speed::Tip(speed),
        _ => Speed::Unknown,
    }
}
