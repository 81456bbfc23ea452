//! Moves and their arguments.

use armill_core::frame::Isometry;
use armill_core::path::Passage;
use armill_core::units::from_mm;

use super::frames::MoveFrames;
use super::read::Reader;
use super::statement::is_move;
use super::value::{Argument, Node, Value};
use crate::messages::{CLOSE_BRACKETS, shown};
use crate::program::{Frame, Motion, RobotMove, Speed, Target};
use crate::tokens::{Cursor, Token};

/// Joint moves to a pose, straight moves, circular moves.
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
/// Moves that end at a signal, and unsupported moves.
const SEARCHING: [&str; 4] = ["SEARCHL", "SEARCHC", "TRIGGLIOS", "STARTMOVETO"];

impl<'a> Reader<'a> {
    /// The move named by this word, with its arguments at the cursor. Returns whether it is a move.
    pub fn motion(&mut self, at: Token, word: &str, mut cursor: Cursor<'a>) -> bool {
        let name = &self.text()[at.span()];
        let is_circular = CIRCULAR.contains(&word);
        let is_known = is_circular || word == "MOVEABSJ" || JOINT.contains(&word) || LINEAR.contains(&word);
        if word == "MOVEEXTJ" {
            let sentence = "`MoveExtJ` moves only external axes: it is left out";
            self.messages.note(at.line, sentence);
            return true;
        }
        if !is_known {
            let moves = is_move(word) || SEARCHING.contains(&word);
            if moves {
                let message = format!("`{name}` is an unsupported move");
                let hint =
                    "supported: MoveAbsJ, MoveJ, MoveL, MoveC and their variants with signals, TriggL, ArcL";
                self.messages.problem(at.span(), message, hint);
            }
            return moves;
        }
        let before = self.messages.count();
        let arguments = self.arguments(&mut cursor, 0);
        if self.messages.count() > before {
            return true;
        }
        if cursor.peek().is_some() {
            let message = format!("one closing bracket too many in this {name}");
            self.messages.problem(cursor.place(), message, CLOSE_BRACKETS);
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
            return self.too_few(at, plain.len());
        };
        let tool = if is_move(word) { rest.get(3) } else { Some(last) };
        let Some(tool) = tool.filter(|_| rest.len() >= 4) else {
            return self.too_few(at, plain.len());
        };
        if let Some((motion, target)) = self.goal(at, word, via, end) {
            let is_joint = motion == Motion::Joint;
            let kept = self.kept(at, tool, named(&arguments, "wobj"));
            let Some(MoveFrames { frame, tool }) = kept else {
                return true;
            };
            let zone = if is_move(word) {
                rest.get(2).copied()
            } else {
                rest.len().checked_sub(2).map(|at| rest[at])
            };
            let passage = self.passage(zone, &arguments);
            let speed = match is_joint {
                true => Speed::Joints,
                false => self.speed(at, speed, &arguments),
            };
            self.moves.push(RobotMove {
                motion,
                target,
                frame,
                tool,
                speed,
                passage,
                line: at.line,
            });
        }
        true
    }

    fn too_few(&mut self, at: Token, found: usize) -> bool {
        let message = format!("{found} arguments of `{}`", &self.text()[at.span()]);
        let hint = "a move has target, speed, zone and tool: `MoveL p10,v100,z1,tool1\\WObj:=wobj1;`";
        self.messages.problem(at.span(), message, hint);
        true
    }

    fn goal(&mut self, at: Token, word: &str, via: Option<&Node>, end: &Node) -> Option<(Motion, Target)> {
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

    /// The tip speed: `\V`, or the first number of a speeddata, mm/s.
    fn speed(&mut self, at: Token, node: &Node, arguments: &[Argument]) -> Speed {
        if named(arguments, "t").is_some() {
            return Speed::Joints;
        }
        let node = named(arguments, "v").unwrap_or(node);
        let found = self.names.look(node, self.messages.index());
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
                Some(Speed::Tip(from_mm(f64::from(speed))))
            }
            _ => None,
        };
        match given {
            Some(speed) if speed > 0.0 => Speed::Tip(from_mm(speed)),
            _ => ready().unwrap_or_else(|| {
                let text = shown(&self.text()[node.bytes.clone()]);
                let sentence = format!("the speed `{text}` is not defined: the tip speed is not known");
                self.messages.note(at.line, sentence);
                Speed::Unknown
            }),
        }
    }

    /// `\Z`, or a zonedata: its first value states whether the arm stops, its second is the distance of the zone, mm; `fine` and `z10` are predefined.
    fn passage(&self, zone: Option<&Node>, arguments: &[Argument]) -> Passage {
        let Some(node) = named(arguments, "z").or(zone) else {
            return Passage::Unknown;
        };
        let of_mm = |mm: f64| {
            if mm > 0.0 {
                Passage::Zone(from_mm(mm))
            } else {
                Passage::Stop
            }
        };
        if let Some(found) = self.names.look(node, self.messages.index()) {
            match &found.node.value {
                Value::Number(mm) => return of_mm(*mm),
                Value::List(all) => {
                    let stops = all.first().is_some_and(|node| match &node.value {
                        Value::Name(reference) => reference.name.eq_ignore_ascii_case("true"),
                        _ => false,
                    });
                    let distance = all.get(1).and_then(|node| self.number(node, found.text));
                    return match (stops, distance) {
                        (true, _) => Passage::Stop,
                        (false, Some(mm)) => of_mm(mm),
                        (false, None) => Passage::Unknown,
                    };
                }
                _ => {}
            }
        }
        let Value::Name(reference) = &node.value else {
            return Passage::Unknown;
        };
        match reference.name.as_str() {
            "fine" => Passage::Stop,
            // The smallest predefined zone.
            "z0" => of_mm(0.3),
            name => (name
                .strip_prefix('z')
                .and_then(|digits| digits.parse::<u32>().ok()))
            .map_or(Passage::Unknown, |mm| of_mm(f64::from(mm))),
        }
    }

    /// Work object and tool; `None` if one of them is not valid, which has been reported.
    fn kept(&mut self, at: Token, tool: &Node, work: Option<&Node>) -> Option<MoveFrames> {
        let tool = self.tool(at, tool)?;
        let frame = match work {
            Some(work) => self.work(at, work)?,
            None => Frame::Given(Isometry::identity()),
        };
        Some(MoveFrames { frame, tool })
    }
}

/// The value of the optional argument with this name.
fn named<'n>(arguments: &'n [Argument], name: &str) -> Option<&'n Node> {
    let found = arguments
        .iter()
        .find(|argument| argument.name.as_deref() == Some(name))?;
    found.value.as_ref()
}
