//! The native part of the Python package computes nothing: it passes arrays on.
//!
//! Looked for are the functions that mechanics is made of, conversions between units, and numbers with a fraction
//! except those that fill arrays.

use super::Rule;
use super::rust::Token;
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
        for Token { text, line } in &file.tokens {
            let what = match text.as_str() {
                word if MECHANICS.contains(&word) => format!("`{word}`"),
                number if is_fraction(number) => format!("the number {number}"),
                _ => continue,
            };
            let hint = "the core or armill-study computes it, for every surface";
            violations.push(Violation::new(&file.path, *line, what, hint));
        }
    }
    violations
}

/// Whether `word` is a number with a fraction or an exponent, other than 0.0 and 1.0.
fn is_fraction(word: &str) -> bool {
    let is_number = word.starts_with(|c: char| c.is_ascii_digit());
    is_number
        && !["0.0", "1.0"].contains(&word)
        && word.parse::<u64>().is_err()
        && word.parse::<f64>().is_ok()
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
