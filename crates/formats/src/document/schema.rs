//! Reads shapes from a JSON schema, as schemars writes it.
//!
//! | serde | schema | shape |
//! |---|---|---|
//! | struct | `type: object`, `properties`, `required` | [`Shape::Table`] |
//! | `deny_unknown_fields` | `additionalProperties` (flattened: `unevaluatedProperties`) false | [`ExtraFields::Refused`] |
//! | map | `additionalProperties` or `patternProperties`: a schema | [`ExtraFields::Each`] |
//! | `Vec`, array, tuple | `type: array`, `items`, `prefixItems`, `minItems`, `maxItems` | [`Shape::List`] |
//! | `Option` | `type: [..., null]`, or `anyOf` with null | that of its content, not required |
//! | enum of names | `enum`, or `oneOf` of `const` | [`Shape::Choice`] |
//! | enum with a tag | `oneOf`: tables with the tag as `const` | [`Shape::Tagged`] |
//! | untagged enum | `anyOf` | [`Shape::OneOf`] |
//! | `flatten` | `$ref`, `oneOf` or `allOf` next to `properties` | the fields of all, merged (`merge`) |
//! | a type used twice | `$ref` into `$defs` | [`Shape::Named`] |
//!
//! A part of a schema that is not understood becomes [`Shape::Any`]: it refuses nothing, and serde has the last word.

use serde_json::{Map, Value};

use super::merge::{merged, one_of};
use super::shape::{ExtraFields, Field, Limits, ListShape, Shape, Shapes, TableShape};

/// Schemas merged into one another (serde's `flatten`) deeper than this are taken as [`Shape::Any`].
const MOST_MERGES: usize = 32;

/// The shapes of a JSON schema of draft 2020-12.
pub(super) fn shapes(schema: &Value) -> Shapes {
    let no_definitions = Map::new();
    let definitions = schema
        .get("$defs")
        .and_then(Value::as_object)
        .unwrap_or(&no_definitions);
    let reader = Reader { definitions };
    let named = definitions
        .iter()
        .map(|(name, schema)| (name.clone(), reader.shape(schema, 0)))
        .collect();
    Shapes {
        root: reader.shape(schema, 0),
        named,
    }
}

/// Reads schemas that may refer to these definitions.
struct Reader<'a> {
    definitions: &'a Map<String, Value>,
}

impl Reader<'_> {
    /// The shape of any schema, which `merges` others enclose.
    ///
    /// Tried in this order: values that are listed; a reference or alternatives without fields of its own; a plain
    /// type; and a schema with own fields in addition to others, which is `flatten`.
    fn shape(&self, schema: &Value, merges: usize) -> Shape {
        let Some(object) = schema.as_object().filter(|_| merges < MOST_MERGES) else {
            return Shape::Any;
        };
        let reference = object
            .get("$ref")
            .and_then(Value::as_str)
            .and_then(|path| path.strip_prefix("#/$defs/"));
        let own_fields = object.contains_key("properties");
        if let Some(choices) = choices(object) {
            return Shape::Choice(choices);
        }
        match (reference, alternatives(object)) {
            (Some(name), None) if !own_fields => Shape::Named(name.to_owned()),
            (None, Some(alternatives)) if !own_fields => one_of(
                alternatives
                    .iter()
                    .map(|alternative| self.shape(alternative, merges + 1))
                    .collect(),
            ),
            (None, None) => self.plain(object, merges),
            (reference, alternatives) => {
                // serde's `flatten`: fields of its own, those of another struct, and those of one variant.
                let mut table = self.table(object, merges);
                if let Some(target) = reference.and_then(|name| self.definitions.get(name)) {
                    table = match merged(&table, &self.shape(target, merges + 1)) {
                        Some(Shape::Table(table)) => table,
                        Some(shape) => return shape,
                        None => return Shape::Any,
                    };
                }
                let variants = alternatives.into_iter().flatten();
                let shapes: Option<Vec<Shape>> = variants
                    .map(|variant| merged(&table, &self.shape(variant, merges + 1)))
                    .collect();
                match shapes {
                    Some(shapes) if shapes.is_empty() => Shape::Table(table),
                    Some(shapes) => one_of(shapes),
                    None => Shape::Any,
                }
            }
        }
    }

    /// A schema that is neither a reference nor a choice among schemas.
    ///
    /// Ranges are inclusive for `minimum` and `maximum`, exclusive for those with `exclusive` before the name.
    fn plain(&self, object: &Map<String, Value>, merges: usize) -> Shape {
        let number = |key: &str| object.get(key).and_then(Value::as_f64);
        let count = |key: &str| object.get(key).and_then(Value::as_u64);
        let limits = Limits {
            at_least: number("minimum"),
            above: number("exclusiveMinimum"),
            at_most: number("maximum"),
            below: number("exclusiveMaximum"),
        };
        match kind(object) {
            Some("number") => Shape::Number(limits),
            Some("integer") => Shape::Integer(limits),
            Some("string") => Shape::Text {
                shortest: count("minLength").unwrap_or(0),
                longest: count("maxLength"),
            },
            Some("boolean") => Shape::Flag,
            Some("array") => {
                let first = object.get("prefixItems").and_then(Value::as_array);
                Shape::List(Box::new(ListShape {
                    first: first
                        .into_iter()
                        .flatten()
                        .map(|item| self.shape(item, merges + 1))
                        .collect(),
                    others: object
                        .get("items")
                        .map_or(Shape::Any, |items| self.shape(items, merges + 1)),
                    fewest: count("minItems").unwrap_or(0),
                    most: count("maxItems"),
                }))
            }
            Some("object") => Shape::Table(self.table(object, merges)),
            _ => Shape::Any,
        }
    }

    /// Structs and maps: the fields of this schema itself, without those that are flattened into it.
    fn table(&self, object: &Map<String, Value>, merges: usize) -> TableShape {
        let properties = object.get("properties").and_then(Value::as_object);
        let fields = properties.into_iter().flatten().map(|(name, schema)| {
            let field = Field {
                shape: self.shape(schema, merges + 1),
                meaning: meaning(schema),
            };
            (name.clone(), field)
        });
        let required = object
            .get("required")
            .and_then(Value::as_array)
            .into_iter()
            .flatten();
        // Maps with keys that are not text: their one pattern contains the shape of all values.
        let pattern = object
            .get("patternProperties")
            .and_then(Value::as_object)
            .and_then(|map| map.values().next());
        let others = match pattern
            .or_else(|| object.get("additionalProperties"))
            .or_else(|| object.get("unevaluatedProperties"))
        {
            Some(Value::Bool(false)) => ExtraFields::Refused,
            Some(schema @ Value::Object(_)) => ExtraFields::Each(Box::new(self.shape(schema, merges + 1))),
            _ => ExtraFields::Any,
        };
        TableShape {
            fields: fields.collect(),
            required: required.filter_map(Value::as_str).map(str::to_owned).collect(),
            others,
        }
    }
}

/// The type of a schema, leaving out null: TOML has none, an optional field is simply not written.
///
/// `None` where there are several; a schema with fields and no type is an object.
fn kind(object: &Map<String, Value>) -> Option<&str> {
    match object.get("type") {
        Some(Value::String(kind)) => Some(kind),
        Some(Value::Array(kinds)) => {
            let mut kinds = kinds
                .iter()
                .filter_map(Value::as_str)
                .filter(|kind| *kind != "null");
            kinds.next().filter(|_| kinds.next().is_none())
        }
        None if object.contains_key("properties") => Some("object"),
        _ => None,
    }
}

/// The values of `enum` or `const` without null; `None` where there are none, or one is a list or a table.
fn choices(object: &Map<String, Value>) -> Option<Vec<Value>> {
    let one = object.get("const").map(|value| vec![value.clone()]);
    let some = || object.get("enum").and_then(Value::as_array).cloned();
    let choices: Vec<Value> = one
        .or_else(some)?
        .into_iter()
        .filter(|value| !value.is_null())
        .collect();
    let plain = choices
        .iter()
        .all(|value| value.is_string() || value.is_number() || value.is_boolean());
    (plain && !choices.is_empty()).then_some(choices)
}

/// The alternatives of a schema without null; `None` if it offers none.
fn alternatives(object: &Map<String, Value>) -> Option<Vec<&Value>> {
    let list = object
        .get("oneOf")
        .or_else(|| object.get("anyOf"))
        .or_else(|| object.get("allOf"))?
        .as_array()?;
    let is_null = |schema: &Value| schema.get("type").and_then(Value::as_str) == Some("null");
    Some(list.iter().filter(|schema| !is_null(schema)).collect())
}

/// The first line of a schema's description.
///
/// Without the full stop, since a hint goes on behind it; `None` where it is empty.
fn meaning(schema: &Value) -> Option<String> {
    let text = schema.get("description")?.as_str()?;
    text.lines()
        .next()
        .map(|line| line.trim().trim_end_matches('.').to_owned())
        .filter(|line| !line.is_empty())
}
