//! Universal Robots URScript: functions of statements, one a line.
//!
//! Sources: URScript manual (SW 5 and 10), modules motion, interfaces, urmath and internals: joint positions and poses
//! are lists of six numbers, rad and m; defaults of movej and movel [recalled except the units]. UR3 CB3 user manual,
//! section 14.6: a statement after a blended target runs when the arm enters the blend.
//!
//! Not interpreted: branches, loops, threads, functions with parameters.

mod motion;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use self::motion::{Motion, pose_of};
use crate::event::Action;
use crate::log::Log;
use crate::pose::Pose;
use crate::source::{Place, ReplayError, SourceFile};
use crate::value::{Value, expression};
use crate::words::{Cursor, Word, split_comment};

const DEPTH: usize = 32;
/// Statements that set something of no meaning for the path.
const SETTINGS: [&str; 8] = [
    "set_payload",
    "set_target_payload",
    "set_gravity",
    "set_payload_cog",
    "set_payload_mass",
    "textmsg",
    "sync",
    "set_safety_mode_transition_hardness",
];

struct Script<'a> {
    functions: BTreeMap<String, Vec<(Place, &'a str)>>,
    values: BTreeMap<String, Value>,
    motion: Motion,
    log: Log,
    halted: bool,
}

/// Arguments of a call: by position, and by name.
#[derive(Default)]
pub struct Arguments {
    positional: Vec<Value>,
    named: BTreeMap<String, Value>,
}

pub fn run(files: &[SourceFile], main: &str, log: Log) -> Result<Log, ReplayError> {
    let mut script = Script {
        functions: BTreeMap::new(),
        values: BTreeMap::new(),
        motion: Motion::default(),
        log,
        halted: false,
    };
    let mut top = Vec::new();
    for file in files {
        top.extend(script.load(file)?);
    }
    // A file with a function alone runs that function; otherwise its statements run.
    let mut called = false;
    for (place, line) in top {
        called |= line.split('(').next().is_some_and(|name| name.trim() == main);
        script.line(&place, line, 0)?;
    }
    if !called {
        let start = files.first().map_or(Place::nowhere(), |file| file.place(0));
        if !script.functions.contains_key(main) {
            return Err(start.error(format!("no def {main} in the files")));
        }
        script.function(main, 0)?;
    }
    Ok(script.log)
}

impl<'a> Script<'a> {
    /// Takes the functions of a file; gives the lines outside of them.
    fn load(&mut self, file: &'a SourceFile) -> Result<Vec<(Place, &'a str)>, ReplayError> {
        let mut top = Vec::new();
        let mut open: Option<(String, Vec<(Place, &'a str)>)> = None;
        for (place, line) in file.lines() {
            let (code, _) = split_comment(line, "#");
            if let Some(head) = code.strip_prefix("def ") {
                let name = head
                    .strip_suffix(':')
                    .and_then(|head| head.trim_end().strip_suffix("()"))
                    .ok_or_else(|| place.error("only `def name():` is interpreted"))?;
                if open.replace((name.trim().to_owned(), Vec::new())).is_some() {
                    return Err(place.error("def inside of def"));
                }
            } else if code == "end" {
                let (name, lines) = open.take().ok_or_else(|| place.error("end without def"))?;
                if self.functions.insert(name.clone(), lines).is_some() {
                    return Err(place.error(format!("{name} is defined twice")));
                }
            } else {
                open.as_mut()
                    .map_or(&mut top, |(_, lines)| lines)
                    .push((place, line));
            }
        }
        match open {
            Some((name, _)) => Err(file.place(0).error(format!("def {name} has no end"))),
            None => Ok(top),
        }
    }

    fn function(&mut self, name: &str, depth: usize) -> Result<(), ReplayError> {
        for (place, line) in self.functions[name].clone() {
            if depth > DEPTH {
                return Err(place.error(format!("more than {DEPTH} calls inside each other")));
            }
            self.line(&place, line, depth)?;
        }
        Ok(())
    }

    fn line(&mut self, place: &Place, line: &str, depth: usize) -> Result<(), ReplayError> {
        if self.halted {
            return Ok(());
        }
        let (code, comment) = split_comment(line, "#");
        if !code.is_empty() {
            let mut cursor = Cursor::new(code, place)?;
            self.statement(&mut cursor, depth)?;
            cursor.end()?;
        }
        if let Some(comment) = comment {
            self.log.comment(place, comment);
        }
        Ok(())
    }

    fn value(&self, cursor: &mut Cursor) -> Result<Value, ReplayError> {
        expression(cursor, &mut |cursor| self.atom(cursor))
    }

    fn atom(&self, cursor: &mut Cursor) -> Result<Value, ReplayError> {
        if cursor.eat("[") {
            return Ok(Value::List(self.list(cursor)?));
        }
        let name = cursor.name()?;
        if name == "p" && cursor.eat("[") {
            let numbers = Value::List(self.list(cursor)?);
            return Ok(Value::Pose(pose_of(cursor, &numbers)?));
        }
        if cursor.eat("(") {
            let given = self.arguments(cursor)?;
            return function_value(cursor, &name, &given);
        }
        if name == "True" || name == "False" {
            return Ok(Value::Truth(name == "True"));
        }
        self.values
            .get(&name)
            .cloned()
            .ok_or_else(|| cursor.error(format!("`{name}` is not defined in these files")))
    }

    fn list(&self, cursor: &mut Cursor) -> Result<Vec<Value>, ReplayError> {
        let mut values = vec![self.value(cursor)?];
        while cursor.eat(",") {
            values.push(self.value(cursor)?);
        }
        cursor.expect("]")?;
        Ok(values)
    }

    /// Up to the closing parenthesis.
    fn arguments(&self, cursor: &mut Cursor) -> Result<Arguments, ReplayError> {
        let mut given = Arguments::default();
        if cursor.eat(")") {
            return Ok(given);
        }
        loop {
            let value = self.value_or_name(cursor)?;
            match value {
                Err(name) => {
                    let value = self.value(cursor)?;
                    if given.named.insert(name.clone(), value).is_some() {
                        return Err(cursor.error(format!("argument {name} is given twice")));
                    }
                }
                Ok(value) if given.named.is_empty() => given.positional.push(value),
                Ok(_) => return Err(cursor.error("an argument without name follows one with a name")),
            }
            if !cursor.eat(",") {
                cursor.expect(")")?;
                return Ok(given);
            }
        }
    }

    /// A value, or the name of an argument with its `=` taken.
    fn value_or_name(&self, cursor: &mut Cursor) -> Result<Result<Value, String>, ReplayError> {
        if let Some(Word::Name(name)) = cursor.peek().cloned()
            && cursor.sees_after("=")
        {
            cursor.name()?;
            cursor.expect("=")?;
            return Ok(Err(name));
        }
        self.value(cursor).map(Ok)
    }

    fn statement(&mut self, cursor: &mut Cursor, depth: usize) -> Result<(), ReplayError> {
        if !cursor.eat_name("global") {
            cursor.eat_name("local");
        }
        let name = cursor.name()?;
        if cursor.eat("=") {
            let value = self.value(cursor)?;
            self.values.insert(name, value);
            return Ok(());
        }
        if name == "halt" && cursor.at_end() {
            return self.halt(cursor);
        }
        if !cursor.eat("(") {
            return Err(cursor.error(format!("unknown statement `{name}`")));
        }
        if self.functions.contains_key(&name) {
            cursor.expect(")")?;
            return self.function(&name, depth + 1);
        }
        let given = self.arguments(cursor)?;
        self.call(cursor, &name, &given)
    }

    fn halt(&mut self, cursor: &Cursor) -> Result<(), ReplayError> {
        self.log.stop(cursor.place());
        self.halted = true;
        Ok(())
    }

    fn call(&mut self, cursor: &Cursor, name: &str, given: &Arguments) -> Result<(), ReplayError> {
        let place = cursor.place();
        match name {
            "movej" | "movel" => {
                let action = self.motion.moved(cursor, name, given)?;
                self.log.push(place, action);
            }
            "movec" => {
                let action = self.motion.arc(cursor, given)?;
                self.log.push(place, action);
            }
            "set_tcp" => {
                let Value::Pose(pose) = given.at(cursor, 0, "pose")? else {
                    return Err(cursor.error("set_tcp needs a pose"));
                };
                self.motion.set_tool(*pose);
            }
            "set_digital_out"
            | "set_standard_digital_out"
            | "set_configurable_digital_out"
            | "set_tool_digital_out"
            | "set_standard_analog_out" => {
                let number = given.at(cursor, 0, "n")?.number(cursor)?;
                let value = given.at(cursor, 1, "b")?.as_output();
                let value = value.ok_or_else(|| cursor.error("an output is True, False or a number"))?;
                let output = name.trim_start_matches("set_");
                self.log.output(place, format!("{output}[{number}]"), value);
            }
            "sleep" => {
                let s = given.at(cursor, 0, "t")?.number(cursor)?;
                self.log.push(place, Action::Dwell { s });
            }
            // popup(s, title, warning, error, blocking): the program waits if `blocking` is true.
            "popup" => {
                let Value::Text(text) = given.at(cursor, 0, "s")? else {
                    return Err(cursor.error("popup needs a text"));
                };
                self.log.message(place, text.clone());
                if given.maybe(4, "blocking") == Some(&Value::Truth(true)) {
                    self.log.stop(place);
                }
            }
            "halt" => return self.halt(cursor),
            _ if SETTINGS.contains(&name) => {}
            // A blend, move or wait that is not known here must not become a call.
            _ if ["mov", "set_", "stop", "speed", "servo", "force_", "pause"]
                .iter()
                .any(|p| name.starts_with(p)) =>
            {
                return Err(cursor.error(format!("the function `{name}` is not interpreted")));
            }
            _ => {
                let arguments = given
                    .positional
                    .iter()
                    .map(|value| format!("{value:?}"))
                    .collect();
                let name = name.to_owned();
                self.log.push(place, Action::Call { name, arguments });
            }
        }
        Ok(())
    }
}

impl Arguments {
    /// By position from 0, or by name.
    pub fn maybe(&self, position: usize, name: &str) -> Option<&Value> {
        self.positional.get(position).or_else(|| self.named.get(name))
    }

    pub fn at(&self, cursor: &Cursor, position: usize, name: &str) -> Result<&Value, ReplayError> {
        self.maybe(position, name)
            .ok_or_else(|| cursor.error(format!("argument {name} is missing")))
    }

    /// Refuses names of arguments that a function does not have.
    pub fn known(&self, cursor: &Cursor, names: &[&str]) -> Result<(), ReplayError> {
        match self.named.keys().find(|name| !names.contains(&name.as_str())) {
            Some(name) => Err(cursor.error(format!("unknown argument {name}"))),
            None => Ok(()),
        }
    }
}

/// Functions of the module urmath that give a value.
fn function_value(cursor: &Cursor, name: &str, given: &Arguments) -> Result<Value, ReplayError> {
    let pose = |position: usize| match given.positional.get(position) {
        Some(Value::Pose(pose)) => Ok(*pose),
        other => Err(cursor.error(format!("{name} needs a pose, found {other:?}"))),
    };
    match name {
        // T_from_to of the second, seen through the first.
        "pose_trans" => Ok(Value::Pose(pose(0)?.then(&pose(1)?))),
        "pose_inv" => Ok(Value::Pose(pose(0)?.inverse())),
        // Positions are added; the rotation is that of the first times that of the second.
        "pose_add" => {
            let (one, other) = (pose(0)?, pose(1)?);
            let position_mm = std::array::from_fn(|axis| one.position_mm[axis] + other.position_mm[axis]);
            let turned = one.then(&other);
            Ok(Value::Pose(Pose {
                position_mm,
                ..turned
            }))
        }
        "d2r" | "r2d" => {
            let number = given.at(cursor, 0, "d")?.number(cursor)?;
            Ok(Value::Number(if name == "d2r" {
                number.to_radians()
            } else {
                number.to_degrees()
            }))
        }
        // Kept as the pose and the axes near which the solution is.
        "get_inverse_kin" => {
            let near = given.maybe(1, "qnear").cloned();
            let near = near
                .ok_or_else(|| cursor.error("get_inverse_kin without qnear depends on where the robot is"))?;
            Ok(Value::List(vec![Value::Pose(pose(0)?), near]))
        }
        _ => Err(cursor.error(format!("unknown function `{name}`"))),
    }
}
