//! No unsafe code but where ARCHITECTURE.md names it.
//!
//! Comments and literals may say the word. The compiler denies it as well (`unsafe_code` in `Cargo.toml`); this
//! rule counts where an exception is made. Further calls in a file that has its number are reported from the first
//! one too many.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "unsafe code",
    reason: "memory safety is checked by the compiler, except for a few calls that are easy to review",
    check,
};

/// Where it may be, and how often.
const ALLOWED: &[(&str, usize)] = &[
    // After the check for AVX2, and for AVX-512.
    ("crates/core/src/numbers/backend.rs", 2),
    // Names of functions that the page calls: no other may have them.
    ("crates/browser/src/exports.rs", 5),
    // A larger stack for the handler of signals: libc has no safe call for it.
    ("fuzz/src/signal_stack.rs", 1),
];

/// Counts the word in all Rust that ships.
fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for file in tree.rust_files("") {
        let allowed = ALLOWED.iter().find(|(path, _)| *path == file.path);
        let allowed = allowed.map_or(0, |(_, count)| *count);
        violations.extend(file.find(&["unsafe"]).skip(allowed).map(|token| {
            let what = format!("`unsafe`, more than the {allowed} of this file");
            Violation::new(&file.path, token.line, what, "do it safely")
        }));
    }
    violations
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_more_than_allowed_is_reported_and_the_name_of_the_lint_is_not() {
        let call = "unsafe { f() }\n";
        let tree = Tree::of(&[
            (
                ALLOWED[0].0,
                &format!("#[allow(unsafe_code)]\n{}", call.repeat(3)),
            ),
            ("crates/study/src/a.rs", call),
        ]);
        let given: Vec<(String, usize)> = check(&tree)
            .into_iter()
            .map(|violation| (violation.path, violation.line))
            .collect();
        assert_eq!(
            given,
            [
                (ALLOWED[0].0.to_owned(), 4),
                ("crates/study/src/a.rs".to_owned(), 1)
            ]
        );
    }
}
