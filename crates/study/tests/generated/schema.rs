//! The JSON schema of the study file, and values that follow it or break it.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::random::Random;
use super::tree::Node;

/// Tables within one another that are generated; optional ones deeper than this are left out.
const DEEPEST: usize = 6;

/// Literals that no schema of a number, or hardly any calculation, accepts.
#[rustfmt::skip]
const WILD: &[&str] = &[
    "nan", "-nan", "inf", "-inf", "1e400", "-1e400", "1e308", "-1e308", "1e154", "1e-320", "-0.0", "0", "-1", "9223372036854775807", "-9223372036854775808",
    "99999999999999999999", "0x7f", "1_000", "1e9", "1e10", "0,5", "1.5.2", "5 mm", "\"5\"", "+5", ".5", "5.", "true", "[]", "[[]]", "{}", "\"\"", "\" \"", "\"\\u0000\"",
    "\"\\u202e\"", "\"..\"", "\"/dev/zero\"", "\"/dev/stdin\"", "\".\"", "\"/\"", "'''\n'''", "1979-05-27", "07:32:00", "\"best\"", "\"é µ 日本\"", "", "=", "#",
];

/// Numbers that a study may well contain, whatever the key.
const USUAL: &[f64] = &[
    0.0, 0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 45.0, 90.0, 100.0, 180.0, 500.0, 900.0, -1.0, -30.0, -90.0,
];

/// The schema, and the values that good studies give to each key.
pub struct Schema {
    root: Value,
    /// By key, wherever it is.
    known: BTreeMap<String, Vec<Node>>,
}

impl Schema {
    /// This schema, with the values of these studies.
    pub fn new(text: &str, studies: &[Node]) -> Schema {
        let mut known = BTreeMap::new();
        for study in studies {
            collect(study, &mut known);
        }
        Schema {
            root: serde_json::from_str(text).unwrap(),
            known,
        }
    }

    /// The schema of the whole file.
    pub fn root(&self) -> &Value {
        &self.root
    }

    /// The schemas that a value may follow: references followed, alternatives listed, without null.
    fn alternatives<'a>(&'a self, schema: &'a Value) -> Vec<&'a Map<String, Value>> {
        let (mut found, mut open) = (Vec::new(), vec![schema]);
        while let Some(schema) = open.pop() {
            let Some(object) = schema.as_object() else {
                continue;
            };
            let reference = object.get("$ref").and_then(Value::as_str).unwrap_or_default();
            if let Some(name) = reference.strip_prefix("#/$defs/") {
                open.push(&self.root["$defs"][name]);
            }
            let lists = ["oneOf", "anyOf", "allOf"].map(|key| object.get(key).and_then(Value::as_array));
            open.extend(lists.into_iter().flatten().flatten());
            if ["type", "properties", "enum", "const"]
                .iter()
                .any(|key| object.contains_key(*key))
                && object.get("type") != Some(&Value::from("null"))
            {
                found.push(object);
            }
        }
        found
    }

    /// The fields that a table of this schema may have: those of alternatives whose tag differs from that of the table
    /// are left out.
    pub fn fields<'a>(&'a self, schema: &'a Value, table: &[(String, Node)]) -> Vec<(&'a str, &'a Value)> {
        let differs = |(name, field): (&String, &Value)| {
            let tag = field.get("const").map(Value::to_string);
            let own = table.iter().find(|(key, _)| key == name);
            matches!((tag, own), (Some(tag), Some((_, Node::Literal(own)))) if tag != *own)
        };
        let mut fields = Vec::new();
        for alternative in self.alternatives(schema) {
            let properties = alternative.get("properties").and_then(Value::as_object);
            if !properties.into_iter().flatten().any(differs) {
                fields.extend(
                    properties
                        .into_iter()
                        .flatten()
                        .map(|(key, field)| (key.as_str(), field)),
                );
            }
        }
        fields
    }

    /// The schema of the entries of a list; null if it is not known.
    pub fn entries<'a>(&'a self, schema: &'a Value) -> &'a Value {
        let lists = self.alternatives(schema).into_iter();
        lists
            .filter_map(|list| list.get("items"))
            .next()
            .unwrap_or(&Value::Null)
    }

    /// A value for this key: `wild` is the part of scalars that break the schema.
    pub fn value(&self, key: &str, schema: &Value, wild: f64, random: &mut Random) -> Node {
        if let Some(known) = self.known.get(key)
            && random.chance(0.5)
        {
            return self.varied(random.of(known).clone(), wild, random);
        }
        self.made(key, schema, Depth { level: 0, wild }, random)
    }

    /// A table or value that is known, with some of its scalars changed.
    fn varied(&self, node: Node, wild: f64, random: &mut Random) -> Node {
        match node {
            Node::Literal(_) if random.chance(wild) => wild_literal(random),
            Node::Literal(text) => match text.parse::<f64>() {
                Ok(number) if random.chance(0.15) => {
                    let factor = *random.of(&[0.0, -1.0, 0.5, 2.0, 0.1, 10.0, 1.001]);
                    Node::Literal(literal(number * factor, !text.contains(['.', 'e'])))
                }
                _ => Node::Literal(text),
            },
            Node::List(entries) => Node::List(
                entries
                    .into_iter()
                    .map(|entry| self.varied(entry, wild, random))
                    .collect(),
            ),
            Node::Table(fields) => {
                let mut varied = Vec::new();
                for (key, value) in fields {
                    if !random.chance(0.04) {
                        varied.push((key, self.varied(value, wild, random)));
                    }
                }
                Node::Table(varied)
            }
        }
    }

    /// A value made from the schema alone.
    fn made(&self, key: &str, schema: &Value, depth: Depth, random: &mut Random) -> Node {
        let alternatives = self.alternatives(schema);
        if alternatives.is_empty() || random.chance(depth.wild) {
            return wild_literal(random);
        }
        let chosen = *random.of(&alternatives);
        if let Some(only) = chosen.get("const") {
            return Node::of(only);
        }
        if let Some(words) = chosen.get("enum").and_then(Value::as_array) {
            return Node::of(random.of(words));
        }
        let kinds = match chosen.get("type") {
            Some(Value::Array(kinds)) => kinds.iter().filter_map(Value::as_str).collect(),
            kind => vec![kind.and_then(Value::as_str).unwrap_or("object")],
        };
        let kinds: Vec<&str> = kinds.into_iter().filter(|kind| *kind != "null").collect();
        match *random.of(&kinds) {
            "number" => Node::Literal(literal(self.number(key, chosen, depth.wild, random), false)),
            "integer" => Node::Literal(literal(self.number(key, chosen, depth.wild, random), true)),
            "boolean" => Node::Literal(random.chance(0.5).to_string()),
            "string" => self.text(key, random),
            "array" => self.list(key, chosen, depth, random),
            _ => self.table(chosen, depth, random),
        }
    }

    /// A list of about as many entries as it must or may have.
    fn list(&self, key: &str, schema: &Map<String, Value>, depth: Depth, random: &mut Random) -> Node {
        let count = |name: &str| {
            schema
                .get(name)
                .and_then(Value::as_u64)
                .and_then(|count| usize::try_from(count).ok())
        };
        let fewest = count("minItems").unwrap_or(0);
        let most = count("maxItems").unwrap_or(6).clamp(fewest, fewest.max(6));
        let mut entries = fewest + random.below(most - fewest + 1);
        if random.chance(depth.wild) {
            entries = (entries + random.below(3)).saturating_sub(1);
        }
        let first = schema.get("prefixItems").and_then(Value::as_array);
        let others = schema.get("items").unwrap_or(&Value::Null);
        let entry = |index: usize| first.and_then(|first| first.get(index)).unwrap_or(others);
        Node::List(
            (0..entries)
                .map(|index| self.made(key, entry(index), depth.below(), random))
                .collect(),
        )
    }

    /// A table with its required fields, and some others.
    fn table(&self, schema: &Map<String, Value>, depth: Depth, random: &mut Random) -> Node {
        let required = schema.get("required").and_then(Value::as_array);
        let is_required = |key: &str| required.into_iter().flatten().any(|name| name == key);
        let optional = if depth.level < DEEPEST {
            *random.of(&[0.05, 0.2, 0.5])
        } else {
            0.0
        };
        let mut fields = Vec::new();
        for (key, field) in schema
            .get("properties")
            .and_then(Value::as_object)
            .into_iter()
            .flatten()
        {
            let part = if is_required(key) {
                1.0 - 0.3 * depth.wild
            } else {
                optional
            };
            if random.chance(part) {
                let value = match self.known.get(key) {
                    Some(known) if random.chance(0.4) => {
                        self.varied(random.of(known).clone(), depth.wild, random)
                    }
                    _ => self.made(key, field, depth.below(), random),
                };
                fields.push((key.clone(), value));
            }
        }
        if random.chance(0.3 * depth.wild) {
            fields.push(("unknown".to_owned(), Node::Literal("1".to_owned())));
        }
        Node::Table(fields)
    }

    /// A number in, at or out of its limits.
    fn number(&self, key: &str, schema: &Map<String, Value>, wild: f64, random: &mut Random) -> f64 {
        let limit = |name: &str| schema.get(name).and_then(Value::as_f64);
        let least = limit("minimum")
            .or(limit("exclusiveMinimum"))
            .unwrap_or(f64::NEG_INFINITY);
        let most = limit("maximum")
            .or(limit("exclusiveMaximum"))
            .unwrap_or(f64::INFINITY);
        if random.chance(0.08) && (least.is_finite() || most.is_finite()) {
            let end = if random.chance(0.5) && least.is_finite() || !most.is_finite() {
                least
            } else {
                most
            };
            return if random.chance(wild) {
                end + *random.of(&[-1.0, 1.0, 1e-9, -1e-9])
            } else {
                end
            };
        }
        let known: Vec<f64> = self
            .known
            .get(key)
            .into_iter()
            .flatten()
            .filter_map(first_number)
            .collect();
        let number = match known.is_empty() {
            false if random.chance(0.7) => random.of(&known) * *random.of(&[1.0, 1.0, 0.5, 2.0, 0.1, -1.0]),
            _ if random.chance(0.3) => random.between(least.max(-1000.0), most.min(1000.0)),
            _ => *random.of(USUAL),
        };
        number.clamp(least, most)
    }

    /// A text that another study has for this key, or for any.
    fn text(&self, key: &str, random: &mut Random) -> Node {
        let quoted = |node: &&Node| matches!(node, Node::Literal(text) if text.starts_with('"'));
        let own: Vec<&Node> = self.known.get(key).into_iter().flatten().filter(quoted).collect();
        if !own.is_empty() && random.chance(0.8) {
            return (*random.of(&own)).clone();
        }
        let all: Vec<&Node> = self.known.values().flatten().filter(quoted).collect();
        (*random.of(&all)).clone()
    }
}

/// How deep a value is, and the part of scalars that break the schema.
#[derive(Clone, Copy)]
struct Depth {
    level: usize,
    wild: f64,
}

impl Depth {
    fn below(self) -> Depth {
        Depth {
            level: self.level + 1,
            ..self
        }
    }
}

/// A literal that is out of place.
pub fn wild_literal(random: &mut Random) -> Node {
    if random.chance(0.01) {
        return Node::text(&"long ".repeat(2000));
    }
    Node::Literal((*random.of(WILD)).to_owned())
}

/// A number as it is written, with a point or without.
fn literal(number: f64, whole: bool) -> String {
    if whole {
        format!("{number:.0}")
    } else {
        format!("{number:?}")
    }
}

/// The number of a literal, or the first of a list.
fn first_number(node: &Node) -> Option<f64> {
    match node {
        Node::Literal(text) => text.parse().ok(),
        Node::List(entries) => entries.first().and_then(first_number),
        Node::Table(_) => None,
    }
}

/// The values of all keys.
fn collect(node: &Node, known: &mut BTreeMap<String, Vec<Node>>) {
    match node {
        Node::Literal(_) => {}
        Node::List(entries) => entries.iter().for_each(|entry| collect(entry, known)),
        Node::Table(fields) => {
            for (key, value) in fields {
                known.entry(key.clone()).or_default().push(value.clone());
                collect(value, known);
            }
        }
    }
}
