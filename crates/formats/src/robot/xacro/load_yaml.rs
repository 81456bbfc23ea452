//! `xacro.load_yaml(FILE)` without the loader of the evaluator: each call is replaced by a property that contains the
//! data of the file, which was checked before.
//!
//! ```text
//! ${xacro.load_yaml('limits.yaml')['a']}   ->   <xacro:property name="armill_yaml_0" value="{'a': 1.5}"/>
//!                                               ${armill_yaml_0['a']}
//! ```
//!
//! The evaluator is built without its YAML reader, so a call that is not replaced is refused.
//!
//! | bound | most |
//! |---|---|
//! | where the file is | in the folder of the xacro file, or in its ROS package where it says `$(find package)` |
//! | kind of file | regular, after links are resolved |
//! | bytes of the file | 1 MiB |
//! | bytes of its data as an expression, aliases expanded | 64 KiB |
//! | lists and mappings within one another | 16 |
//! | calls that differ | 100 |
//!
//! The name of the file is a text in quotes, or a property, argument or parameter that has one value in all files.
//! Any other expression is refused: which file it means is not known before it is evaluated.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;
use std::io::Read;
use std::path::{Path, PathBuf};

use saphyr_parser::{Event, Parser, ScalarStyle, Tag};

use super::packages;
use super::values::{LONGEST_VALUE, Values};
use crate::input;

/// A larger file is not a parameter file of a robot.
const MOST_BYTES: u64 = 1 << 20;
/// More files than this are not accepted.
const MOST_CALLS: usize = 100;
/// Lists and mappings within one another: the evaluator calls itself for each.
const DEEPEST: usize = 16;
/// Values that name values deeper than this are a circle.
const LEVELS: usize = 16;
/// Prefix of the properties with the data.
const PROPERTY: &str = "armill_yaml_";
/// The function, with and without the prefix of its module.
const FUNCTION: [&str; 2] = ["xacro.load_yaml", "load_yaml"];

/// A call of `load_yaml`.
#[derive(PartialEq)]
pub(super) struct Call {
    /// Folder of the file that contains it.
    pub folder: PathBuf,
    /// What is between its brackets.
    pub argument: String,
}

/// The data of a call.
pub(super) struct Data {
    /// The property that contains it.
    pub property: String,
    /// As an expression.
    pub value: String,
}

/// `text` with each call of `load_yaml` replaced by the property that contains its data. New calls are added to
/// `calls`.
pub(super) fn replaced(text: &str, folder: &Path, calls: &mut Vec<Call>) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, argument, after)) = next_call(rest) {
        out.push_str(before);
        let call = Call {
            folder: folder.to_owned(),
            argument: argument.trim().to_owned(),
        };
        let known = calls.iter().position(|known| *known == call);
        let index = known.unwrap_or_else(|| {
            calls.push(call);
            calls.len() - 1
        });
        out.push_str(&format!("{PROPERTY}{index}"));
        rest = after;
    }
    out.push_str(rest);
    out
}

/// The text before the first call, its argument, and the text after it.
fn next_call(text: &str) -> Option<(&str, &str, &str)> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    let starts = text.match_indices(FUNCTION[1]).filter_map(|(at, _)| {
        let module = FUNCTION[0].len() - FUNCTION[1].len();
        let start = match at.checked_sub(module) {
            Some(start)
                if text
                    .get(start..)
                    .is_some_and(|text| text.starts_with(FUNCTION[0])) =>
            {
                start
            }
            _ => at,
        };
        let begins = !text.get(..start)?.ends_with(is_word);
        let behind = text.get(at + FUNCTION[1].len()..)?.trim_start();
        let arguments = behind.strip_prefix('(')?;
        begins.then_some((start, arguments))
    });
    for (start, arguments) in starts {
        if let Some((argument, after)) = arguments.split_once(')') {
            return Some((text.get(..start)?, argument, after));
        }
    }
    None
}

/// The properties with the data of these calls, in the order of the calls; `values` are those of all names.
///
/// # Errors
/// The call whose file is not known, not allowed or not readable.
pub(super) fn data(calls: &[Call], values: &Values<'_>) -> Result<Vec<Data>, String> {
    if calls.len() > MOST_CALLS {
        return Err(format!("more than {MOST_CALLS} calls of `load_yaml`"));
    }
    let each = calls.iter().enumerate().map(|(index, call)| {
        let given = |message: String| format!("`load_yaml({})`: {message}", call.argument);
        let name = file_name(&call.argument, values, 0).ok_or_else(|| {
            given("the name of the file is not known before the expression is evaluated".to_owned())
        })?;
        let text = text_of(&call.folder, &name).map_err(given)?;
        let data = expression(&text).map_err(|error| given(format!("{name}: {error}")))?;
        Ok(Data {
            property: format!("{PROPERTY}{index}"),
            value: data,
        })
    });
    each.collect()
}

/// The name of a file that this argument gives: a text in quotes, or a name that has one value.
fn file_name(argument: &str, values: &Values<'_>, level: usize) -> Option<String> {
    if level > LEVELS {
        return None;
    }
    let argument = argument.trim();
    for quote in ['\'', '"'] {
        if let Some(text) = argument
            .strip_prefix(quote)
            .and_then(|text| text.strip_suffix(quote))
        {
            return (!text.contains(quote)).then(|| substituted(text, values, level))?;
        }
    }
    // A value that only hands on the one of an outer macro says nothing new.
    let own = [format!("${{{argument}}}"), format!("$(arg {argument})")];
    let given: BTreeSet<&str> = values
        .get(argument)?
        .iter()
        .copied()
        .filter(|value| !value.is_empty() && !own.iter().any(|own| own == value))
        .collect();
    match given.into_iter().collect::<Vec<_>>()[..] {
        [one] => substituted(one, values, level),
        _ => None,
    }
}

/// `text` with the values of the names in it; `$(find package)` stays.
fn substituted(text: &str, values: &Values<'_>, level: usize) -> Option<String> {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, inside)) = rest.split_once('$') {
        out.push_str(before);
        let (value, after) =
            if let Some((name, after)) = inside.strip_prefix('{').and_then(|text| text.split_once('}')) {
                (file_name(name, values, level + 1)?, after)
            } else {
                let (command, after) = inside.strip_prefix('(')?.split_once(')')?;
                match command.trim().split_once(' ')? {
                    ("arg", name) => (file_name(name, values, level + 1)?, after),
                    ("find", package) => (format!("$(find {})", package.trim()), after),
                    _ => return None,
                }
            };
        out.push_str(&value);
        if out.len() as u64 > LONGEST_VALUE {
            return None;
        }
        rest = after;
    }
    out.push_str(rest);
    Some(out)
}

/// The text of the file of this name, which a xacro file in `folder` gives.
fn text_of(folder: &Path, name: &str) -> Result<String, String> {
    let (root, file) = match name.strip_prefix("$(find ").and_then(|text| text.split_once(')')) {
        Some((package, rest)) => {
            let home = packages::own(folder, package).ok_or_else(|| {
                format!("the xacro file is not in a ROS package `{package}` (a folder of that name with a package.xml)")
            })?;
            let file = home.join(rest.trim_start_matches('/'));
            (home, file)
        }
        None => (folder.to_owned(), folder.join(name)),
    };
    let shown = file.display();
    let unread = |error: std::io::Error| format!("cannot read {shown}: {error}");
    let file_path = file.canonicalize().map_err(unread)?;
    let root = root.canonicalize().map_err(unread)?;
    if !file_path.starts_with(&root) {
        return Err(format!(
            "{shown} is outside the folder {}: move it there",
            root.display()
        ));
    }
    let mut bytes = Vec::new();
    let file = input::open(&file_path).map_err(unread)?;
    file.take(MOST_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(unread)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(format!("{shown} is larger than {} MiB", MOST_BYTES >> 20));
    }
    String::from_utf8(bytes).map_err(|_| format!("{shown} is not UTF-8 text"))
}

/// A list or mapping that is not closed yet.
struct Open {
    /// What an alias calls it; 0 for nothing.
    anchor: usize,
    text: String,
    /// Of a mapping; `None` in a list.
    key: Option<Key>,
}

/// What comes next in a mapping.
enum Key {
    Awaited,
    Given,
}

impl Open {
    /// Adds a value, or in a mapping the next key.
    fn take(&mut self, value: &str, is_scalar: bool) -> Result<(), String> {
        let opened = self.text.len() == 1;
        match &mut self.key {
            Some(key @ Key::Given) => {
                self.text.push_str(": ");
                *key = Key::Awaited;
            }
            Some(Key::Awaited) if !is_scalar => return Err("a list or mapping is not a valid key".to_owned()),
            key => {
                if !opened {
                    self.text.push_str(", ");
                }
                if let Some(key) = key {
                    *key = Key::Given;
                }
            }
        }
        self.text.push_str(value);
        bounded(&self.text)
    }
}

/// An error if the data is too long.
fn bounded(data: &str) -> Result<(), String> {
    if data.len() as u64 > LONGEST_VALUE {
        return Err(format!("the data is longer than {} KiB", LONGEST_VALUE >> 10));
    }
    Ok(())
}

/// The first document of the YAML `text` as an expression of lists, mappings, texts and numbers.
fn expression(text: &str) -> Result<String, String> {
    let mut open: Vec<Open> = Vec::new();
    let mut anchors: BTreeMap<usize, (String, bool)> = BTreeMap::new();
    for event in Parser::new_from_str(text) {
        let (event, span) = event.map_err(|error| format!("not valid YAML: {error}"))?;
        let at = |message: String| format!("line {}: {message}", span.start.line());
        // What the event completes: its text, whether it is a scalar, and its anchor.
        let (value, is_scalar, anchor) = match event {
            Event::SequenceStart(anchor, tag) => {
                opened(&mut open, Open::list(anchor), tag.as_deref()).map_err(at)?;
                continue;
            }
            Event::MappingStart(anchor, tag) => {
                opened(&mut open, Open::mapping(anchor), tag.as_deref()).map_err(at)?;
                continue;
            }
            Event::SequenceEnd | Event::MappingEnd => {
                let Some(closed) = open.pop() else { continue };
                let end = if closed.key.is_some() { '}' } else { ']' };
                (format!("{}{end}", closed.text), false, closed.anchor)
            }
            Event::Scalar(value, style, anchor, tag) => {
                let value = scalar(&value, style, tag.as_deref()).map_err(at)?;
                (value, true, anchor)
            }
            Event::Alias(anchor) => {
                let found = anchors.get(&anchor).cloned();
                let (value, is_scalar) =
                    found.ok_or_else(|| at("an alias names the value that contains it".to_owned()))?;
                (value, is_scalar, 0)
            }
            Event::DocumentEnd => break,
            Event::Nothing | Event::StreamStart | Event::StreamEnd | Event::DocumentStart(_) => continue,
        };
        if anchor > 0 {
            anchors.insert(anchor, (value.clone(), is_scalar));
        }
        match open.last_mut() {
            Some(outer) => outer.take(&value, is_scalar).map_err(at)?,
            None => return bounded(&value).map(|()| value).map_err(at),
        }
    }
    Err("it contains no data".to_owned())
}

impl Open {
    fn list(anchor: usize) -> Open {
        let text = "[".to_owned();
        Open {
            anchor,
            text,
            key: None,
        }
    }

    fn mapping(anchor: usize) -> Open {
        let (text, key) = ("{".to_owned(), Some(Key::Awaited));
        Open { anchor, text, key }
    }
}

/// Opens one more list or mapping.
fn opened(open: &mut Vec<Open>, inner: Open, tag: Option<&Tag>) -> Result<(), String> {
    if let Some(tag) = tag {
        return Err(unsupported(tag));
    }
    open.push(inner);
    if open.len() > DEEPEST {
        return Err(format!(
            "lists and mappings are nested deeper than {DEEPEST} levels"
        ));
    }
    Ok(())
}

fn unsupported(tag: &Tag) -> String {
    format!("the tag `{}{}` is not supported", tag.handle, tag.suffix)
}

/// A scalar as an expression; angles with the unit tags of xacro in rad.
fn scalar(value: &str, style: ScalarStyle, tag: Option<&Tag>) -> Result<String, String> {
    let number = value.parse::<f64>().ok().filter(|number| number.is_finite());
    match tag.map(|tag| (tag, tag.suffix.as_str())) {
        Some((_, "degrees" | "radians")) if number.is_none() => {
            return Err(format!("`{value}` is not an angle"));
        }
        Some((_, "degrees")) => return Ok(format!("{}", number.unwrap_or_default() * PI / 180.0)),
        Some((_, "radians")) | None => {}
        Some((tag, _)) => return Err(unsupported(tag)),
    }
    match (number, style, value) {
        (Some(number), ScalarStyle::Plain, _) => return Ok(format!("{number}")),
        (None, ScalarStyle::Plain, "" | "~" | "null" | "Null" | "NULL") => return Ok("None".to_owned()),
        (None, ScalarStyle::Plain, "true" | "True" | "TRUE") => return Ok("True".to_owned()),
        (None, ScalarStyle::Plain, "false" | "False" | "FALSE") => return Ok("False".to_owned()),
        _ => {}
    }
    // What the evaluator could take for an expression where the text becomes the value of a property.
    if let Some(wrong) = value
        .chars()
        .find(|c| c.is_control() || "$'\"\\()[]{}".contains(*c))
    {
        return Err(format!(
            "the text `{value}` contains {wrong:?}, which is not supported"
        ));
    }
    Ok(format!("'{value}'"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_becomes_an_expression_with_aliases_expanded_and_angles_in_rad() {
        for (text, expected) in [
            ("a: 1.5\nb: [x, 'y z', -2]\n", "{'a': 1.5, 'b': ['x', 'y z', -2]}"),
            ("a: &p {q: true}\nb: *p\n", "{'a': {'q': True}, 'b': {'q': True}}"),
            (
                "a: !degrees 180\nb: !radians 2\nc: ~\n",
                "{'a': 3.141592653589793, 'b': 2, 'c': None}",
            ),
            ("- 1\n---\n- 2\n", "[1]"),
            ("{}", "{}"),
        ] {
            assert_eq!(expression(text).unwrap(), expected, "{text}");
        }
    }

    #[test]
    fn data_that_is_deep_long_or_not_plain_is_refused() {
        let doubling: String = (1..40)
            .map(|n| format!("a{n}: &a{n} [*a{}, *a{}]\n", n - 1, n - 1))
            .collect();
        for (text, words) in [
            ("[".repeat(100), "nested deeper than 16"),
            ("- ".repeat(100), "nested deeper than 16"),
            // The parser looks ahead, and has a bound of its own.
            ("[".repeat(3000), "not valid YAML"),
            (format!("a0: &a0 xxxxxxxx\n{doubling}"), "longer than 64 KiB"),
            (format!("a: {}", "x".repeat(70_000)), "longer than 64 KiB"),
            (
                "a: &a [*a]".to_owned(),
                "an alias names the value that contains it",
            ),
            ("a: ${b}".to_owned(), "contains '$'"),
            ("a: \"x'\"".to_owned(), "contains '\\''"),
            ("a: !degrees x".to_owned(), "not an angle"),
            ("a: !!python/object x".to_owned(), "is not supported"),
            ("a: !x [1]".to_owned(), "is not supported"),
            ("? [1]\n: 2\n".to_owned(), "not a valid key"),
            ("a: 'b".to_owned(), "not valid YAML"),
            (String::new(), "no data"),
        ] {
            let error = expression(&text).unwrap_err();
            assert!(error.contains(words), "no `{words}` in {error}");
        }
    }

    #[test]
    fn calls_are_found_with_and_without_module_and_not_in_other_names() {
        let mut calls = Vec::new();
        let text = "${xacro.load_yaml('a.yaml')['x'] + load_yaml (b)['y'] + my_load_yaml(c)}";
        assert_eq!(
            replaced(text, Path::new("/f"), &mut calls),
            "${armill_yaml_0['x'] + armill_yaml_1['y'] + my_load_yaml(c)}"
        );
        let arguments: Vec<&str> = calls.iter().map(|call| call.argument.as_str()).collect();
        assert_eq!(arguments, ["'a.yaml'", "b"]);
    }
}
