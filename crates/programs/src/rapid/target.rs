//! Values of targets: from numbers, by name, with offsets.

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Translation3, UnitQuaternion, Vector3};
use armill_core::robot::BranchPattern;
use armill_core::units::{from_deg, from_mm};
use armill_formats::convention::Convention;

use super::read::Reader;
use super::value::{Argument, Node, Value};
use crate::messages::shown;
use crate::posture::Configuration;
use crate::program::{Spelled, Target};
use crate::tokens::Token;

/// Maximum nesting of offsets.
const MOST_LINKS: usize = 16;
/// Value of an absent axis.
const ABSENT: f64 = 9e9;

/// A resolved target.
struct Place {
    pose: Isometry,
    branch: BranchPattern,
    turns: Vec<i32>,
    moves_external_axes: bool,
    spelled: Spelled,
}

/// Why a target cannot be resolved.
enum Missing {
    /// It has been reported as a problem.
    Reported,
    /// No module declares this name.
    Name(String),
    /// It is computed on the controller.
    Computed,
    /// Its numbers are not a valid pose.
    Pose(String),
}

impl<'a> Reader<'a> {
    /// A robtarget of a move.
    pub fn robtarget(&mut self, at: Token, node: &Node) -> Option<Target> {
        match self.place(node, self.messages.index(), 0) {
            Ok(place) => {
                if place.moves_external_axes {
                    self.external(at);
                }
                Some(Target::Pose {
                    pose: place.pose,
                    branch: place.branch,
                    turns: place.turns,
                    spelled: place.spelled,
                })
            }
            Err(missing) => {
                self.missing(
                    node,
                    missing,
                    "[[x,y,z],[q1,q2,q3,q4],[cf1,cf4,cf6,cfx],[9E9,9E9,9E9,9E9,9E9,9E9]]",
                );
                None
            }
        }
    }

    /// The joints of a jointtarget, rad.
    pub fn joints(&mut self, at: Token, node: &Node) -> Option<Vec<f64>> {
        let requested = "[[j1,j2,j3,j4,j5,j6],[9E9,9E9,9E9,9E9,9E9,9E9]]";
        let found = self.names.look(node, self.messages.index());
        let axes = found.and_then(|found| match &found.node.value {
            Value::List(all) => {
                let joints: [f64; 6] = self.numbers(all.first()?, found.text)?;
                Some((joints, self.moves_external(all.get(1), found.text)))
            }
            _ => None,
        });
        match axes {
            Some((joints, external)) => {
                if external {
                    self.external(at);
                }
                Some(joints.iter().map(from_deg).collect())
            }
            None => {
                let missing = self.why(node, self.messages.index());
                self.missing(node, missing, requested);
                None
            }
        }
    }

    fn external(&mut self, at: Token) {
        let sentence = "external axes are kept unchanged and are not joints in armill";
        self.messages.note(at.line, sentence);
    }

    /// The pose of the first two nodes; `None` if they are not numbers.
    pub fn pose(&self, all: &[Node], text: usize) -> Option<Result<Isometry, String>> {
        let [x, y, z] = self.numbers(all.first()?, text)?;
        let [q1, q2, q3, q4] = self.numbers(all.get(1)?, text)?;
        let pose = Convention::Abb.pose(&[x, y, z, q1, q2, q3, q4]);
        Some(pose.map_err(|error| error.to_string()))
    }

    /// `N` numbers of a list.
    fn numbers<const N: usize>(&self, node: &Node, text: usize) -> Option<[f64; N]> {
        let found = self.names.look(node, text)?;
        let Value::List(all) = &found.node.value else {
            return None;
        };
        let numbers: Option<Vec<f64>> = match all.len() == N {
            true => all.iter().map(|node| self.number(node, found.text)).collect(),
            false => None,
        };
        numbers?.try_into().ok()
    }

    /// The number of an expression.
    pub fn number(&self, node: &Node, text: usize) -> Option<f64> {
        match self.names.look(node, text)?.node.value {
            Value::Number(number) => Some(number),
            _ => None,
        }
    }

    fn moves_external(&self, node: Option<&Node>, text: usize) -> bool {
        let axes: Option<[f64; 6]> = node.and_then(|node| self.numbers(node, text));
        axes.is_some_and(|axes| axes.iter().any(|axis| *axis != 0.0 && *axis < ABSENT))
    }

    fn place(&self, node: &Node, text: usize, level: usize) -> Result<Place, Missing> {
        let Some(found) = self.names.look(node, text).filter(|_| level < MOST_LINKS) else {
            return Err(self.why(node, text));
        };
        // A value written in several parts is rewritten where it is used.
        let (spelled_in, bytes) = match found.is_whole {
            true => (found.text, found.node.bytes.clone()),
            false => (text, node.bytes.clone()),
        };
        let spelled = Spelled {
            text: spelled_in,
            bytes,
        };
        match &found.node.value {
            Value::List(all) => {
                let pose = self
                    .pose(all, found.text)
                    .ok_or_else(|| self.why(node, text))?
                    .map_err(Missing::Pose)?;
                let confdata: Option<[f64; 4]> = all.get(2).and_then(|node| self.numbers(node, found.text));
                let (branch, turns) = confdata.map_or_else(Default::default, posture);
                Ok(Place {
                    pose,
                    branch,
                    turns,
                    moves_external_axes: self.moves_external(all.get(3), found.text),
                    spelled,
                })
            }
            Value::Call(name, arguments) => {
                let plain: Vec<&Node> = arguments
                    .iter()
                    .filter(|argument| argument.name.is_none())
                    .filter_map(|argument| argument.value.as_ref())
                    .collect();
                let (base, by) = match (name.as_str(), plain.as_slice()) {
                    ("offs" | "reltool", [base, x, y, z]) => {
                        let of = |node: &Node| self.number(node, found.text).ok_or(Missing::Computed);
                        (*base, from_mm(Vector3::new(of(x)?, of(y)?, of(z)?)))
                    }
                    _ => return Err(Missing::Computed),
                };
                let place = self.place(base, found.text, level + 1)?;
                let pose = match name.as_str() {
                    "offs" => Translation3::from(by) * place.pose,
                    _ => place.pose * Translation3::from(by) * self.turn(arguments, found.text)?,
                };
                if pose.translation.vector.iter().any(|value| value.abs() > ABSENT) {
                    return Err(Missing::Pose("a position exceeds 9e9 m".to_owned()));
                }
                Ok(Place {
                    pose,
                    spelled,
                    ..place
                })
            }
            _ => Err(self.why(node, text)),
        }
    }

    /// `\Rx`, `\Ry`, `\Rz` of RelTool, deg.
    fn turn(&self, arguments: &[Argument], text: usize) -> Result<UnitQuaternion<f64>, Missing> {
        let mut turn = UnitQuaternion::identity();
        for (name, axis) in [
            ("rx", Vector3::x_axis()),
            ("ry", Vector3::y_axis()),
            ("rz", Vector3::z_axis()),
        ] {
            let given = arguments
                .iter()
                .find(|argument| argument.name.as_deref() == Some(name));
            if let Some(node) = given.and_then(|argument| argument.value.as_ref()) {
                let deg = self.number(node, text).ok_or(Missing::Computed)?;
                turn *= UnitQuaternion::from_axis_angle(&axis, from_deg(deg));
            }
        }
        Ok(turn)
    }

    /// Why an expression has no value.
    fn why(&self, node: &Node, text: usize) -> Missing {
        match &node.value {
            Value::Wrong => Missing::Reported,
            Value::Name(reference) if !self.names.knows(&reference.name) => {
                let name = &self.messages.texts()[text].text()[node.bytes.clone()];
                Missing::Name(shown(name).to_owned())
            }
            _ => match self.names.look(node, text).map(|found| &found.node.value) {
                Some(Value::Wrong) => Missing::Reported,
                Some(Value::List(all)) if has_wrong(all) => Missing::Reported,
                _ => Missing::Computed,
            },
        }
    }

    fn missing(&mut self, node: &Node, missing: Missing, requested: &str) {
        let text = shown(&self.text()[node.bytes.clone()]);
        let (message, hint) = match missing {
            // Reported where it is used; a file with problems only in unused data is also refused.
            Missing::Reported => return,
            Missing::Name(name) => (
                format!("`{name}` is not defined: no given module declares it"),
                "also give the module that declares it".to_owned(),
            ),
            Missing::Computed => (
                format!("`{text}` is computed while the program runs, or is not a valid target"),
                format!("a target here is `{requested}`, or a name with such a value"),
            ),
            Missing::Pose(why) => (why, format!("a target here is `{requested}`")),
        };
        self.messages.problem(node.bytes.clone(), message, &hint);
    }
}

fn has_wrong(all: &[Node]) -> bool {
    all.iter().any(|node| match &node.value {
        Value::Wrong => true,
        Value::List(all) => has_wrong(all),
        _ => false,
    })
}

/// cf1, cf4, cf6, and the posture in cfx.
fn posture(confdata: [f64; 4]) -> (BranchPattern, Vec<i32>) {
    let whole = |value: f64| (value.fract() == 0.0 && value.abs() <= 1e6).then_some(value as i32);
    let [cf1, cf4, cf6, cfx] = confdata.map(whole);
    let turns = cf1.zip(cf4).zip(cf6).map(|((cf1, cf4), cf6)| vec![cf1, cf4, cf6]);
    let configuration = cfx.filter(|cfx| (0..8).contains(cfx)).map(|cfx| Configuration {
        rear: Some(cfx & 4 != 0),
        lower: Some(cfx & 2 != 0),
        flip: Some(cfx & 1 != 0),
    });
    (
        configuration.unwrap_or_default().pattern(),
        turns.unwrap_or_default(),
    )
}
