//! The texts that properties, arguments and parameters of macros are given.

use std::collections::BTreeMap;

use roxmltree::Node;

use super::elements::{DIRECTIVES, is_xacro};

/// A longer value is neither a name nor a list of numbers.
pub(super) const LONGEST_VALUE: u64 = 64 << 10;

/// All texts that the files give each property, argument and parameter, by its name.
pub(super) type Values<'a> = BTreeMap<&'a str, Vec<&'a str>>;

/// The texts that each name is given anywhere; an empty one for a parameter without default.
pub(super) fn values<'a>(root: Node<'a, '_>) -> Values<'a> {
    let mut values: Values<'_> = BTreeMap::new();
    for node in root.descendants().filter(|node| is_xacro(*node)) {
        match node.tag_name().name() {
            "property" | "arg" => {
                let given = ["value", "default"].into_iter();
                let given = given.filter_map(|of| node.attribute(of));
                values
                    .entry(node.attribute("name").unwrap_or_default())
                    .or_default()
                    .extend(given);
            }
            "macro" => {
                for (name, default) in parameters(node.attribute("params").unwrap_or_default()) {
                    values.entry(name).or_default().push(default);
                }
            }
            name if DIRECTIVES.contains(&name) => {}
            _ => {
                for attribute in node.attributes() {
                    values
                        .entry(attribute.name())
                        .or_default()
                        .push(attribute.value());
                }
            }
        }
    }
    values
}

/// Each parameter of a macro with its default.
///
/// Separated by blanks outside of quotes and brackets: `a b:=1 *block c:='x y'`. The default is empty where there is
/// none.
pub(super) fn parameters(text: &str) -> Vec<(&str, &str)> {
    let mut quote = None;
    let mut depth = 0_usize;
    let ends = |c: char| {
        match (quote, c) {
            (Some(open), _) if open == c => quote = None,
            (Some(_), _) => {}
            (None, '\'' | '"') => quote = Some(c),
            (None, '{' | '(') => depth += 1,
            (None, '}' | ')') => depth = depth.saturating_sub(1),
            _ => {}
        }
        c.is_whitespace() && quote.is_none() && depth == 0
    };
    let all = text.split(ends).filter(|one| !one.is_empty());
    all.map(|one| match one.split_once('=') {
        Some((name, default)) => (name.trim_end_matches(':'), default),
        None => (one, ""),
    })
    .collect()
}
