//! The factors between SI and the units of people are written in one file.
//!
//! ```text
//! deviation_um: to_um(moved)          the function of `units.rs` in the core
//! deviation_um: moved * 1e6           a violation
//! ```
//!
//! Looked at are a factor of 1e3, 1e6 or their inverse after a `*`, and conversions of angles. A number that is rounded
//! or of another kind says so in a comment, `// unit:`.

use super::Rule;
use super::tree::Tree;
use super::units::is_exempt;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "unit factors",
    reason: "a factor in the wrong direction is found by reading one file, not seven hundred lines",
    check,
};

/// Inside, everything is SI, and numbers of this size mean something else; `units.rs` is there.
const INSIDE: &str = "crates/core/src/";

/// A factor or conversion, and the functions to use instead.
const FACTORS: &[([&str; 2], &str)] = &[
    (["*", "1e6"], "`to_um`, or `to_mm2` for an area"),
    (["*", "1e3"], "`to_mm`, or `from_per_mm` for a stiffness"),
    (["*", "1e-3"], "`from_mm`, or `to_per_mm` for a stiffness"),
    (["*", "1e-6"], "`from_um`"),
    (["to_degrees", ""], "`to_deg`"),
    (["to_radians", ""], "`from_deg`"),
];

/// Looks at the crates outside the core.
fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for file in tree.rust_files("crates/") {
        if file.path.starts_with(INSIDE) || !file.path.contains("/src/") {
            continue;
        }
        for (words, instead) in FACTORS {
            let words: Vec<&str> = words.iter().copied().filter(|word| !word.is_empty()).collect();
            let found = file.find(&words).filter(|token| !is_exempt(file, token.line));
            violations.extend(found.map(|token| {
                let what = format!("`{}` outside `units.rs`", words.join(" "));
                Violation::new(&file.path, token.line, what, format!("use {instead}"))
            }));
        }
    }
    violations
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_reported_but_in_their_file_and_with_a_reason() {
        let text = "fn f(x: f64) -> f64 { x * 1e6 }\n// unit: ms\nfn g(s: f64) -> f64 { s * 1e3 }\n\
                    fn h(x: f64) -> f64 { x.to_degrees() }\n";
        let tree = Tree::of(&[
            ("crates/core/src/units.rs", text),
            ("crates/study/src/a.rs", text),
        ]);
        let found: Vec<(String, usize)> = check(&tree)
            .into_iter()
            .map(|violation| (violation.path, violation.line))
            .collect();
        assert_eq!(
            found,
            [
                ("crates/study/src/a.rs".to_owned(), 1),
                ("crates/study/src/a.rs".to_owned(), 4)
            ]
        );
    }
}
