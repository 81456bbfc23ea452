//! Variables of KRL: declarations, data lists, aggregates, the geometric operator.
//!
//! Source: KRL reference guide of KR C2 / KR C3 (release 4.1), declarations and structures [recalled].

use std::collections::BTreeMap;

use super::motion::{Record, frame, record_of};
use crate::pose::Pose;
use crate::source::{ReplayError, SourceFile};
use crate::value::{Value, expression};
use crate::words::{Cursor, Word, split_comment};

/// Types that a declaration may begin with.
const TYPES: [&str; 11] = [
    "DECL", "INT", "REAL", "BOOL", "CHAR", "FRAME", "POS", "E6POS", "AXIS", "E6AXIS", "SIGNAL",
];
/// Component of a frame that is coupled to an external kinematic system: its number.
pub const UNIT: &str = "UNIT";
/// Data of the inline forms, declared in the controller's own files.
const FORMS: [&str; 5] = ["PDAT_ACT", "FDAT_ACT", "LDAT_ACT", "BASE_DATA", "TOOL_DATA"];

#[derive(Default)]
pub struct Data {
    /// By module and name; global data in the module without name.
    values: BTreeMap<(String, String), Value>,
    signals: BTreeMap<String, String>,
}

/// Whether a declaration begins here.
pub fn is_declaration(cursor: &Cursor) -> bool {
    TYPES.iter().any(|word| cursor.sees_name(word))
}

impl Data {
    /// A data list: `.dat`.
    pub fn load(&mut self, file: &SourceFile) -> Result<(), ReplayError> {
        let module = file.stem().to_uppercase();
        for (place, line) in file.lines() {
            let (code, _) = split_comment(line, ";");
            let mut cursor = Cursor::new(code, &place)?;
            if code.is_empty() || code.starts_with('&') || cursor.eat_name("ENDDAT") {
                continue;
            }
            if cursor.eat_name("DEFDAT") {
                cursor.name()?;
                cursor.eat_name("PUBLIC");
            } else if is_declaration(&cursor) {
                self.declaration(&mut cursor, &module)?;
            } else {
                let name = self.variable(&mut cursor, &module)?;
                cursor.expect("=")?;
                let value = self.value(&mut cursor, &module)?;
                self.set(&cursor, &module, &name, value)?;
            }
            cursor.end()?;
        }
        Ok(())
    }

    /// `DECL [GLOBAL] TYPE name[=value]{,name[=value]}`, `SIGNAL name $OUT[n]`.
    pub fn declaration(&mut self, cursor: &mut Cursor, module: &str) -> Result<(), ReplayError> {
        if cursor.eat_name("SIGNAL") {
            let name = cursor.name()?.to_uppercase();
            let output = self.variable(cursor, module)?;
            self.signals.insert(name, output);
            return Ok(());
        }
        cursor.eat_name("DECL");
        let global = cursor.eat_name("GLOBAL");
        cursor.eat_name("CONST");
        cursor.name()?;
        let module = if global { "" } else { module };
        loop {
            let name = self.variable(cursor, module)?;
            if cursor.eat("=") {
                let value = self.value(cursor, module)?;
                self.values.insert((module.to_owned(), name), value);
            }
            if !cursor.eat(",") {
                return Ok(());
            }
        }
    }

    /// A variable with its index and components: `$VEL.CP`, `BASE_DATA[1]`, `$LOOP_MSG[]`.
    pub fn variable(&self, cursor: &mut Cursor, module: &str) -> Result<String, ReplayError> {
        let mut name = cursor.name()?.to_uppercase();
        loop {
            if cursor.eat("[") {
                let index = if cursor.sees("]") {
                    String::new()
                } else {
                    self.value(cursor, module)?.number(cursor)?.to_string()
                };
                cursor.expect("]")?;
                name.push_str(&format!("[{index}]"));
            } else if cursor.eat(".") {
                name.push_str(&format!(".{}", cursor.name()?.to_uppercase()));
            } else {
                return Ok(name);
            }
        }
    }

    pub fn value(&self, cursor: &mut Cursor, module: &str) -> Result<Value, ReplayError> {
        let mut left = expression(cursor, &mut |cursor| self.atom(cursor, module))?;
        // The geometric operator: the right frame is relative to the left one.
        while cursor.eat(":") {
            let right = expression(cursor, &mut |cursor| self.atom(cursor, module))?;
            let (Value::Record(one), Value::Record(other)) = (&left, &right) else {
                return Err(cursor.error("the operator : needs two frames"));
            };
            let pose = frame(cursor, one)?.then(&frame(cursor, other)?);
            left = Value::Record(record_of(&pose));
        }
        Ok(left)
    }

    fn atom(&self, cursor: &mut Cursor, module: &str) -> Result<Value, ReplayError> {
        if cursor.eat("#") {
            return Ok(Value::Text(format!("#{}", cursor.name()?.to_uppercase())));
        }
        if cursor.sees("{") {
            return self.aggregate(cursor, module);
        }
        if cursor.eat_name("EK") {
            return self.coupled(cursor, module);
        }
        let name = self.variable(cursor, module)?;
        if name == "$NULLFRAME" {
            return Ok(Value::Record(record_of(&Pose::IDENTITY)));
        }
        if name == "$AXIS_ACT" || name == "$POS_ACT" {
            return Ok(Value::Text(name));
        }
        self.known(&name, module)
            .ok_or_else(|| cursor.error(format!("`{name}` is not defined in these files")))
    }

    /// `EK(MACHINE_DEF[n].ROOT,MACHINE_DEF[n].MECH_TYPE,frame)`: a frame on the table of the external kinematic system n.
    fn coupled(&self, cursor: &mut Cursor, module: &str) -> Result<Value, ReplayError> {
        cursor.expect("(")?;
        let root = self.variable(cursor, module)?;
        cursor.expect(",")?;
        let kind = self.variable(cursor, module)?;
        cursor.expect(",")?;
        let machine = root
            .strip_prefix("MACHINE_DEF[")
            .and_then(|rest| rest.strip_suffix("].ROOT"));
        let number = machine.and_then(|number| number.parse::<f64>().ok());
        let number =
            number.ok_or_else(|| cursor.error("the root of an external kinematic system expected"))?;
        if kind != format!("MACHINE_DEF[{number}].MECH_TYPE") {
            return Err(cursor.error("root and type are of two machines"));
        }
        let Value::Record(mut frame) = self.value(cursor, module)? else {
            return Err(cursor.error("EK needs a frame"));
        };
        cursor.expect(")")?;
        frame.insert(UNIT.to_owned(), number);
        Ok(Value::Record(frame))
    }

    pub fn known(&self, name: &str, module: &str) -> Option<Value> {
        let of = |name: &str| {
            [module, ""]
                .iter()
                .find_map(|module| self.values.get(&((*module).to_owned(), name.to_owned())))
        };
        of(name).cloned().or_else(|| {
            let (name, component) = name.rsplit_once('.')?;
            match of(name)? {
                Value::Record(record) => record.get(component).map(|number| Value::Number(*number)),
                _ => None,
            }
        })
    }

    /// `{X 1,Y 2}`, `{FRAME: X 1}`, `{TOOL_NO 0,IPO_FRAME #BASE}`; components that are not numbers are left out.
    fn aggregate(&self, cursor: &mut Cursor, module: &str) -> Result<Value, ReplayError> {
        cursor.expect("{")?;
        let mut record = Record::new();
        loop {
            let name = cursor.name()?.to_uppercase();
            // The name of the type, and a colon.
            if record.is_empty() && cursor.eat(":") {
                continue;
            }
            if cursor.sees("[]") || matches!(cursor.peek(), Some(Word::Symbol('#'))) {
                cursor.eat("[]");
                self.value(cursor, module)?;
            } else if cursor.eat("'") {
                // 'B101' and 'H1F': a number by its bits.
                let word = cursor.name()?;
                let (base, digits) = word.split_at(1);
                let radix = if base.eq_ignore_ascii_case("B") { 2 } else { 16 };
                let bits = u32::from_str_radix(digits, radix)
                    .map_err(|_| cursor.error(format!("'{word}' is not a number")))?;
                cursor.expect("'")?;
                record.insert(name, f64::from(bits));
            } else {
                let number = self.value(cursor, module)?.number(cursor)?;
                if record.insert(name.clone(), number).is_some() {
                    return Err(cursor.error(format!("component {name} is given twice")));
                }
            }
            if !cursor.eat(",") {
                cursor.expect("}")?;
                return Ok(Value::Record(record));
            }
        }
    }

    /// The output that a signal is declared as, or the variable itself.
    pub fn output(&self, name: &str) -> String {
        self.signals.get(name).map_or(name, String::as_str).to_owned()
    }

    /// Sets a variable or a component.
    pub fn set(
        &mut self,
        cursor: &Cursor,
        module: &str,
        name: &str,
        value: Value,
    ) -> Result<(), ReplayError> {
        let scoped = |name: &str| {
            let root = name.split(['[', '.']).next().unwrap_or_default();
            let global = root.starts_with('$') || FORMS.contains(&root);
            (if global { "" } else { module }.to_owned(), name.to_owned())
        };
        if let Some((record, component)) = name.rsplit_once('.')
            && let Some(Value::Record(record)) = self.values.get_mut(&scoped(record))
        {
            record.insert(component.to_owned(), value.number(cursor)?);
            return Ok(());
        }
        self.values.insert(scoped(name), value);
        Ok(())
    }
}
