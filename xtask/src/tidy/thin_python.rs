//! The native part of the Python package computes nothing: it passes arrays on.
//!
//! Looked for are the functions that mechanics is made of, conversions between units, and numbers with a fraction
//! except those that fill arrays.

use super::Rule;
use super::rust::{find_word, is_word};
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "thin Python",
    reason: "what only Python computes would be missing in the command and on the page",
    check,
};

/// What mechanics and units are made of.
const MECHANICS: &[&str] = &[
    "to_radians",
    "to_degrees",
    "sin",
    "cos",
    "sin_cos",
    "atan2",
    "sqrt",
    "powi",
    "cross",
    "dot",
    "norm",
];

/// Looks at the package without its tests.
fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for file in tree.rust_files("crates/py/src/") {
        for (index, line) in file.code.iter().enumerate() {
            let mut given = |what: String| {
                let hint = "the core or armill-study computes it, for every surface";
                violations.push(Violation::new(file.path, index + 1, what, hint));
            };
            for word in MECHANICS {
                if find_word(line, word).is_some() {
                    given(format!("`{word}`"));
                }
            }
            for number in fractions(line) {
                given(format!("the number {number}"));
            }
        }
    }
    violations
}

/// Numbers with a fraction or an exponent, but for 0.0 and 1.0.
fn fractions(line: &str) -> impl Iterator<Item = &str> {
    let numbers = line.split(|c: char| !is_word(c) && c != '.');
    numbers.filter(|word| {
        let is_number = word.starts_with(|c: char| c.is_ascii_digit());
        is_number
            && !["0.0", "1.0"].contains(word)
            && word.parse::<u64>().is_err()
            && word.parse::<f64>().is_ok()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mechanics_and_units_are_reported_and_what_fills_arrays_is_not() {
        let tree = Tree::of(&[
            (
                "crates/py/src/a.rs",
                "let a = [0.0, 1.0];\nlet b = 3 * a.len();\nlet c = q * 57.29;\nlet d = q.to_radians() * 1e3;\n",
            ),
            ("crates/core/src/a.rs", "x.sin() * 0.5\n"),
        ]);
        let lines: Vec<usize> = check(&tree).iter().map(|violation| violation.line).collect();
        assert_eq!(lines, [3, 4, 4]);
    }
}
