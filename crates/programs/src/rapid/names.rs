//! Values of names: data of all modules, as declared and assigned.

use std::collections::{BTreeMap, HashMap};

use super::value::{Node, Reference, Step, Value};

/// Maximum length of a chain of names.
const MOST_LINKS: usize = 16;

/// Data of all modules, by name, then by text: two modules may each have a tool with the same name.
#[derive(Default)]
pub(super) struct Names(HashMap<String, BTreeMap<usize, Bound>>);

struct Bound {
    node: Node,
    /// The text that contains it.
    text: usize,
    /// Whether parts of it were assigned: it is written in more than one place.
    is_changed: bool,
}

/// Value of an expression.
#[derive(Clone, Copy)]
pub(super) struct Definition<'n> {
    pub node: &'n Node,
    /// The text that contains it.
    pub text: usize,
    /// Whether it is written only there.
    pub is_whole: bool,
}

impl Names {
    /// Sets the value of the name in this text.
    pub fn put(&mut self, name: String, node: Node, text: usize) {
        let bound = Bound {
            node,
            text,
            is_changed: false,
        };
        self.0.entry(name).or_default().insert(text, bound);
    }

    /// Whether any module declares it.
    pub fn knows(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// Assigns a part of the value of a name; no effect if the name or the part is not known.
    pub fn change(&mut self, reference: &Reference, node: Node, text: usize) {
        let Some(modules) = self.0.get_mut(&reference.name) else {
            return;
        };
        let key = match modules.contains_key(&text) {
            true => Some(text),
            false => modules.keys().next().copied(),
        };
        let Some(bound) = key.and_then(|key| modules.get_mut(&key)) else {
            return;
        };
        bound.is_changed = true;
        let mut part = &mut bound.node;
        for step in &reference.steps {
            let length = match &part.value {
                Value::List(all) => all.len(),
                _ => 0,
            };
            let index = index_of(step, length).filter(|index| *index < length);
            match (index, &mut part.value) {
                (Some(index), Value::List(all)) => part = &mut all[index],
                // The part is not known, so the whole is not known.
                (_, value) => {
                    *value = Value::Other;
                    return;
                }
            }
        }
        *part = node;
    }

    /// The value of an expression, with names resolved.
    pub fn look<'n>(&'n self, node: &'n Node, text: usize) -> Option<Definition<'n>> {
        let mut found = Definition {
            node,
            text,
            is_whole: true,
        };
        for _ in 0..MOST_LINKS {
            let Value::Name(reference) = &found.node.value else {
                return Some(found);
            };
            let modules = self.0.get(&reference.name)?;
            let bound = modules.get(&found.text).or_else(|| modules.values().next())?;
            found = Definition {
                node: &bound.node,
                text: bound.text,
                is_whole: found.is_whole && !bound.is_changed,
            };
            for step in &reference.steps {
                found.node = self.part(found, step)?;
            }
        }
        None
    }

    fn part<'n>(&'n self, found: Definition<'n>, step: &Step) -> Option<&'n Node> {
        match &found.node.value {
            Value::List(all) => all.get(index_of(step, all.len())?),
            _ => None,
        }
    }
}

/// The index of the entry that a step selects in a record or array of this length.
fn index_of(step: &Step, length: usize) -> Option<usize> {
    let field = match step {
        Step::Index(index) => return Some(index - 1),
        Step::Unknown => return None,
        Step::Field(field) => field,
    };
    Some(match field.as_str() {
        "trans" | "x" | "q1" | "cf1" | "robax" | "v_tcp" | "robhold" | "rax_1" | "eax_a" => 0,
        "rot" | "y" | "q2" | "cf4" | "tframe" | "ufprog" | "rax_2" | "eax_b" => 1,
        "z" | "q3" | "cf6" | "robconf" | "tload" | "ufmec" | "rax_3" | "eax_c" => 2,
        "q4" | "cfx" | "uframe" | "rax_4" | "eax_d" => 3,
        "oframe" | "rax_5" | "eax_e" => 4,
        "rax_6" | "eax_f" => 5,
        // The last entry of targets and of joints.
        "extax" => length.checked_sub(1)?,
        _ => return None,
    })
}
