//! ABB RAPID: modules with data and procedures.
//!
//! Sources: Technical reference manual, RAPID instructions, functions and data types (3HAC16581-1), RAPID overview
//! (3HAC16580-1) and RAPID kernel (3HAC16585-1); all [recalled].
//!
//! Not interpreted: branches, loops, functions, parameters of procedures.

mod data;
mod motion;
mod records;
mod target;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use self::data::Data;
use self::motion::{move_axes, move_pose};
use crate::event::Action;
use crate::log::Log;
use crate::source::{Place, ReplayError, SourceFile};
use crate::value::{Value, truth_word};
use crate::words::{Cursor, Word};

const DEPTH: usize = 32;
/// Words and beginnings of instructions that change the path, the speed or the order of statements: never a call of a
/// routine of the controller.
const NOT_INTERPRETED: [&str; 26] = [
    "MOVE",
    "TRIGG",
    "SEARCH",
    "PDISP",
    "EOFFS",
    "PATH",
    "STOREPATH",
    "RESTOPATH",
    "SOFTACT",
    "CORR",
    "INDA",
    "INDR",
    "INDC",
    "VELSET",
    "WORLDACC",
    "GOTO",
    "IF",
    "FOR",
    "WHILE",
    "TEST",
    "RAISE",
    "RETRY",
    "EXIT",
    "CONNECT",
    "TPREAD",
    "STOPMOVE",
];

struct Routine {
    module: String,
    statements: Vec<(Place, String)>,
}

struct Rapid {
    routines: BTreeMap<String, Routine>,
    data: Data,
    log: Log,
}

pub fn run(files: &[SourceFile], main: &str, log: Log) -> Result<Log, ReplayError> {
    let mut rapid = Rapid {
        routines: BTreeMap::new(),
        data: Data::default(),
        log,
    };
    for file in files {
        rapid.load(file)?;
    }
    let start = files.first().map_or(Place::nowhere(), |file| file.place(0));
    if !rapid.routines.contains_key(&main.to_uppercase()) {
        return Err(start.error(format!("no PROC {main} in the files")));
    }
    rapid.routine(&main.to_uppercase(), 0)?;
    Ok(rapid.log)
}

/// Statements and headers with their places; comments begin with `!`.
fn statements(file: &SourceFile) -> Result<Vec<(Place, String)>, ReplayError> {
    let mut all = Vec::new();
    let mut open: Option<(Place, String)> = None;
    let mut in_header = false;
    for (place, line) in file.lines() {
        // `%%%` encloses version and language of old files.
        if line.trim() == "%%%" {
            in_header = !in_header;
            continue;
        }
        if in_header {
            continue;
        }
        let mut quoted = false;
        for letter in line.chars() {
            let text = &mut open.get_or_insert_with(|| (place.clone(), String::new())).1;
            if text.trim_start().starts_with('!') {
                text.push(letter);
                continue;
            }
            match letter {
                '"' => quoted = !quoted,
                '!' if !quoted => {
                    if let Some(before) = open.take().filter(|(_, text)| !text.trim().is_empty()) {
                        all.push(before);
                    }
                    open = Some((place.clone(), "!".to_owned()));
                    continue;
                }
                ';' if !quoted => {
                    let (place, text) = open.take().unwrap_or((place.clone(), String::new()));
                    all.push((place, format!("{};", text.trim())));
                    continue;
                }
                _ => {}
            }
            text.push(letter);
        }
        let Some((begun, text)) = &mut open else { continue };
        let trimmed = text.trim();
        let word = trimmed
            .split_whitespace()
            .next()
            .unwrap_or_default()
            .to_uppercase();
        let second = trimmed
            .split_whitespace()
            .nth(1)
            .unwrap_or_default()
            .to_uppercase();
        let header = matches!(word.as_str(), "MODULE" | "ENDMODULE" | "PROC" | "ENDPROC")
            || word == "LOCAL" && second == "PROC";
        // Their lines do not end with a semicolon.
        if matches!(word.as_str(), "IF" | "FOR" | "WHILE" | "TEST") {
            return Err(begun.error(format!("the instruction `{word}` is not interpreted")));
        }
        if trimmed.is_empty() {
            open = None;
        } else if header || trimmed.starts_with('!') {
            all.push((begun.clone(), trimmed.to_owned()));
            open = None;
        } else {
            text.push(' ');
        }
    }
    match open {
        Some((place, text)) => Err(place.error(format!("`{}` does not end with `;`", text.trim()))),
        None => Ok(all),
    }
}

impl Rapid {
    fn load(&mut self, file: &SourceFile) -> Result<(), ReplayError> {
        let mut module: Option<String> = None;
        let mut open: Option<(String, Routine)> = None;
        for (place, text) in statements(file)? {
            let comment = text.starts_with('!');
            let mut cursor = Cursor::new(if comment { "" } else { &text }, &place)?;
            if cursor.eat_name("MODULE") {
                module = Some(cursor.name()?.to_uppercase());
                cursor.rest();
            } else if cursor.eat_name("ENDMODULE") {
                module
                    .take()
                    .ok_or_else(|| cursor.error("ENDMODULE without MODULE"))?;
            } else if cursor.sees_name("PROC") || text.to_uppercase().starts_with("LOCAL PROC") {
                cursor.eat_name("LOCAL");
                cursor.eat_name("PROC");
                let name = cursor.name()?.to_uppercase();
                cursor.expect("()")?;
                let module = module
                    .clone()
                    .ok_or_else(|| cursor.error("PROC outside of MODULE"))?;
                let statements = Vec::new();
                if open.replace((name, Routine { module, statements })).is_some() {
                    return Err(cursor.error("PROC inside of PROC"));
                }
            } else if cursor.eat_name("ENDPROC") {
                let (name, routine) = open.take().ok_or_else(|| cursor.error("ENDPROC without PROC"))?;
                if self.routines.insert(name.clone(), routine).is_some() {
                    return Err(cursor.error(format!("{name} is defined twice")));
                }
            } else if let Some((_, routine)) = &mut open {
                routine.statements.push((place, text));
                continue;
            } else if comment {
                continue;
            } else {
                let module = module
                    .clone()
                    .ok_or_else(|| cursor.error("data outside of MODULE"))?;
                if !self.data.declaration(&mut cursor, &module)? {
                    return Err(cursor.error(format!("`{text}` is outside of PROC and ENDPROC")));
                }
            }
            cursor.end()?;
        }
        // The samples of a public postprocessor have no ENDMODULE; a PROC must end.
        match open {
            Some((name, _)) => Err(file.place(0).error(format!("PROC {name} has no ENDPROC"))),
            None => Ok(()),
        }
    }

    fn routine(&mut self, name: &str, depth: usize) -> Result<(), ReplayError> {
        let routine = &self.routines[name];
        let scope = format!("{}.{name}", routine.module);
        for (place, text) in routine.statements.clone() {
            if depth > DEPTH {
                return Err(place.error(format!("more than {DEPTH} calls inside each other")));
            }
            if let Some(comment) = text.strip_prefix('!') {
                self.log.comment(&place, comment);
                continue;
            }
            let mut cursor = Cursor::new(&text, &place)?;
            if cursor.eat(";") || self.data.declaration(&mut cursor, &scope)? {
                cursor.end()?;
                continue;
            }
            if cursor.sees_name("RETURN") {
                return Ok(());
            }
            self.statement(&mut cursor, &scope, depth)?;
            cursor.expect(";")?;
            cursor.end()?;
        }
        Ok(())
    }

    fn statement(&mut self, cursor: &mut Cursor, module: &str, depth: usize) -> Result<(), ReplayError> {
        let place = cursor.place().clone();
        let Some(Word::Name(name)) = cursor.peek().cloned() else {
            return Err(cursor.unexpected("a statement"));
        };
        if self.data.knows(&name, module) {
            return self.data.assign(cursor, module);
        }
        cursor.name()?;
        match name.to_uppercase().as_str() {
            "MOVEABSJ" => {
                let action = move_axes(&self.data, cursor, module)?;
                self.log.push(&place, action);
            }
            "MOVEJ" | "MOVEL" | "MOVEC" => {
                let action = move_pose(&self.data, cursor, module, &name.to_uppercase())?;
                self.log.push(&place, action);
            }
            // How postures are supervised, how fast speeds change: nothing of the path.
            "CONFJ" | "CONFL" | "SINGAREA" | "ACCSET" | "MOTIONSUP" | "TPERASE" => {
                while !cursor.sees(";") {
                    if cursor.at_end() {
                        return Err(cursor.unexpected("`;`"));
                    }
                    cursor.eat(",");
                    if cursor.eat("\\") {
                        cursor.name()?;
                        cursor.eat(":=");
                    } else {
                        self.data.value(cursor, module)?;
                    }
                }
            }
            "SETDO" | "SETAO" | "SETGO" => {
                if cursor.sees("\\") {
                    return Err(cursor.error("a delayed or synchronised output is not interpreted"));
                }
                let output = cursor.name()?;
                cursor.expect(",")?;
                // `high` and `low` are 1 and 0.
                let value = if cursor.eat_name("high") {
                    1.0
                } else if cursor.eat_name("low") {
                    0.0
                } else {
                    self.data.value(cursor, module)?.number(cursor)?
                };
                let is_digital = name.eq_ignore_ascii_case("SetDO");
                let value = if is_digital {
                    truth_word(value != 0.0)
                } else {
                    value.to_string()
                };
                self.log.output(&place, output, value);
            }
            "SET" | "RESET" => {
                let output = cursor.name()?;
                self.log
                    .output(&place, output, truth_word(name.eq_ignore_ascii_case("Set")));
            }
            "WAITTIME" => {
                cursor.eat("\\");
                if cursor.eat_name("InPos") {
                    cursor.eat(",");
                }
                let s = self.data.value(cursor, module)?.number(cursor)?;
                // A corner path before a wait becomes a stop point.
                self.log.settle();
                self.log.push(&place, Action::Dwell { s });
            }
            "WAITDI" | "WAITUNTIL" => {
                let condition = self.rest(cursor);
                self.log.settle();
                self.log.push(&place, Action::Wait { condition });
            }
            "STOP" => {
                cursor.eat("\\");
                cursor.eat_name("NoRegain");
                self.log.settle();
                self.log.stop(&place);
            }
            "TPWRITE" => {
                let text = self.data.value(cursor, module)?;
                let Value::Text(text) = text else {
                    return Err(cursor.error("TPWrite needs a string"));
                };
                self.log.message(&place, text);
            }
            // Waits until the operator confirms.
            "UIMSGBOX" => {
                let Value::Text(text) = self.data.value(cursor, module)? else {
                    return Err(cursor.error("UIMsgBox needs a string"));
                };
                self.rest(cursor);
                self.log.settle();
                self.log.note(text);
                self.log.stop(&place);
            }
            _ => return self.call(cursor, &name, depth),
        }
        Ok(())
    }

    /// Everything before the semicolon, as written.
    fn rest(&self, cursor: &mut Cursor) -> String {
        let rest = cursor.rest();
        let text = rest.trim_end_matches(';').to_owned();
        // The caller checks for the semicolon.
        if let Ok(again) = Cursor::new(";", cursor.place()) {
            *cursor = again;
        }
        text
    }

    fn call(&mut self, cursor: &mut Cursor, name: &str, depth: usize) -> Result<(), ReplayError> {
        let place = cursor.place().clone();
        let capitals = name.to_uppercase();
        let is_own = self.routines.contains_key(&capitals);
        if !is_own
            && NOT_INTERPRETED
                .iter()
                .any(|beginning| capitals.starts_with(beginning))
        {
            return Err(cursor.error(format!("the instruction `{name}` is not interpreted")));
        }
        if cursor.sees(":=") || cursor.sees("(") {
            return Err(cursor.error(format!("unknown statement `{name}`")));
        }
        if self.routines.contains_key(&name.to_uppercase()) {
            if !cursor.sees(";") {
                return Err(cursor.error("a call with arguments is not interpreted"));
            }
            return self.routine(&name.to_uppercase(), depth + 1);
        }
        let arguments = self.rest(cursor);
        let arguments = if arguments.is_empty() {
            Vec::new()
        } else {
            vec![arguments]
        };
        let name = name.to_owned();
        self.log.push(&place, Action::Call { name, arguments });
        Ok(())
    }
}
