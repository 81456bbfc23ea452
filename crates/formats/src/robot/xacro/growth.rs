//! How much a xacro can grow to, computed before anything is expanded: a macro that calls another twice, which does
//! the same, is a few lines that fill any memory.
//!
//! ```text
//! length(value)  <= its own letters + a number for each `$` + the lengths of the values that it names
//! bytes(element) <= its own letters + its attributes + its children; of a call, the body; of insert_block, the block
//! ```
//!
//! Both are followed as deep as the evaluator goes, with every condition taken as true, and the greatest where a name
//! has several values. What recurs once a level grows by its own size a level; what recurs twice doubles, and is
//! refused.
//!
//! Expressions that make much of little (`lambda`, comprehensions, padding) are refused: no robot needs them.
//!
//! | bound | most |
//! |---|---|
//! | bytes of one expression | 2000 |
//! | bytes of one value | 64 KiB |
//! | bytes that the file, or one macro of it, may come to | 1 MiB |
//! | levels that are followed | 100, or until nothing grows any more |

use std::collections::BTreeMap;

use roxmltree::Node;

use super::elements::{DIRECTIVES, is_xacro};
use super::load_yaml::Data;
use super::values::{LONGEST_VALUE, parameters, values};

/// More text than this is not a robot: what a macro of ROS-Industrial expands to has 10 kB without meshes.
const MOST_BYTES: u64 = 1 << 20;
/// A longer expression was not written by hand; the evaluator recurses for each character.
const LONGEST_EXPRESSION: usize = 2000;
/// Digits of a number, sign and exponent included.
const NUMBER: u64 = 32;
/// Levels that the evaluator of `xacro-rs` follows values through, and macros within macros.
const LEVELS: usize = 100;
/// What an expression may not use: functions of the file's own, loops, and methods that lengthen a text.
const REFUSED: [&str; 11] = [
    "lambda",
    "for",
    "center",
    "expandtabs",
    "format",
    "join",
    "ljust",
    "replace",
    "rjust",
    "translate",
    "zfill",
];

/// Why the document cannot be expanded with this data, if it cannot; names are in quotes.
pub(super) fn refusal<'a>(root: Node<'a, '_>, data: &'a [Data]) -> Option<String> {
    let texts = root.descendants().flat_map(|node| {
        let attributes = node.attributes().map(|attribute| attribute.value());
        attributes.chain(node.is_text().then(|| node.text().unwrap_or_default()))
    });
    texts
        .into_iter()
        .find_map(refused_expression)
        .or_else(|| too_long(root, data).err())
}

/// An expression in `text` that is not evaluated whatever its values are.
fn refused_expression(text: &str) -> Option<String> {
    for (at, _) in text.match_indices('$') {
        let rest = text.get(at + 1..).unwrap_or_default();
        // To the last bracket: braces and quotes may contain others.
        let expression = match rest.chars().next() {
            Some('{') => rest.rsplit_once('}').map_or(rest, |(inside, _)| inside),
            Some('(') => rest.rsplit_once(')').map_or(rest, |(inside, _)| inside),
            // It could make an expression of what is none.
            _ => {
                return Some(format!(
                    "`{text}`: a `$` begins an expression, `${{...}}` or `$(...)`"
                ));
            }
        };
        if expression.len() > LONGEST_EXPRESSION {
            let shown: String = expression.chars().take(LONGEST_EXPRESSION / 50).collect();
            return Some(format!(
                "the expression `{shown}` ... is longer than {LONGEST_EXPRESSION} bytes"
            ));
        }
        if let Some(word) = words(expression).find(|word| REFUSED.contains(word)) {
            return Some(format!("`{word}` is not understood in the expression `{text}`"));
        }
    }
    None
}

/// Refuses values and macros that could grow beyond all need.
///
/// Sizes are followed level by level until they stay as they are, at most 100 deep.
fn too_long<'a>(root: Node<'a, '_>, data: &'a [Data]) -> Result<(), String> {
    let lengths = Lengths::of(root, data)?;
    let mut sizes = Sizes::default();
    for _ in 0..LEVELS {
        let next = sizes.one_level_deeper(root, &lengths);
        let too_large = next.bodies.iter().find(|(_, bytes)| **bytes > MOST_BYTES);
        if let Some((name, _)) = too_large {
            return Err(format!("macro `{name}` may expand to more than {}", megabytes()));
        }
        let same = next.bodies == sizes.bodies && next.blocks == sizes.blocks;
        sizes = next;
        if same {
            break;
        }
    }
    match sizes.of_children(root, &lengths) {
        bytes if bytes > MOST_BYTES => Err(format!("the file may expand to more than {}", megabytes())),
        _ => Ok(()),
    }
}

/// The bound as messages show it.
fn megabytes() -> String {
    format!("{} MiB of joints", MOST_BYTES >> 20)
}

/// The names in a text: words of letters, digits and `_`.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .filter(|word| !word.is_empty())
}

/// How long a value can be, by the name of its property, argument or parameter.
struct Lengths<'a>(BTreeMap<&'a str, u64>);

impl<'a> Lengths<'a> {
    /// The greatest length of each name, followed level by level until none grows.
    ///
    /// # Errors
    /// The name whose value may grow too long.
    fn of(root: Node<'a, '_>, data: &'a [Data]) -> Result<Lengths<'a>, String> {
        let mut values = values(root);
        values.extend(
            data.iter()
                .map(|data| (data.property.as_str(), vec![data.value.as_str()])),
        );
        let mut lengths = Lengths(BTreeMap::new());
        for _ in 0..LEVELS {
            let longest = |texts: &Vec<&str>| texts.iter().map(|text| lengths.of_text(text)).max();
            let next: BTreeMap<&str, u64> = values
                .iter()
                .map(|(name, texts)| (*name, longest(texts).unwrap_or_default()))
                .collect();
            if let Some((name, _)) = next.iter().find(|(_, length)| **length > LONGEST_VALUE) {
                return Err(format!(
                    "the value of `{name}` may grow longer than {} KiB",
                    LONGEST_VALUE >> 10
                ));
            }
            let same = next == lengths.0;
            lengths = Lengths(next);
            if same {
                break;
            }
        }
        Ok(lengths)
    }

    /// How long a text can get: any name in it may be replaced by its value.
    ///
    /// Without a `$` its own letters. With one, every word is taken as a name that may be one of the file's, and every
    /// `$` as a number in addition.
    fn of_text(&self, text: &str) -> u64 {
        let own = text.len() as u64;
        if !text.contains('$') {
            return own;
        }
        let numbers = text.matches('$').count() as u64 * NUMBER;
        let named = words(text).filter_map(|word| self.0.get(word));
        named.fold(own + numbers, |sum, length| sum.saturating_add(*length))
    }
}

/// How many bytes macros and blocks can come to, by name, as far as levels have been followed.
#[derive(Default)]
struct Sizes<'a> {
    /// Of macros, as a call of them gives.
    bodies: BTreeMap<&'a str, u64>,
    /// Of properties and parameters that contain elements, as `insert_block` gives.
    blocks: BTreeMap<&'a str, u64>,
}

impl<'a> Sizes<'a> {
    /// The sizes with calls and blocks counted as `self` has them: one level more than `self` has followed. Of several
    /// of one name the greatest counts.
    fn one_level_deeper(&self, root: Node<'a, '_>, lengths: &Lengths<'_>) -> Sizes<'a> {
        let mut next = Sizes::default();
        let mut given: BTreeMap<&str, u64> = BTreeMap::new();
        let greater = |all: &mut BTreeMap<&'a str, u64>, name: &'a str, bytes: u64| {
            let known = all.entry(name).or_default();
            *known = bytes.max(*known);
        };
        for node in root.descendants().filter(|node| is_xacro(*node)) {
            let name = node.attribute("name").unwrap_or_default();
            match node.tag_name().name() {
                "macro" => greater(&mut next.bodies, name, self.of_children(node, lengths)),
                "property" => greater(&mut next.blocks, name, self.of_children(node, lengths)),
                called if DIRECTIVES.contains(&called) => {}
                called => greater(&mut given, called, self.of_children(node, lengths)),
            }
        }
        // A parameter of a macro is a block if a call has something inside.
        for node in root.descendants().filter(|node| is_xacro(*node)) {
            let called = node.attribute("name").unwrap_or_default();
            if let Some(bytes) = given.get(called).filter(|_| node.tag_name().name() == "macro") {
                for (name, _) in parameters(node.attribute("params").unwrap_or_default()) {
                    greater(&mut next.blocks, name.trim_start_matches('*'), *bytes);
                }
            }
        }
        next
    }

    /// What the contents of an element can come to.
    fn of_children(&self, node: Node<'_, '_>, lengths: &Lengths<'_>) -> u64 {
        node.children()
            .map(|child| self.of(child, lengths))
            .fold(0, u64::saturating_add)
    }

    /// The largest size of a node after expansion; definitions add nothing.
    fn of(&self, node: Node<'_, '_>, lengths: &Lengths<'_>) -> u64 {
        if !node.is_element() {
            return lengths.of_text(node.text().unwrap_or_default());
        }
        let tag = node.tag_name().name();
        let inside = || self.of_children(node, lengths);
        if !is_xacro(node) {
            let attributes = node.attributes().map(|attribute| {
                (attribute.name().len() as u64).saturating_add(lengths.of_text(attribute.value()))
            });
            let own = 2 * tag.len() as u64;
            return attributes.fold(own.saturating_add(inside()), u64::saturating_add);
        }
        let of = |all: &BTreeMap<&str, u64>, name: &str| all.get(name).copied().unwrap_or_default();
        match tag {
            "property" | "arg" | "macro" => 0,
            "insert_block" => match node.attribute("name").unwrap_or_default() {
                // Any block may be meant.
                name if name.contains('$') => self.blocks.values().copied().max().unwrap_or_default(),
                name => of(&self.blocks, name),
            },
            "if" | "unless" => inside(),
            called => inside().saturating_add(of(&self.bodies, called)),
        }
    }
}
