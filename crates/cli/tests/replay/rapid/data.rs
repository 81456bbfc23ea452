//! Data of RAPID: declarations, values, assignments.
//!
//! Source: Technical reference manual, RAPID kernel (3HAC16585-1) [recalled].

use std::collections::BTreeMap;

use super::records::{field, predefined};
use super::target::moved;
use crate::source::ReplayError;
use crate::value::{Value, expression};
use crate::words::Cursor;

#[derive(Clone)]
struct Datum {
    kind: String,
    constant: bool,
    value: Value,
}

/// Data by scope (`MODULE` or `MODULE.PROC`) and name in capital letters; global data in the scope without name.
#[derive(Default)]
pub struct Data {
    data: BTreeMap<(String, String), Datum>,
}

impl Data {
    /// `[LOCAL|TASK] PERS|CONST|VAR type name[{n}] [:= value];`; false if it is none.
    pub fn declaration(&mut self, cursor: &mut Cursor, module: &str) -> Result<bool, ReplayError> {
        let local = cursor.eat_name("LOCAL");
        cursor.eat_name("TASK");
        let constant = cursor.eat_name("CONST");
        if !constant && !cursor.eat_name("PERS") && !cursor.eat_name("VAR") {
            return Ok(false);
        }
        let kind = cursor.name()?.to_lowercase();
        let name = cursor.name()?.to_uppercase();
        let length = if cursor.eat("{") {
            let length = cursor.count()?;
            cursor.expect("}")?;
            Some(length as usize)
        } else {
            None
        };
        let value = if cursor.eat(":=") {
            self.value(cursor, module)?
        } else {
            Value::List(Vec::new())
        };
        if let (Some(length), Value::List(values)) = (length, &value)
            && values.len() != length
        {
            return Err(cursor.error(format!("{name} has {} values, {length} declared", values.len())));
        }
        cursor.expect(";")?;
        let scope = if local || module.contains('.') { module } else { "" };
        self.data.insert(
            (scope.to_owned(), name),
            Datum {
                kind,
                constant,
                value,
            },
        );
        Ok(true)
    }

    fn known(&self, name: &str, module: &str) -> Option<Datum> {
        let name = name.to_uppercase();
        [module, module.split('.').next().unwrap_or_default(), ""]
            .iter()
            .find_map(|scope| self.data.get(&((*scope).to_owned(), name.clone())))
            .cloned()
            .or_else(|| {
                let (kind, value) = predefined(&name)?;
                Some(Datum {
                    kind: kind.to_owned(),
                    constant: true,
                    value,
                })
            })
    }

    pub fn value(&self, cursor: &mut Cursor, module: &str) -> Result<Value, ReplayError> {
        expression(cursor, &mut |cursor| self.atom(cursor, module))
    }

    fn atom(&self, cursor: &mut Cursor, module: &str) -> Result<Value, ReplayError> {
        if cursor.eat("[") {
            let mut values = vec![self.value(cursor, module)?];
            while cursor.eat(",") {
                values.push(self.value(cursor, module)?);
            }
            cursor.expect("]")?;
            return Ok(Value::List(values));
        }
        let name = cursor.name()?;
        if cursor.eat("(") {
            let mut given = vec![self.value(cursor, module)?];
            while cursor.eat(",") {
                given.push(self.value(cursor, module)?);
            }
            let mut turns = [0.0; 3];
            for (turn, switch) in turns.iter_mut().zip(["Rx", "Ry", "Rz"]) {
                if cursor.eat("\\") {
                    if !cursor.eat_name(switch) {
                        return Err(cursor.unexpected(switch));
                    }
                    cursor.expect(":=")?;
                    *turn = self.value(cursor, module)?.number(cursor)?;
                }
            }
            cursor.expect(")")?;
            return moved(cursor, &name, &given, turns);
        }
        let known = self
            .known(&name, module)
            .ok_or_else(|| cursor.error(format!("`{name}` is not defined in these files")))?;
        let mut kind = known.kind;
        let mut value = known.value;
        while cursor.sees("{") || cursor.sees(".") {
            let (index, inner) = self.part(cursor, &kind, module)?;
            kind = inner;
            let Value::List(mut values) = value else {
                return Err(cursor.error(format!("`{name}` has no parts")));
            };
            if index >= values.len() {
                return Err(cursor.error(format!("`{name}` has {} parts, not {}", values.len(), index + 1)));
            }
            value = values.swap_remove(index);
        }
        Ok(value)
    }

    /// `{3}` or `.uframe`: the index from 0, and the type of the part.
    fn part(&self, cursor: &mut Cursor, kind: &str, module: &str) -> Result<(usize, String), ReplayError> {
        if cursor.eat("{") {
            let index = self.value(cursor, module)?.number(cursor)?;
            cursor.expect("}")?;
            if index < 1.0 || index.fract() != 0.0 {
                return Err(cursor.error(format!("{index} is not an index; indices begin with 1")));
            }
            return Ok((index as usize - 1, kind.to_owned()));
        }
        cursor.expect(".")?;
        let name = cursor.name()?;
        let (index, inner) = field(kind, &name)
            .ok_or_else(|| cursor.error(format!("`{name}` is not a component of {kind}")))?;
        Ok((index, inner.to_owned()))
    }

    /// Whether a variable or constant has this name.
    pub fn knows(&self, name: &str, module: &str) -> bool {
        self.known(name, module).is_some()
    }

    /// `name{i}.component := value`.
    pub fn assign(&mut self, cursor: &mut Cursor, module: &str) -> Result<(), ReplayError> {
        let name = cursor.name()?.to_uppercase();
        let mut path = Vec::new();
        let known = self
            .known(&name, module)
            .ok_or_else(|| cursor.error(format!("`{name}` is not defined")))?;
        let mut kind = known.kind.clone();
        while cursor.sees("{") || cursor.sees(".") {
            let (index, inner) = self.part(cursor, &kind, module)?;
            path.push(index);
            kind = inner;
        }
        cursor.expect(":=")?;
        if known.constant {
            return Err(cursor.error(format!("`{name}` is a constant")));
        }
        let value = self.value(cursor, module)?;
        let scope = [module, module.split('.').next().unwrap_or_default(), ""]
            .into_iter()
            .find(|scope| self.data.contains_key(&((*scope).to_owned(), name.clone())))
            .unwrap_or_default();
        let Some(data) = self.data.get_mut(&(scope.to_owned(), name.clone())) else {
            return Err(cursor.error(format!("`{name}` is not defined")));
        };
        let mut target = &mut data.value;
        for index in path {
            let Value::List(values) = target else {
                return Err(cursor.error(format!("`{name}` has no parts")));
            };
            target = values
                .get_mut(index)
                .ok_or_else(|| cursor.error(format!("`{name}` has no such part")))?;
        }
        *target = value;
        Ok(())
    }
}
