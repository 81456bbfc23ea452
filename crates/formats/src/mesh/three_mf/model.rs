//! One XML model of a 3MF archive: its objects, and the items of its build.
//!
//! Elements of the core specification have the prefix of `<model>`, usually none; those of other prefixes are not used,
//! unless the model requires their extension. A transform is on row vectors, twelve numbers row by row:
//!
//! ```text
//! [x' y' z'] = [x y z 1] M      M: m00 m01 m02 m10 m11 m12 m20 m21 m22 m30 m31 m32
//! ```

use std::collections::BTreeMap;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::super::affine::Affine;
use super::super::scene::Object;
use super::super::text_lines::coordinate;
use super::super::unit::MeshUnit;
use super::package::key;
use crate::document::{Problem, Problems};

/// Problems of one model that are looked for.
const MOST_PROBLEMS: usize = 20;
/// Extensions that a model may require: what they add is not geometry, or is read here.
const EXTENSIONS: [&str; 2] = [
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
];
/// A model requires no more extensions than there are.
const MOST_EXTENSIONS: usize = 20;
/// What to do about a value that is not accepted.
const EXPORT: &str = "the file is damaged: export it again";

/// One XML model.
#[derive(Default)]
pub(super) struct Model {
    /// `None`: not given, which means millimetres.
    pub unit: Option<MeshUnit>,
    pub objects: BTreeMap<u32, ModelObject>,
    /// Objects of the build.
    pub items: Vec<Placed>,
}

/// An object.
pub(super) struct ModelObject {
    pub content: Content,
    /// Whether it supports others while they are printed.
    pub is_support: bool,
}

/// What an object consists of.
pub(super) enum Content {
    Mesh(Object),
    Components(Vec<Placed>),
}

/// An object at its place.
pub(super) struct Placed {
    /// The model that it is in; `None`: this one.
    pub path: Option<String>,
    pub id: u32,
    pub transform: Affine,
    /// Where it is written.
    pub line: usize,
}

/// Reads the model in the part `path` of the file `name`.
///
/// # Errors
/// What is not XML; elements without the attributes that they require; indices without a vertex; a required extension
/// that is not known.
pub(super) fn read(name: &str, path: &str, bytes: &[u8]) -> Result<Model, Problems> {
    let mut parser = Parser {
        model: Model::default(),
        prefix: None,
        object: None,
    };
    let mut problems = Vec::new();
    let mut reader = Reader::from_reader(bytes);
    let mut place = Place {
        bytes,
        at: 0,
        line: 1,
    };
    let problem = |line: usize, message: String, hint: &str| {
        let message = format!("`{path}`, line {line}: {message}");
        Problem::of_file(name, message, hint)
    };
    while problems.len() < MOST_PROBLEMS {
        let line = place.line_of(reader.buffer_position());
        let taken = match reader.read_event() {
            Ok(Event::Start(element)) => parser.start(&element, line),
            Ok(Event::Empty(element)) => {
                let taken = parser.start(&element, line);
                parser.end(element.name().as_ref());
                taken
            }
            Ok(Event::End(element)) => {
                parser.end(element.name().as_ref());
                Ok(())
            }
            Ok(Event::DocType(_)) => Err("a document type definition is not accepted in 3MF".to_owned()),
            Ok(Event::Eof) => break,
            Ok(_) => Ok(()),
            Err(error) => {
                problems.push(problem(line, format!("not XML: {error}"), EXPORT));
                break;
            }
        };
        problems.extend(taken.err().map(|message| problem(line, message, EXPORT)));
    }
    if problems.is_empty() && parser.prefix.is_none() {
        problems.push(problem(1, "not a 3MF model".to_owned(), EXPORT));
    }
    Problems::from(problems).into_result()?;
    Ok(parser.model)
}

/// A place that moves forward through a text.
struct Place<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl Place<'_> {
    /// The line of a byte, which is not before the one of the last call.
    fn line_of(&mut self, byte: u64) -> usize {
        let to = usize::try_from(byte).unwrap_or(usize::MAX).min(self.bytes.len());
        let passed = self.bytes.get(self.at..to).unwrap_or_default();
        self.line += passed.iter().filter(|byte| **byte == b'\n').count();
        self.at = self.at.max(to);
        self.line
    }
}

/// The model so far.
struct Parser {
    model: Model,
    /// Prefix of the core elements, with its colon: that of `<model>`, `None` before it.
    prefix: Option<Vec<u8>>,
    /// The object whose elements follow.
    object: Option<Open>,
}

/// An object of which more may follow.
struct Open {
    id: u32,
    is_support: bool,
    mesh: Object,
    components: Vec<Placed>,
}

impl Parser {
    /// Takes a start tag.
    fn start(&mut self, element: &BytesStart<'_>, line: usize) -> Result<(), String> {
        let name = element.name();
        let Some(prefix) = &self.prefix else {
            return self.root(element);
        };
        let Some(core) = name.as_ref().strip_prefix(prefix.as_slice()) else {
            return Ok(());
        };
        match core {
            b"object" => {
                let kind = attribute(element, b"type")?;
                self.object = Some(Open {
                    id: whole(element, b"id")?,
                    is_support: matches!(kind.as_deref(), Some("support" | "solidsupport")),
                    mesh: Object::default(),
                    components: Vec::new(),
                });
            }
            b"vertex" => {
                let point = [b"x", b"y", b"z"].map(|axis| number(element, axis));
                let [x, y, z] = point;
                // One that is wrong keeps its index.
                let mesh = self.object.as_mut().map(|object| &mut object.mesh);
                let checked = x.and_then(|x| Ok([x, y?, z?]));
                mesh.ok_or("a vertex outside an object")?
                    .points
                    .push(checked.clone().unwrap_or_default());
                checked?;
            }
            b"triangle" => {
                let corners = [
                    whole(element, b"v1")?,
                    whole(element, b"v2")?,
                    whole(element, b"v3")?,
                ];
                let object = self.object.as_mut().ok_or("a triangle outside an object")?;
                let count = object.mesh.points.len();
                if let Some(corner) = corners.iter().find(|corner| **corner as usize >= count) {
                    let number = object.mesh.polygons() + 1;
                    return Err(format!(
                        "triangle {number} of object {}: no vertex has the index {corner}: the object has {count}",
                        object.id
                    ));
                }
                object.mesh.polygon(&corners);
            }
            b"component" => {
                let placed = placed(element, line)?;
                let object = self.object.as_mut().ok_or("a component outside an object")?;
                object.components.push(placed);
            }
            b"item" => self.model.items.push(placed(element, line)?),
            _ => {}
        }
        Ok(())
    }

    /// Takes the first start tag, which is that of the model.
    fn root(&mut self, element: &BytesStart<'_>) -> Result<(), String> {
        let name = element.name();
        let Some(prefix) = name.as_ref().strip_suffix(b"model") else {
            return Err("the first element of a 3MF model is <model>".to_owned());
        };
        self.prefix = Some(prefix.to_owned());
        if let Some(unit) = attribute(element, b"unit")? {
            let known = MeshUnit::named(&unit);
            self.model.unit = Some(known.ok_or_else(|| format!("`{unit}` is not a unit of 3MF"))?);
        }
        let required = attribute(element, b"requiredextensions")?.unwrap_or_default();
        for (index, prefix) in required.split_whitespace().enumerate() {
            let name = format!("xmlns:{prefix}");
            let namespace = attribute(element, name.as_bytes())?.unwrap_or_default();
            if index == MOST_EXTENSIONS || !EXTENSIONS.contains(&namespace.as_str()) {
                return Err(format!(
                    "the model requires the extension `{namespace}`, which is not read"
                ));
            }
        }
        Ok(())
    }

    /// Takes an end tag.
    fn end(&mut self, name: &[u8]) {
        let prefix = self.prefix.as_deref().unwrap_or_default();
        if name.strip_prefix(prefix) != Some(b"object") {
            return;
        }
        if let Some(open) = self.object.take() {
            let content = match open.components.is_empty() {
                true => Content::Mesh(open.mesh),
                false => Content::Components(open.components),
            };
            let object = ModelObject {
                content,
                is_support: open.is_support,
            };
            self.model.objects.insert(open.id, object);
        }
    }
}

/// The object that a component or an item places.
fn placed(element: &BytesStart<'_>, line: usize) -> Result<Placed, String> {
    let mut path = None;
    // The path has the prefix of its extension, whatever that is.
    for attribute in element.attributes().with_checks(false) {
        let attribute = attribute.map_err(|error| error.to_string())?;
        if attribute.key.local_name().as_ref() == b"path" {
            path = Some(key(&attribute
                .unescape_value()
                .map_err(|error| error.to_string())?));
        }
    }
    let transform = match attribute(element, b"transform")? {
        Some(text) => transform(&text)?,
        None => Affine::IDENTITY,
    };
    Ok(Placed {
        path,
        id: whole(element, b"objectid")?,
        transform,
        line,
    })
}

/// The transform of twelve numbers.
fn transform(text: &str) -> Result<Affine, String> {
    let numbers: Vec<f64> = text
        .split_ascii_whitespace()
        .map(|word| coordinate(word.as_bytes()))
        .collect::<Result<_, _>>()?;
    let numbers: [f64; 12] = numbers
        .try_into()
        .map_err(|numbers: Vec<f64>| format!("a transform of {} numbers: 12 required", numbers.len()))?;
    let mut matrix = [[0.0; 4]; 3];
    for (row, values) in matrix.iter_mut().enumerate() {
        for (column, value) in values.iter_mut().enumerate() {
            *value = numbers[3 * column + row];
        }
    }
    Ok(Affine(matrix))
}

/// The text of an attribute.
fn attribute(element: &BytesStart<'_>, name: &[u8]) -> Result<Option<String>, String> {
    for attribute in element.attributes().with_checks(false) {
        let attribute = attribute.map_err(|error| error.to_string())?;
        if attribute.key.as_ref() == name {
            let text = attribute.unescape_value().map_err(|error| error.to_string())?;
            return Ok(Some(text.into_owned()));
        }
    }
    Ok(None)
}

/// The value of an attribute that must be there, as it is written.
fn required<T>(
    element: &BytesStart<'_>,
    name: &[u8],
    value: impl FnOnce(&[u8]) -> Result<T, String>,
) -> Result<T, String> {
    let shown = || String::from_utf8_lossy(name).into_owned();
    for attribute in element.attributes().with_checks(false) {
        let attribute = attribute.map_err(|error| error.to_string())?;
        if attribute.key.as_ref() == name {
            let text = attribute.value.trim_ascii();
            return value(text).map_err(|message| format!("attribute `{}`: {message}", shown()));
        }
    }
    let of = String::from_utf8_lossy(element.name().as_ref()).into_owned();
    Err(format!("<{of}> has no attribute `{}`", shown()))
}

/// A coordinate that must be there.
fn number(element: &BytesStart<'_>, name: &[u8]) -> Result<f64, String> {
    required(element, name, coordinate)
}

/// A whole number that must be there.
fn whole(element: &BytesStart<'_>, name: &[u8]) -> Result<u32, String> {
    required(element, name, |text| {
        let number = std::str::from_utf8(text).ok().and_then(|text| text.parse().ok());
        number.ok_or_else(|| format!("`{}` is not a whole number", String::from_utf8_lossy(text)))
    })
}
