//! KUKA KRL: `.src` files, with the data lists of their `.dat` files.
//!
//! Sources: KUKA System Software 8.3, Operating and Programming Instructions for System Integrators, and the KRL
//! reference guide of KR C2 / KR C3 (release 4.1); both [recalled].
//!
//! What `BAS(#INITMOV)` sets is a matter of the controller's file `bas.src`: base, tool, speeds and approximation are
//! unknown after it. Not interpreted: branches, loops, functions, splines, CIRC with an angle.

mod data;
mod motion;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use self::data::{Data, UNIT, is_declaration};
use self::motion::{Motion, frame};
use crate::event::{Action, Reference};
use crate::log::Log;
use crate::pose::Pose;
use crate::source::{Place, ReplayError, SourceFile};
use crate::value::Value;
use crate::words::{Cursor, Word, split_comment};

/// System variables that a program may set without a move, an output or a frame.
const SYSTEM: [&str; 18] = [
    "$BWDSTART",
    "$ADVANCE",
    "$LOOP_CONT",
    "$LOOP_MSG",
    "$ORI_TYPE",
    "$CIRC_TYPE",
    "$ACC",
    "$ACC_AXIS",
    "$VEL",
    "$VEL_AXIS",
    "$APO",
    "$LOAD",
    "$VEL_EXTAX",
    "$ACC_EXTAX",
    "$FLAG",
    "$TIMER",
    "$OV_PRO",
    "$IPO_MODE",
];
const DEPTH: usize = 32;

struct Routine<'a> {
    module: String,
    lines: Vec<(Place, &'a str)>,
}

pub struct Krl<'a> {
    routines: BTreeMap<String, Routine<'a>>,
    data: Data,
    motion: Motion,
    /// CONTINUE was the last statement: the next one does not stop the advance run.
    advance: bool,
    log: Log,
}

pub fn run(files: &[SourceFile], main: &str, log: Log) -> Result<Log, ReplayError> {
    let mut krl = Krl {
        routines: BTreeMap::new(),
        data: Data::default(),
        motion: Motion::default(),
        advance: false,
        log,
    };
    for file in files {
        match file.extension().as_str() {
            "src" => krl.load_source(file)?,
            "dat" => krl.data.load(file)?,
            _ => return Err(file.place(0).error("neither .src nor .dat")),
        }
    }
    let start = files.first().map_or(Place::nowhere(), |file| file.place(0));
    if !krl.routines.contains_key(&main.to_uppercase()) {
        return Err(start.error(format!("no DEF {main} in the files")));
    }
    krl.routine(&main.to_uppercase(), 0)?;
    Ok(krl.log)
}

impl<'a> Krl<'a> {
    fn load_source(&mut self, file: &'a SourceFile) -> Result<(), ReplayError> {
        let mut open: Option<(String, Routine<'a>)> = None;
        for (place, line) in file.lines() {
            let (code, _) = split_comment(line, ";");
            let head = code.to_uppercase();
            let head = head.strip_prefix("GLOBAL ").unwrap_or(&head);
            // Lines of the file header: `&ACCESS RVP`.
            if code.starts_with('&') {
                continue;
            }
            if let Some(head) = head.strip_prefix("DEF ") {
                let name = head.split('(').next().unwrap_or_default().trim().to_owned();
                if !head.contains("()") && !head.replace(' ', "").contains("()") {
                    return Err(place.error("a routine with parameters is not interpreted"));
                }
                if open.is_some() {
                    return Err(place.error("DEF inside of DEF"));
                }
                let module = file.stem().to_uppercase();
                open = Some((
                    name,
                    Routine {
                        module,
                        lines: Vec::new(),
                    },
                ));
            } else if head == "END" {
                let (name, routine) = open.take().ok_or_else(|| place.error("END without DEF"))?;
                if self.routines.insert(name.clone(), routine).is_some() {
                    return Err(place.error(format!("{name} is defined twice")));
                }
            } else if let Some((_, routine)) = &mut open {
                routine.lines.push((place, line));
            } else if !code.is_empty() {
                return Err(place.error(format!("`{code}` is outside of DEF and END")));
            }
        }
        match open {
            Some((name, _)) => Err(file.place(0).error(format!("DEF {name} has no END"))),
            None => Ok(()),
        }
    }

    fn routine(&mut self, name: &str, depth: usize) -> Result<(), ReplayError> {
        let routine = &self.routines[name];
        let module = routine.module.clone();
        let lines = routine.lines.clone();
        if depth > DEPTH {
            let place = lines.first().map(|(place, _)| place.clone());
            return Err(place
                .unwrap_or(Place::nowhere())
                .error(format!("more than {DEPTH} calls inside each other")));
        }
        for (place, line) in lines {
            let (code, comment) = split_comment(line, ";");
            if !code.is_empty() {
                let mut cursor = Cursor::new(code, &place)?;
                if cursor.eat_name("RETURN") {
                    return cursor.end();
                }
                self.statement(&mut cursor, &module, depth)?;
                cursor.end()?;
            }
            // Folds only fold lines in the editor.
            if let Some(text) = comment
                && !text.to_uppercase().starts_with("FOLD")
                && !text.to_uppercase().starts_with("ENDFOLD")
                && !text.is_empty()
            {
                self.log.comment(&place, text);
            }
        }
        Ok(())
    }

    fn statement(&mut self, cursor: &mut Cursor, module: &str, depth: usize) -> Result<(), ReplayError> {
        let place = cursor.place().clone();
        let advance = std::mem::take(&mut self.advance);
        if is_declaration(cursor) {
            return self.data.declaration(cursor, module);
        }
        // Before a declaration: valid in all programs.
        cursor.eat_name("GLOBAL");
        if cursor.eat_name("CONTINUE") {
            self.advance = true;
        } else if cursor.eat_name("HALT") {
            self.log.settle();
            self.log.stop(&place);
        } else if cursor.eat_name("WAIT") {
            // Both stop the advance run, so that the last move is not approximated: industrialmonitordirect.com,
            // knowledge base, "LIN movement stops between points" and "advance run pointer".
            if !advance {
                self.log.settle();
            }
            if cursor.eat_name("SEC") {
                let s = self.data.value(cursor, module)?.number(cursor)?;
                self.log.push(&place, Action::Dwell { s });
            } else if cursor.eat_name("FOR") {
                let condition = cursor.rest();
                self.log.push(&place, Action::Wait { condition });
            } else {
                return Err(cursor.unexpected("SEC or FOR"));
            }
        } else if cursor.eat_name("PTP") {
            let target = self.data.value(cursor, module)?;
            let joint = self.motion.ptp(cursor, &target)?;
            self.log.push(&place, Action::Joint(joint));
        } else if cursor.eat_name("LIN") {
            let target = self.data.value(cursor, module)?;
            let target = self.motion.cartesian(cursor, &target)?;
            let linear = self.motion.linear(cursor, &target)?;
            self.log.push(&place, Action::Linear(linear));
        } else if cursor.eat_name("LIN_REL") {
            let target = self.data.value(cursor, module)?;
            let target = self.motion.moved(cursor, &target)?;
            let linear = self.motion.linear(cursor, &target)?;
            self.log.push(&place, Action::Linear(linear));
        } else if cursor.eat_name("CIRC") {
            let via = self.data.value(cursor, module)?;
            let via = frame(cursor, &self.motion.completed(cursor, &via)?)?;
            cursor.expect(",")?;
            let target = self.data.value(cursor, module)?;
            let target = self.motion.cartesian(cursor, &target)?;
            let end = self.motion.linear(cursor, &target)?;
            self.log.push(&place, Action::Circular { via, end });
        } else if cursor.sees_name("INTERRUPT") {
            let name = cursor.name()?;
            let arguments = vec![cursor.rest()];
            self.log.push(&place, Action::Call { name, arguments });
        } else {
            return self.assignment_or_call(cursor, module, depth, advance);
        }
        Ok(())
    }

    fn assignment_or_call(
        &mut self,
        cursor: &mut Cursor,
        module: &str,
        depth: usize,
        advance: bool,
    ) -> Result<(), ReplayError> {
        let place = cursor.place().clone();
        let written = match cursor.peek() {
            Some(Word::Name(name)) => name.clone(),
            _ => return Err(cursor.unexpected("a statement")),
        };
        let name = self.data.variable(cursor, module)?;
        if cursor.eat("(") {
            if name == "BAS" {
                self.bas(cursor, module)?;
                return cursor.expect(")");
            }
            return self.call(cursor, &written, depth);
        }
        if !cursor.eat("=") {
            return Err(cursor.error(format!("unknown statement `{written}`")));
        }
        let value = self.data.value(cursor, module)?;
        let output = self.data.output(&name);
        if output.starts_with("$OUT[") || output.starts_with("$ANOUT[") {
            // An output stops the advance run: the last move is not approximated.
            if !advance {
                self.log.settle();
            }
            let value = value
                .as_output()
                .ok_or_else(|| cursor.error("an output is TRUE, FALSE or a number"))?;
            self.log.output(&place, output, value);
            return Ok(());
        }
        self.assign(cursor, module, name, value)
    }

    fn call(&mut self, cursor: &mut Cursor, name: &str, depth: usize) -> Result<(), ReplayError> {
        let place = cursor.place().clone();
        let mut arguments = Vec::new();
        let mut open = 1;
        let inside = cursor.rest();
        let mut piece = String::new();
        let mut quoted = false;
        for letter in inside.chars() {
            match letter {
                '"' => quoted = !quoted,
                '(' | '{' | '[' if !quoted => open += 1,
                ')' | '}' | ']' if !quoted => open -= 1,
                _ => {}
            }
            if open == 0 || open == 1 && letter == ',' && !quoted {
                arguments.push(std::mem::take(&mut piece));
            } else {
                piece.push(letter);
            }
        }
        if open != 0 || !piece.is_empty() {
            return Err(place.error(format!("the call of {name} does not end with `)`")));
        }
        arguments.retain(|argument| !argument.is_empty());
        if self.routines.contains_key(&name.to_uppercase()) {
            return self.routine(&name.to_uppercase(), depth + 1);
        }
        let texts: Vec<String> = arguments
            .iter()
            .filter_map(|argument| Some(argument.strip_prefix('"')?.strip_suffix('"')?.to_owned()))
            .collect();
        let name = name.to_owned();
        // The user messages of KUKA: MsgNotify, MsgQuit, MsgState, MsgDialog, MsgLoop.
        let is_message = name.to_uppercase().starts_with("MSG");
        self.log.push(&place, Action::Call { name, arguments });
        if is_message && let Some(text) = texts.first() {
            self.log.note(text.clone());
        }
        Ok(())
    }

    fn assign(
        &mut self,
        cursor: &Cursor,
        module: &str,
        name: String,
        value: Value,
    ) -> Result<(), ReplayError> {
        let root = name.split(['[', '.']).next().unwrap_or_default();
        let state = &mut self.motion;
        match name.as_str() {
            "$BASE" | "$TOOL" => {
                let Value::Record(record) = &value else {
                    return Err(cursor.error(format!("{name} needs a frame")));
                };
                let reference = Reference {
                    unit: record.get(UNIT).map(f64::to_string),
                    ..Reference::new(name.clone(), Some(frame(cursor, record)?))
                };
                let of = if name == "$BASE" {
                    &mut state.base
                } else {
                    &mut state.tool
                };
                *of = reference;
            }
            "$VEL.CP" => state.path_speed = Some(value.number(cursor)?),
            "$APO.CDIS" => state.distance = Some(value.number(cursor)?),
            "$APO.CPTP" => state.percent = Some(value.number(cursor)?),
            "$IPO_MODE" if value != Value::Text("#BASE".to_owned()) => {
                return Err(cursor.error("only $IPO_MODE=#BASE is interpreted"));
            }
            _ if root == "$VEL_AXIS" => {
                let axis = name.trim_start_matches("$VEL_AXIS[").trim_end_matches(']');
                let axis = axis
                    .parse()
                    .map_err(|_| cursor.error("an axis of 1 to 6 expected"))?;
                state.axis_speed.insert(axis, value.number(cursor)?);
            }
            _ if root.starts_with('$') && !SYSTEM.contains(&root) => {
                return Err(cursor.error(format!("unknown system variable `{name}`")));
            }
            _ => {}
        }
        self.data.set(cursor, module, &name, value)
    }

    /// The routine of the controller that inline forms use.
    fn bas(&mut self, cursor: &mut Cursor, module: &str) -> Result<(), ReplayError> {
        cursor.expect("#")?;
        let command = cursor.name()?.to_uppercase();
        let argument = if cursor.eat(",") {
            Some(self.data.value(cursor, module)?.number(cursor)?)
        } else {
            None
        };
        let given = || argument.ok_or_else(|| cursor.error(format!("BAS(#{command}) needs a number")));
        match command.as_str() {
            "INITMOV" => {
                self.motion = Motion::default();
            }
            "BASE" => self.motion.base = self.numbered(cursor, "BASE", given()?)?,
            "TOOL" => self.motion.tool = self.numbered(cursor, "TOOL", given()?)?,
            // m/s, the only percentage being that of the axes.
            "VEL_CP" | "CP_PARAMS" => self.motion.path_speed = Some(given()?),
            "VEL_PTP" | "PTP_PARAMS" => {
                let percent = given()?;
                self.motion.axis_speed = (1..=6).map(|axis| (axis, percent)).collect();
            }
            "ACC_CP" | "ACC_PTP" => {
                given()?;
            }
            "FRAMES" | "PTP_DAT" | "CP_DAT" => {}
            _ => return Err(cursor.error(format!("unknown BAS(#{command})"))),
        }
        if matches!(command.as_str(), "FRAMES" | "CP_PARAMS" | "PTP_PARAMS")
            && let Some(Value::Record(frames)) = self.data.known("FDAT_ACT", module)
        {
            let number = |key: &str| frames.get(key).copied();
            if let Some(base) = number("BASE_NO") {
                self.motion.base = self.numbered(cursor, "BASE", base)?;
            }
            if let Some(tool) = number("TOOL_NO") {
                self.motion.tool = self.numbered(cursor, "TOOL", tool)?;
            }
        }
        Ok(())
    }

    /// Number 0 is the null frame; the value of another number is known if the program sets it.
    fn numbered(&self, cursor: &Cursor, kind: &str, number: f64) -> Result<Reference, ReplayError> {
        if number == 0.0 {
            return Ok(Reference::new("0", Some(Pose::IDENTITY)));
        }
        let pose = match self.data.known(&format!("{kind}_DATA[{number}]"), "") {
            Some(Value::Record(record)) => Some(frame(cursor, &record)?),
            _ => None,
        };
        Ok(Reference::new(number.to_string(), pose))
    }
}
