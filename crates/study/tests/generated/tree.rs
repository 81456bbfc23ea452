//! A study as a tree whose scalars are literals, valid or not, and as TOML text.

use serde_json::Value;

use super::random::Random;

/// A value of a study file.
#[derive(Clone, Debug)]
pub enum Node {
    /// A scalar, as it is written.
    Literal(String),
    List(Vec<Node>),
    Table(Vec<(String, Node)>),
}

impl Node {
    /// The same as this JSON value.
    pub fn of(value: &Value) -> Node {
        match value {
            Value::Array(entries) => Node::List(entries.iter().map(Node::of).collect()),
            Value::Object(fields) => {
                let field = |(key, value): (&String, &Value)| (key.clone(), Node::of(value));
                Node::Table(fields.iter().map(field).collect())
            }
            scalar => Node::Literal(scalar.to_string()),
        }
    }

    /// A text in quotes.
    pub fn text(text: &str) -> Node {
        Node::Literal(Value::from(text).to_string())
    }

    fn is_list_of_tables(&self) -> bool {
        let table = |entry: &Node| matches!(entry, Node::Table(_));
        matches!(self, Node::List(entries) if !entries.is_empty() && entries.iter().all(table))
    }

    /// The value on one line.
    fn inline(&self) -> String {
        match self {
            Node::Literal(text) => text.clone(),
            Node::List(entries) => {
                let entries: Vec<String> = entries.iter().map(Node::inline).collect();
                format!("[{}]", entries.join(", "))
            }
            Node::Table(fields) => {
                let field = |(name, value): &(String, Node)| format!("{} = {}", key(name), value.inline());
                let fields: Vec<String> = fields.iter().map(field).collect();
                format!("{{ {} }}", fields.join(", "))
            }
        }
    }
}

/// A key, in quotes if it needs them.
fn key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    match !name.is_empty() && name.chars().all(bare) {
        true => name.to_owned(),
        false => Value::from(name).to_string(),
    }
}

/// The text of a study: each table with a header, with dotted keys or on one line, as it happens.
pub fn written(study: &Node, random: &mut Random) -> String {
    let mut text = String::new();
    match study {
        Node::Table(fields) => write_table("", fields, random, &mut text),
        other => text.push_str(&other.inline()),
    }
    text
}

/// The fields of the table at `path`: those on lines of their own first, then those with headers.
fn write_table(path: &str, fields: &[(String, Node)], random: &mut Random, text: &mut String) {
    let mut with_headers = Vec::new();
    for (name, value) in fields {
        let (name, nested) = (key(name), matches!(value, Node::Table(_)));
        match value {
            _ if (nested || value.is_list_of_tables()) && random.chance(0.7) => {
                with_headers.push((name, value));
            }
            Node::Table(fields) if !fields.is_empty() && random.chance(0.5) => {
                for (inner, value) in fields {
                    text.push_str(&format!("{name}.{} = {}\n", key(inner), value.inline()));
                }
            }
            value => text.push_str(&format!("{name} = {}\n", value.inline())),
        }
    }
    for (name, value) in with_headers {
        let path = if path.is_empty() {
            name
        } else {
            format!("{path}.{name}")
        };
        match value {
            Node::Table(fields) => {
                text.push_str(&format!("\n[{path}]\n"));
                write_table(&path, fields, random, text);
            }
            Node::List(entries) => {
                for entry in entries {
                    text.push_str(&format!("\n[[{path}]]\n"));
                    if let Node::Table(fields) = entry {
                        write_table(&path, fields, random, text);
                    }
                }
            }
            Node::Literal(_) => {}
        }
    }
}
