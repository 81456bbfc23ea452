//! Studies of a seed: good ones with subtrees replaced, inserted and removed by the schema, or made from the schema alone.

use std::path::{Path, PathBuf};

use armill_formats::document::{Document, schema_json};
use armill_study::file::format::StudyFile;
use serde_json::Value;

use super::random::Random;
use super::schema::{Schema, wild_literal};
use super::tree::{Node, written};

/// A good study that others are made from, and the folder of its files.
struct Base {
    study: Node,
    file: PathBuf,
    text: String,
}

impl Base {
    fn folder(&self) -> PathBuf {
        self.file.parent().unwrap().to_owned()
    }
}

/// What all studies are made from.
pub struct Generator {
    schema: Schema,
    bases: Vec<Base>,
}

/// A generated study file.
pub struct Generated {
    /// Not always UTF-8.
    pub bytes: Vec<u8>,
    /// Where the files that it names are.
    pub folder: PathBuf,
}

impl Generator {
    /// From the examples of the repository, and those in `bases`, which use what the examples do not.
    pub fn new() -> Generator {
        let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/generated/bases");
        let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
        let mut files = Vec::new();
        for entry in std::fs::read_dir(&tests).unwrap() {
            files.extend([entry.unwrap().path()].into_iter().filter(|path| is_base(path)));
        }
        for entry in std::fs::read_dir(&examples).unwrap() {
            files.push(entry.unwrap().path().join("study.toml"));
        }
        files.sort();
        let bases: Vec<Base> = files.iter().map(|file| base(file)).collect();
        let studies: Vec<Node> = bases.iter().map(|base| base.study.clone()).collect();
        Generator {
            schema: Schema::new(&schema_json::<StudyFile>(), &studies),
            bases,
        }
    }

    /// The good studies, with the names of their files.
    pub fn unchanged(&self) -> impl Iterator<Item = (String, Generated)> {
        self.bases.iter().map(|base| {
            let study = Generated {
                bytes: base.text.clone().into_bytes(),
                folder: base.folder(),
            };
            (base.file.display().to_string(), study)
        })
    }

    /// The study of this seed, always the same.
    pub fn study(&self, seed: u64) -> Generated {
        let mut random = Random::seeded(seed);
        let base = random.of(&self.bases);
        // Most files are to pass the parser, so that checks and calculations are reached.
        let wild = *random.of(&[0.0, 0.0, 0.0, 0.0, 0.01, 0.05, 0.3]);
        let study = if random.chance(0.1) {
            self.schema.value("", self.schema.root(), wild, &mut random)
        } else {
            let mut study = base.study.clone();
            for _ in 0..random.below(5) {
                self.change(&mut study, self.schema.root(), wild, &mut random);
            }
            study
        };
        let text = written(&study, &mut random);
        let damaged = if random.chance(0.08) {
            damage(text, &mut random)
        } else {
            text.into_bytes()
        };
        Generated {
            bytes: damaged,
            folder: base.folder(),
        }
    }

    /// One change somewhere in this value.
    fn change(&self, node: &mut Node, schema: &Value, wild: f64, random: &mut Random) {
        match node {
            Node::Literal(_) if random.chance(wild) => *node = wild_literal(random),
            Node::Literal(_) => *node = self.schema.value("", schema, wild, random),
            Node::List(entries) => self.change_list(entries, self.schema.entries(schema), wild, random),
            Node::Table(fields) => self.change_table(fields, schema, wild, random),
        }
    }

    fn change_list(&self, entries: &mut Vec<Node>, schema: &Value, wild: f64, random: &mut Random) {
        let at = random.below(entries.len());
        let copy = entries.get(at).cloned();
        match (copy, random.below(8)) {
            (Some(copy), 0) => entries.insert(at, copy),
            (Some(_), 1) => drop(entries.remove(at)),
            (Some(_), 2) => {
                let other = random.below(entries.len());
                entries.swap(at, other);
            }
            (None, _) | (_, 3) => entries.insert(at, self.schema.value("", schema, wild, random)),
            _ => self.change(&mut entries[at], schema, wild, random),
        }
    }

    fn change_table(&self, fields: &mut Vec<(String, Node)>, schema: &Value, wild: f64, random: &mut Random) {
        let known = self.schema.fields(schema, fields);
        let of_key = |key: &str| {
            known
                .iter()
                .find(|(name, _)| *name == key)
                .map_or(&Value::Null, |(_, field)| *field)
        };
        let at = random.below(fields.len());
        match random.below(10) {
            // A field that is missing, or in its place another.
            0..3 if !known.is_empty() => {
                let (key, field) = *random.of(&known);
                let value = self.schema.value(key, field, wild, random);
                fields.retain(|(name, _)| name != key);
                fields.push((key.to_owned(), value));
            }
            3 if !fields.is_empty() => {
                let value = self
                    .schema
                    .value(&fields[at].0, of_key(&fields[at].0), wild, random);
                fields[at].1 = value;
            }
            4 if !fields.is_empty() => drop(fields.remove(at)),
            5 if !fields.is_empty() && random.chance(0.3) => {
                let slips = [
                    fields[at].0.to_uppercase(),
                    format!("{}s", fields[at].0),
                    fields[at].0.replace("_mm", ""),
                ];
                fields[at].0.clone_from(random.of(&slips));
            }
            _ if !fields.is_empty() => {
                let (key, value) = &mut fields[at];
                let field = of_key(key);
                match value {
                    Node::Literal(_) => *value = self.schema.value(key, field, wild, random),
                    nested => self.change(nested, field, wild, random),
                }
            }
            _ => {}
        }
    }
}

/// Whether it is a study: robot files are there too.
fn is_base(path: &Path) -> bool {
    let name = path
        .file_name()
        .and_then(|name| name.to_str())
        .unwrap_or_default();
    name.ends_with(".study.toml")
}

fn base(file: &Path) -> Base {
    let text = std::fs::read_to_string(file).unwrap();
    let document = Document::parse("study.toml", &text).unwrap();
    Base {
        study: Node::of(&document.to_json()),
        file: file.to_owned(),
        text,
    }
}

/// The text with one slip of an editor, a disk or a keyboard.
fn damage(text: String, random: &mut Random) -> Vec<u8> {
    let at = random.below(text.len());
    let mut bytes = text.into_bytes();
    match random.below(9) {
        0 => bytes.truncate(at),
        1 => drop(bytes.remove(at)),
        2 => bytes.insert(at, u8::try_from(random.below(256)).unwrap()),
        3 => {
            let end = (at + random.below(40)).min(bytes.len());
            bytes.drain(at..end);
        }
        4 => bytes.splice(0..0, *b"\xef\xbb\xbf").for_each(drop),
        5 => bytes = String::from_utf8_lossy(&bytes).replace('\n', "\r\n").into_bytes(),
        6 => bytes = bytes.iter().flat_map(|byte| [*byte, 0]).collect(),
        // A decimal comma.
        7 => match bytes.iter().skip(at).position(|byte| *byte == b'.') {
            Some(point) => bytes[at + point] = b',',
            None => bytes.clear(),
        },
        _ => {
            let piece = bytes[at..].to_vec();
            bytes.extend(piece);
        }
    }
    bytes
}
