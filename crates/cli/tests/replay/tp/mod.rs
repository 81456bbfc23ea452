//! FANUC TP: listings (`.LS`) with their positions.
//!
//! Source: R-30iB HandlingTool operator's manual (B-83284EN), program structure, motion, register, I/O, wait and frame
//! instructions [recalled].
//!
//! Not interpreted: branches (JMP, IF, FOR), arcs, skip conditions, frames that depend on each other.

mod positions;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use self::positions::{Target, positions};
use crate::event::{Action, Blend, JointMove, JointTarget, LinearMove, Reference, Speed};
use crate::log::Log;
use crate::pose::Pose;
use crate::source::{Place, ReplayError, SourceFile};
use crate::value::{Value, expression, truth_word};
use crate::words::{Cursor, Word};

const DEPTH: usize = 32;
const INCH_MM: f64 = 25.4;

struct Program {
    targets: BTreeMap<u32, Target>,
    statements: Vec<(Place, String)>,
}

#[derive(Default)]
struct Tp {
    programs: BTreeMap<String, Program>,
    /// Components of position registers: X, Y, Z, W, P, R.
    positions: BTreeMap<u32, BTreeMap<u32, f64>>,
    numbers: BTreeMap<u32, f64>,
    frames: BTreeMap<u32, Pose>,
    tools: BTreeMap<u32, Pose>,
    frame: Option<u32>,
    tool: Option<u32>,
    log: Log,
}

pub fn run(files: &[SourceFile], main: &str, log: Log) -> Result<Log, ReplayError> {
    let mut tp = Tp { log, ..Tp::default() };
    for file in files {
        let (name, program) = load(file)?;
        if tp.programs.insert(name.clone(), program).is_some() {
            return Err(file.place(0).error(format!("the program {name} exists twice")));
        }
    }
    let start = files.first().map_or(Place::nowhere(), |file| file.place(0));
    if !tp.programs.contains_key(&main.to_uppercase()) {
        return Err(start.error(format!("no program {main} in the files")));
    }
    tp.program(&main.to_uppercase(), 0)?;
    Ok(tp.log)
}

/// `/PROG name`, `/ATTR`, `/MN` with statements up to `;`, `/POS`, `/END`.
fn load(file: &SourceFile) -> Result<(String, Program), ReplayError> {
    let mut name = None;
    let mut section = "";
    let mut statements: Vec<(Place, String)> = Vec::new();
    let mut open: Option<(Place, String)> = None;
    let mut position_lines = Vec::new();
    for (place, line) in file.lines() {
        let trimmed = line.trim();
        if open.is_none() && trimmed.starts_with('/') {
            let word = trimmed.split_whitespace().next().unwrap_or_default();
            section = match word {
                "/PROG" => {
                    name = trimmed.split_whitespace().nth(1).map(str::to_uppercase);
                    "/PROG"
                }
                "/ATTR" => "/ATTR",
                "/APPL" => "/APPL",
                "/MN" => "/MN",
                "/POS" => "/POS",
                "/END" => "/END",
                other => return Err(place.error(format!("unknown section `{other}`"))),
            };
            continue;
        }
        match section {
            "/ATTR" | "/APPL" => {}
            "/POS" => position_lines.push((place, trimmed)),
            "/MN" if trimmed.is_empty() => {}
            "/MN" => {
                // `  12:J P[1] ..`: the number of the line; continued lines have none.
                let text = match trimmed.split_once(':') {
                    Some((number, rest)) if number.trim().chars().all(|c| c.is_ascii_digit()) => rest,
                    _ => trimmed,
                };
                let (_, all) = open.get_or_insert_with(|| (place, String::new()));
                all.push_str(text);
                all.push(' ');
                if all.trim_end().ends_with(';')
                    && let Some((place, all)) = open.take()
                {
                    let text = all.trim().trim_end_matches(';').trim().to_owned();
                    statements.push((place, text));
                }
            }
            _ if trimmed.is_empty() => {}
            _ => return Err(place.error(format!("`{trimmed}` is outside of the program"))),
        }
    }
    if let Some((place, _)) = open {
        return Err(place.error("the statement does not end with `;`"));
    }
    if section != "/END" {
        return Err(file.place(0).error("the program has no /END"));
    }
    let name = name.ok_or_else(|| file.place(0).error("no /PROG with a name"))?;
    let targets = positions(&position_lines)?;
    Ok((name, Program { targets, statements }))
}

impl Tp {
    fn program(&mut self, name: &str, depth: usize) -> Result<(), ReplayError> {
        for (place, text) in self.programs[name].statements.clone() {
            if depth > DEPTH {
                return Err(place.error(format!("more than {DEPTH} calls inside each other")));
            }
            if let Some(comment) = text.strip_prefix('!').or_else(|| text.strip_prefix("//")) {
                self.log.comment(&place, comment);
                continue;
            }
            if let Some(message) = text.strip_prefix("MESSAGE[") {
                let message = message
                    .strip_suffix(']')
                    .ok_or_else(|| place.error("MESSAGE without `]`"))?;
                self.log.message(&place, message.trim().to_owned());
                continue;
            }
            if text == "END" {
                return Ok(());
            }
            let mut cursor = Cursor::new(&text, &place)?;
            if !cursor.at_end() {
                self.statement(&mut cursor, name, depth)?;
                cursor.end()?;
            }
        }
        Ok(())
    }

    fn statement(&mut self, cursor: &mut Cursor, program: &str, depth: usize) -> Result<(), ReplayError> {
        let place = cursor.place().clone();
        let word = cursor.name()?;
        match word.as_str() {
            "J" | "L" => self.moved(cursor, program, &word)?,
            "UFRAME_NUM" | "UTOOL_NUM" => {
                cursor.expect("=")?;
                let number = Some(cursor.count()?);
                let of = if word == "UFRAME_NUM" {
                    &mut self.frame
                } else {
                    &mut self.tool
                };
                *of = number;
            }
            "UFRAME" | "UTOOL" => {
                let number = index(cursor)?;
                cursor.expect("=")?;
                if !cursor.eat_name("PR") {
                    return Err(cursor.unexpected("PR[..]"));
                }
                let register = index(cursor)?;
                let pose = self.register(cursor, register)?;
                let of = if word == "UFRAME" {
                    &mut self.frames
                } else {
                    &mut self.tools
                };
                of.insert(number, pose);
            }
            "PR" => {
                cursor.expect("[")?;
                let register = cursor.count()?;
                cursor.expect(",")?;
                let component = cursor.count()?;
                cursor.expect("]=")?;
                let value = self.value(cursor)?;
                self.positions
                    .entry(register)
                    .or_default()
                    .insert(component, value);
            }
            "R" => {
                let register = index(cursor)?;
                cursor.expect("=")?;
                let value = self.value(cursor)?;
                self.numbers.insert(register, value);
            }
            "DO" | "RO" | "AO" | "GO" => {
                let number = index(cursor)?;
                cursor.expect("=")?;
                let value = if cursor.eat_name("ON") {
                    truth_word(true)
                } else if cursor.eat_name("OFF") {
                    truth_word(false)
                } else {
                    self.value(cursor)?.to_string()
                };
                self.log.output(&place, format!("{word}[{number}]"), value);
            }
            "WAIT" => {
                // While it waits no motion instruction runs (FANUC instruction manual, edition of Lincoln Electric,
                // section 26): the robot comes to rest in the last target, also after CNT [recalled].
                self.log.settle();
                if matches!(cursor.peek(), Some(Word::Number(_))) || cursor.sees_name("R") {
                    let s = self.value(cursor)?;
                    if cursor.eat("(") {
                        if !cursor.eat_name("sec") {
                            return Err(cursor.unexpected("sec"));
                        }
                        cursor.expect(")")?;
                    }
                    self.log.push(&place, Action::Dwell { s });
                } else {
                    let condition = cursor.rest();
                    self.log.push(&place, Action::Wait { condition });
                }
            }
            "PAUSE" => {
                self.log.settle();
                self.log.stop(&place);
            }
            "PAYLOAD" => {
                index(cursor)?;
            }
            "CALL" | "RUN" => {
                let name = cursor.name()?;
                let arguments = if cursor.eat("(") {
                    vec![cursor.rest().trim_end_matches(')').to_owned()]
                } else {
                    Vec::new()
                };
                if self.programs.contains_key(&name.to_uppercase()) && word == "CALL" {
                    return self.program(&name.to_uppercase(), depth + 1);
                }
                self.log.push(&place, Action::Call { name, arguments });
            }
            _ => return Err(cursor.error(format!("unknown instruction `{word}`"))),
        }
        Ok(())
    }

    /// Numbers, registers, and their sums and products.
    fn value(&self, cursor: &mut Cursor) -> Result<f64, ReplayError> {
        let value = expression(cursor, &mut |cursor| {
            let word = cursor.name()?;
            let found = match word.as_str() {
                "R" => self.numbers.get(&index(cursor)?).copied(),
                "PR" => {
                    cursor.expect("[")?;
                    let register = cursor.count()?;
                    cursor.expect(",")?;
                    let component = cursor.count()?;
                    cursor.expect("]")?;
                    self.positions
                        .get(&register)
                        .and_then(|parts| parts.get(&component))
                        .copied()
                }
                _ => return Err(cursor.error(format!("unknown value `{word}`"))),
            };
            found.map(Value::Number).ok_or_else(|| {
                cursor.error(format!("a register {word} is read that the program does not set"))
            })
        })?;
        value.number(cursor)
    }

    fn register(&self, cursor: &Cursor, number: u32) -> Result<Pose, ReplayError> {
        let parts = self.positions.get(&number);
        let mut numbers = [0.0; 6];
        for (component, value) in (1..).zip(&mut numbers) {
            *value = *parts.and_then(|parts| parts.get(&component)).ok_or_else(|| {
                cursor.error(format!(
                    "PR[{number},{component}] is read but not set by the program"
                ))
            })?;
        }
        Ok(Pose::fixed_xyz(numbers))
    }

    fn reference(number: Option<u32>, values: &BTreeMap<u32, Pose>) -> Reference {
        match number {
            None => Reference::default(),
            // Frame 0 is the world frame, tool 0 the flange.
            Some(0) => Reference::new("0", Some(Pose::IDENTITY)),
            Some(number) => Reference::new(number.to_string(), values.get(&number).copied()),
        }
    }

    fn moved(&mut self, cursor: &mut Cursor, program: &str, word: &str) -> Result<(), ReplayError> {
        let place = cursor.place().clone();
        let kind = cursor.name()?;
        let number = index(cursor)?;
        let mut target = match kind.as_str() {
            "P" => {
                let target = self.programs[program].targets.get(&number);
                target
                    .cloned()
                    .ok_or_else(|| cursor.error(format!("P[{number}] is not in /POS")))?
            }
            "PR" => Target::of_register(self.register(cursor, number)?),
            _ => return Err(cursor.error(format!("unknown position `{kind}[{number}]`"))),
        };
        // A position of another frame or tool stops the program with an alarm.
        for (what, of_position, active) in [("UF", target.frame, self.frame), ("UT", target.tool, self.tool)]
        {
            if let (Some(of_position), Some(active)) = (of_position, active)
                && of_position != active
            {
                return Err(cursor.error(format!(
                    "P[{number}] has {what} : {of_position}, but {active} is active"
                )));
            }
        }
        let speed = speed(cursor)?;
        let blend = termination(cursor)?;
        self.options(cursor, &mut target)?;
        let base = Tp::reference(self.frame.or(target.frame), &self.frames);
        let tool = Tp::reference(self.tool.or(target.tool), &self.tools);
        let action = match (word, target.to) {
            ("J", to) => Action::Joint(JointMove {
                to,
                external: target.external,
                base,
                tool,
                speed,
                blend,
            }),
            (_, JointTarget::Pose { pose, .. }) => Action::Linear(LinearMove {
                to: pose,
                external: target.external,
                base,
                tool,
                speed,
                blend,
            }),
            _ => return Err(cursor.error("a line to axes needs the model of the arm")),
        };
        self.log.push(&place, action);
        Ok(())
    }

    /// `ACC80`, `Wjnt`, `Offset,PR[1]`, `Tool_Offset,PR[1]`.
    fn options(&self, cursor: &mut Cursor, target: &mut Target) -> Result<(), ReplayError> {
        while let Some(Word::Name(option)) = cursor.peek().cloned() {
            cursor.name()?;
            let is_acceleration = option
                .strip_prefix("ACC")
                .is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit()));
            if is_acceleration || option == "Wjnt" {
                continue;
            }
            if option != "Offset" && option != "Tool_Offset" {
                return Err(cursor.error(format!("the motion option `{option}` is not interpreted")));
            }
            cursor.expect(",")?;
            if !cursor.eat_name("PR") {
                return Err(cursor.unexpected("PR[..]"));
            }
            let register = index(cursor)?;
            let by = self.register(cursor, register)?;
            let JointTarget::Pose { pose, .. } = &mut target.to else {
                return Err(cursor.error("an offset of axes is not interpreted"));
            };
            // An offset is along the axes of the user frame; a tool offset is a pose in the frame of the tool.
            if option == "Tool_Offset" {
                *pose = pose.then(&by);
            } else if by.rotation == Pose::IDENTITY.rotation {
                pose.position_mm = std::array::from_fn(|axis| pose.position_mm[axis] + by.position_mm[axis]);
            } else {
                return Err(cursor.error("an offset with a rotation is not interpreted"));
            }
        }
        Ok(())
    }
}

/// `[3]`, also with a comment: `[3:spindle]`.
fn index(cursor: &mut Cursor) -> Result<u32, ReplayError> {
    cursor.expect("[")?;
    let number = cursor.count()?;
    if cursor.eat(":") {
        cursor.skip_to(']')?;
    }
    cursor.expect("]")?;
    Ok(number)
}

fn speed(cursor: &mut Cursor) -> Result<Speed, ReplayError> {
    let number = cursor.number()?;
    if cursor.eat("%") {
        return Ok(Speed::Percent(number));
    }
    let unit = cursor.name()?;
    let per = if cursor.eat("/") {
        Some(cursor.name()?)
    } else {
        None
    };
    match (unit.as_str(), per.as_deref()) {
        ("mm", Some("sec")) => Ok(Speed::MmPerS(number)),
        ("cm", Some("min")) => Ok(Speed::MmPerS(number * 10.0 / 60.0)),
        ("inch", Some("min")) => Ok(Speed::MmPerS(number * INCH_MM / 60.0)),
        ("deg", Some("sec")) => Ok(Speed::DegPerS(number)),
        ("sec", None) => Ok(Speed::Seconds(number)),
        ("msec", None) => Ok(Speed::Seconds(number / 1000.0)),
        _ => Err(cursor.error(format!("`{unit}` is not the unit of a speed"))),
    }
}

/// `FINE`, `CNT100`; CNT0 slows down to rest.
fn termination(cursor: &mut Cursor) -> Result<Blend, ReplayError> {
    let word = cursor.name()?;
    if word == "FINE" {
        return Ok(Blend::Exact);
    }
    match word
        .strip_prefix("CNT")
        .and_then(|number| number.parse::<f64>().ok())
    {
        Some(percent) if (0.0..=100.0).contains(&percent) => Ok(Blend::Percent(percent)),
        _ => Err(cursor.error(format!("`{word}` is not FINE or CNT0 to CNT100"))),
    }
}
