//! Moves: which argument is what.

use armill_core::frame::Isometry;

use super::kept::Kept;
use super::read::Reader;
use super::statement::is_move;
use super::value::{Argument, Node, Value};
use crate::robot_program::program::{Frame, Motion, RobotMove, Speed, Target};
use crate::robot_program::tokens::{Cursor, Token};
use crate::robot_program::given::shown;

/// Moves of the joints to a pose, straight moves, circular moves.
const JOINT: [&str; 6] = ["MOVEJ", "MOVEJAO", "MOVEJDO", "MOVEJGO", "MOVEJSYNC", "TRIGGJ"];
const LINEAR: [&str; 12] = [
    "MOVEL",
    "MOVELAO",
    "MOVELDO",
    "MOVELGO",
    "MOVELSYNC",
    "TRIGGL",
    "ARCL",
    "ARCLSTART",
    "ARCLEND",
    "DISPL",
    "PAINTL",
    "CAPL",
];
const CIRCULAR: [&str; 11] = [
    "MOVEC",
    "MOVECAO",
    "MOVECDO",
    "MOVECGO",
    "MOVECSYNC",
    "TRIGGC",
    "ARCC",
    "ARCCSTART",
    "ARCCEND",
    "DISPC",
    "CAPC",
];
/// Moves that end where a signal says, or that nobody here knows.
const SEARCHING: [&str; 4] = ["SEARCHL", "SEARCHC", "TRIGGLIOS", "STARTMOVETO"];

impl<'a> Reader<'a> {
    /// The move that this word names, with its arguments at the cursor; whether it is one.
    pub fn motion(&mut self, (at, word): (Token, &str), mut cursor: Cursor<'a>) -> bool {
        let name = &self.here().text()[at.span()];
        let is_circular = CIRCULAR.contains(&word);
        let is_known = is_circular || word == "MOVEABSJ" || JOINT.contains(&word) || LINEAR.contains(&word);
        if word == "MOVEEXTJ" {
            self.note(
                at,
                "`MoveExtJ` moves external axes alone: it is left out".to_owned(),
            );
            return true;
        }
        if !is_known {
            let moves = is_move(word) || SEARCHING.contains(&word);
            if moves {
                let message = format!("`{name}` is a move that is not understood");
                let hint =
                    "understood are MoveAbsJ, MoveJ, MoveL, MoveC and their like with signals, TriggL, ArcL";
                self.given.problem(self.here(), at.span(), message, hint);
            }
            return moves;
        }
        let before = self.given.count();
        let arguments = self.arguments(&mut cursor, 0);
        if self.given.count() > before {
            return true;
        }
        if cursor.peek().is_some() {
            let message = format!("a closing bracket too many in this {name}");
            let hint = "every bracket is closed, in the order in which they were opened";
            self.given.problem(self.here(), cursor.place(), message, hint);
            return true;
        }
        let plain: Vec<&Node> = arguments
            .iter()
            .filter(|argument| argument.name.is_none())
            .filter_map(|argument| argument.value.as_ref())
            .collect();
        let (via, rest) = match (is_circular, plain.as_slice()) {
            (true, [via, rest @ ..]) => (Some(*via), rest),
            (_, rest) => (None, rest),
        };
        let [end, speed, .., last] = rest else {
            return self.too_few((at, name), plain.len());
        };
        let tool = if is_move(word) { rest.get(3) } else { Some(last) };
        let Some(tool) = tool.filter(|_| rest.len() >= 4) else {
            return self.too_few((at, name), plain.len());
        };
        if let Some((motion, target)) = self.goal((at, word), via, end) {
            let is_joint = motion == Motion::Joint;
            let kept = self.kept((at, tool), named(&arguments, "wobj"));
            let Some(Kept { frame, tool }) = kept else {
                return true;
            };
            let speed = match is_joint {
                true => Speed::Joints,
                false => self.speed((at, speed), &arguments),
            };
            self.moves.push(RobotMove {
                motion,
                target,
                frame,
                tool,
                speed,
                line: at.line,
            });
        }
        true
    }

    fn too_few(&mut self, (at, name): (Token, &str), found: usize) -> bool {
        let message = format!("{found} arguments of `{name}`");
        let hint = "a move has its target, speed, zone and tool: `MoveL p10,v100,z1,tool1\\WObj:=wobj1;`";
        self.given.problem(self.here(), at.span(), message, hint);
        true
    }

    fn goal(
        &mut self,
        (at, word): (Token, &str),
        via: Option<&Node>,
        end: &Node,
    ) -> Option<(Motion, Target)> {
        if word == "MOVEABSJ" {
            return Some((Motion::Joint, Target::Joints(self.joints(at, end)?)));
        }
        let via = via.map(|via| self.robtarget(at, via));
        let end = self.robtarget(at, end)?;
        let motion = match via {
            Some(via) => Motion::Circular { via: via? },
            None if JOINT.contains(&word) => Motion::Joint,
            None => Motion::Linear,
        };
        Some((motion, end))
    }

    /// The speed of the tip: `\V`, or the first of a speeddata, mm/s.
    fn speed(&mut self, (at, node): (Token, &Node), arguments: &[Argument]) -> Speed {
        if named(arguments, "t").is_some() {
            return Speed::Joints;
        }
        let node = named(arguments, "v").unwrap_or(node);
        let found = self.names.look(node, self.text);
        let given = found.and_then(|found| match &found.node.value {
            Value::Number(speed) => Some(*speed),
            Value::List(all) => self.number(all.first()?, found.text),
            _ => None,
        });
        let ready = || match &node.value {
            Value::Name(reference) if reference.name == "vmax" => Some(Speed::Joints),
            Value::Name(reference) => {
                let digits = reference.name.strip_prefix('v')?;
                let speed: u32 = digits.parse().ok()?;
                Some(Speed::Tip(f64::from(speed) * 1e-3))
            }
            _ => None,
        };
        match given {
            Some(speed) if speed > 0.0 => Speed::Tip(speed * 1e-3),
            _ => ready().unwrap_or_else(|| {
                let text = shown(&self.here().text()[node.bytes.clone()]);
                self.note(
                    at,
                    format!("the speed `{text}` is not told: how fast the tip is is not known"),
                );
                Speed::EvaluateError
            }),
        }
    }

    /// Work object and tool; nothing, which was told, where one of them cannot be.
    fn kept(&mut self, (at, tool): (Token, &Node), work: Option<&Node>) -> Option<Kept> {
        let tool = self.tool(at, tool)?;
        let frame = match work {
            Some(work) => self.work(at, work)?,
            None => Frame::Told(Isometry::identity()),
        };
        Some(Kept { frame, tool })
    }
}

/// The value of the optional argument of this name.
fn named<'n>(arguments: &'n [Argument], name: &str) -> Option<&'n Node> {
    let found = arguments
        .iter()
        .find(|argument| argument.name.as_deref() == Some(name))?;
    found.value.as_ref()
}
