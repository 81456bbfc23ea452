//! Staubli VAL3: a project (`.pjx`) with programs (`.pgx`) and data (`.dtx`).
//!
//! Sources: VAL3 reference manual 5.3 (D28062804A): movement control, types; VAL3 XML format (versions s6, s7);
//! [recalled].
//!
//! Moves are recorded and run later: an output, a delay or a message takes place at once, unless `waitEndMove` is
//! before it. Not interpreted: branches, loops, parameters, tasks.

mod data;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use roxmltree::Document;

use self::data::{Data, Item};
use crate::event::{Action, Blend, JointMove, JointTarget, LinearMove, Posture, Reference, Speed};
use crate::log::Log;
use crate::pose::Pose;
use crate::source::{Place, ReplayError, SourceFile};
use crate::value::truth_word;
use crate::words::{Cursor, Word, split_comment};

const DEPTH: usize = 32;
/// From here a limit of the speed is none, mm/s.
const NO_LIMIT: f64 = 99999.0;

struct Val3 {
    programs: BTreeMap<String, Vec<(Place, String)>>,
    data: Data,
    log: Log,
}

pub fn run(files: &[SourceFile], main: &str, log: Log) -> Result<Log, ReplayError> {
    let mut val3 = Val3 {
        programs: BTreeMap::new(),
        data: Data::default(),
        log,
    };
    let mut listed = Vec::new();
    for file in files {
        let place = file.place(0);
        let document = Document::parse(&file.text).map_err(|error| place.error(error.to_string()))?;
        let of = |tag: &'static str| {
            document
                .descendants()
                .filter(move |node| node.has_tag_name_here(tag))
        };
        match file.extension().as_str() {
            "pjx" => {
                for node in of("Program").chain(of("Data")) {
                    let name = node
                        .attribute("file")
                        .ok_or_else(|| place.error("an entry without file"))?;
                    listed.push((place.clone(), name.to_owned()));
                }
            }
            "dtx" => val3.data.load(file, &document)?,
            "pgx" => {
                for program in of("Program") {
                    let name = program
                        .attribute("name")
                        .ok_or_else(|| place.error("a program without name"))?;
                    let lines = code(file, &program)?;
                    if val3.programs.insert(name.to_owned(), lines).is_some() {
                        return Err(place.error(format!("the program {name} exists twice")));
                    }
                }
            }
            _ => return Err(place.error("neither .pjx, .pgx nor .dtx")),
        }
    }
    for (place, name) in listed {
        if !files.iter().any(|file| *file.name == *name) {
            return Err(place.error(format!("the project lists {name}, which is not among the files")));
        }
    }
    // An application runs its program `start`.
    let main = if val3.programs.contains_key(main) {
        main
    } else {
        "start"
    };
    if !val3.programs.contains_key(main) {
        let start = files.first().map_or(Place::nowhere(), |file| file.place(0));
        return Err(start.error(format!("no program {main} in the files")));
    }
    val3.program(main, 0)?;
    Ok(val3.log)
}

/// Tags whatever their namespace is.
trait Tag {
    fn has_tag_name_here(&self, tag: &str) -> bool;
}

impl Tag for roxmltree::Node<'_, '_> {
    fn has_tag_name_here(&self, tag: &str) -> bool {
        self.is_element() && self.tag_name().name() == tag
    }
}

/// Lines between `begin` and `end`.
fn code(file: &SourceFile, program: &roxmltree::Node<'_, '_>) -> Result<Vec<(Place, String)>, ReplayError> {
    let node = program
        .descendants()
        .find(|node| node.has_tag_name_here("Code"))
        .and_then(|node| node.first_child())
        .ok_or_else(|| file.place(0).error("a program without code"))?;
    let text = node.text().unwrap_or_default();
    // The text of a CDATA section begins in the line of its opening.
    let first = node.document().text_pos_at(node.range().start).row as usize;
    let mut lines: Vec<(Place, String)> = text
        .lines()
        .enumerate()
        .map(|(index, line)| (file.place(first + index), line.trim().to_owned()))
        .filter(|(_, line)| !line.is_empty())
        .collect();
    let ends = lines.last().is_some_and(|(_, line)| line == "end") && lines[0].1 == "begin";
    if !ends || lines.len() < 2 {
        return Err(file.place(first).error("the code is not between begin and end"));
    }
    lines.pop();
    lines.remove(0);
    Ok(lines)
}

impl Val3 {
    fn program(&mut self, name: &str, depth: usize) -> Result<(), ReplayError> {
        for (place, line) in self.programs[name].clone() {
            if depth > DEPTH {
                return Err(place.error(format!("more than {DEPTH} calls inside each other")));
            }
            let (code, comment) = split_comment(&line, "//");
            if !code.is_empty() {
                let mut cursor = Cursor::new(code, &place)?;
                if cursor.eat_name("return") {
                    return cursor.end();
                }
                self.statement(&mut cursor, depth)?;
                cursor.end()?;
            }
            if let Some(comment) = comment {
                self.log.comment(&place, comment);
            }
        }
        Ok(())
    }

    fn statement(&mut self, cursor: &mut Cursor, depth: usize) -> Result<(), ReplayError> {
        let place = cursor.place().clone();
        if cursor.eat_name("call") {
            let mut name = cursor.name()?;
            if cursor.eat(":") {
                name = format!("{name}:{}", cursor.name()?);
            }
            cursor.expect("(")?;
            if self.programs.contains_key(&name) {
                cursor.expect(")")?;
                return self.program(&name, depth + 1);
            }
            let arguments = cursor.rest();
            let arguments = arguments
                .strip_suffix(')')
                .ok_or_else(|| place.error("the call does not end with `)`"))?;
            let arguments = if arguments.is_empty() {
                Vec::new()
            } else {
                vec![arguments.to_owned()]
            };
            self.log.push(&place, Action::Call { name, arguments });
            return Ok(());
        }
        let name = cursor.name()?;
        if cursor.eat("(") {
            return self.instruction(cursor, &name);
        }
        let index = index(cursor)?;
        cursor.expect("=")?;
        // A move gives its number.
        if matches!(cursor.peek(), Some(Word::Name(call)) if call.starts_with("move")) {
            let call = cursor.name()?;
            cursor.expect("(")?;
            return self.instruction(cursor, &call);
        }
        // A key of the operator is waited for.
        if cursor.eat_name("get") {
            cursor.expect("(")?;
            self.log.stop(&place);
            return cursor.expect(")");
        }
        let kind = self
            .data
            .kind(&name)
            .ok_or_else(|| cursor.error(format!("`{name}` is not in the data")))?;
        let value = if cursor.eat_name("true") {
            truth_word(true)
        } else if cursor.eat_name("false") {
            truth_word(false)
        } else {
            cursor.number()?.to_string()
        };
        match kind {
            "dio" => self.log.output(&place, format!("{name}[{index}]"), value),
            "num" | "bool" => {}
            other => {
                return Err(cursor.error(format!("setting a variable of type {other} is not interpreted")));
            }
        }
        Ok(())
    }

    /// An instruction whose opening parenthesis is taken.
    fn instruction(&mut self, cursor: &mut Cursor, name: &str) -> Result<(), ReplayError> {
        let place = cursor.place().clone();
        match name {
            "movej" | "movel" => {
                let target = self.target(cursor)?;
                cursor.expect(",")?;
                let how = self.how(cursor)?;
                let action = match (name, target) {
                    ("movej", target) => Action::Joint(joint(target, how)),
                    (_, Item::Point { pose, frame, .. }) => Action::Linear(linear(pose, *frame, how)),
                    _ => return Err(cursor.error("movel needs a point")),
                };
                self.log.push_asynchronous(&place, action);
            }
            "movec" => {
                let Item::Point { pose: via, .. } = self.target(cursor)? else {
                    return Err(cursor.error("movec needs points"));
                };
                cursor.expect(",")?;
                let Item::Point { pose, frame, .. } = self.target(cursor)? else {
                    return Err(cursor.error("movec needs points"));
                };
                cursor.expect(",")?;
                let how = self.how(cursor)?;
                let end = linear(pose, *frame, how);
                self.log.push_asynchronous(&place, Action::Circular { via, end });
            }
            // The blending of the last move is cancelled.
            "waitEndMove" => self.log.settle(),
            "delay" => {
                let s = cursor.number()?;
                self.log.push(&place, Action::Dwell { s });
            }
            "popUpMsg" | "putln" | "put" | "logMsg" => {
                let text = cursor.text()?;
                self.log.message(&place, text);
            }
            "wait" => {
                let condition = cursor.rest().trim_end_matches(')').to_owned();
                self.log.push(&place, Action::Wait { condition });
                return Ok(());
            }
            "aioSet" => {
                let output = cursor.name()?;
                let index = index(cursor)?;
                cursor.expect(",")?;
                let value = cursor.number()?.to_string();
                self.log.output(&place, format!("{output}[{index}]"), value);
            }
            "resetMotion" | "cls" | "userPage" | "autoConnectMove" => {
                cursor.eat_name("true");
                cursor.eat_name("false");
            }
            _ => return Err(cursor.error(format!("unknown instruction `{name}`"))),
        }
        cursor.expect(")")
    }

    /// A joint or a point, or one moved by `appro`.
    fn target(&self, cursor: &mut Cursor) -> Result<Item, ReplayError> {
        if cursor.eat_name("appro") {
            cursor.expect("(")?;
            let target = self.item(cursor)?;
            cursor.expect(",{")?;
            let mut numbers = [0.0; 6];
            for (position, number) in numbers.iter_mut().enumerate() {
                if position > 0 {
                    cursor.expect(",")?;
                }
                *number = cursor.number()?;
            }
            cursor.expect("})")?;
            // Relative to the point, along the axes of the tool in it.
            return match target {
                Item::Point { pose, frame, posture } => Ok(Item::Point {
                    pose: pose.then(&Pose::staubli(numbers)),
                    frame,
                    posture,
                }),
                _ => Err(cursor.error("appro needs a point")),
            };
        }
        self.item(cursor)
    }

    fn item(&self, cursor: &mut Cursor) -> Result<Item, ReplayError> {
        let name = cursor.name()?;
        let index = index(cursor)?;
        self.data
            .item(&name, index)
            .map_err(|message| cursor.error(message))
    }

    /// Tool and motion descriptor.
    fn how(&self, cursor: &mut Cursor) -> Result<How, ReplayError> {
        let Item::Tool { name, pose } = self.item(cursor)? else {
            return Err(cursor.error("a tool expected"));
        };
        cursor.expect(",")?;
        let Item::Motion {
            percent,
            speed,
            blend,
        } = self.item(cursor)?
        else {
            return Err(cursor.error("a motion descriptor (mdesc) expected"));
        };
        Ok(How {
            tool: Reference::new(name, Some(pose)),
            percent,
            speed,
            blend,
        })
    }
}

struct How {
    tool: Reference,
    percent: f64,
    speed: f64,
    blend: Blend,
}

fn joint(target: Item, how: How) -> JointMove {
    let (to, base) = match target {
        Item::Joint(axes) => (JointTarget::Axes(axes), Reference::default()),
        Item::Point { pose, frame, posture } => {
            let posture = Posture::Named(posture);
            (JointTarget::Pose { pose, posture }, *frame)
        }
        Item::Tool { .. } | Item::Motion { .. } => (JointTarget::Current, Reference::default()),
    };
    JointMove {
        to,
        external: Vec::new(),
        base,
        tool: how.tool,
        speed: Speed::Percent(how.percent),
        blend: how.blend,
    }
}

/// The limit of the speed of the tool centre point is the speed, if there is one.
fn linear(to: Pose, base: Reference, how: How) -> LinearMove {
    LinearMove {
        to,
        external: Vec::new(),
        base,
        tool: how.tool,
        speed: if how.speed < NO_LIMIT {
            Speed::MmPerS(how.speed)
        } else {
            Speed::Percent(how.percent)
        },
        blend: how.blend,
    }
}

/// `[3]`; without it the first element.
fn index(cursor: &mut Cursor) -> Result<u32, ReplayError> {
    if !cursor.eat("[") {
        return Ok(0);
    }
    let index = cursor.count()?;
    cursor.expect("]")?;
    Ok(index)
}
