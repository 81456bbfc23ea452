//! What the core never does: files, environment, time, printing, randomness, serialisation, hash order.

use super::Rule;
use super::rust::{RustFile, find_word};
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "absence in the core",
    reason: "same input, same result: the core computes, everything else belongs to its callers",
    check,
};

/// Modules of the standard library, with what to do instead.
const STD_MODULES: &[(&str, &str)] = &[
    (
        "fs",
        "reading and writing belongs to armill-formats and armill-study",
    ),
    (
        "io",
        "reading and writing belongs to armill-formats and armill-study",
    ),
    ("env", "settings come in as parameters"),
    ("time", "the core knows no clock; its callers measure time"),
];

/// Macros that print.
const PRINTING: &[&str] = &["println", "eprintln", "print", "eprint", "dbg"];

/// Names of types and crates, with what to do instead.
const NAMES: &[(&str, &str)] = &[
    ("HashMap", "its order changes from run to run: BTreeMap or Vec"),
    ("HashSet", "its order changes from run to run: BTreeSet or Vec"),
    (
        "serde",
        "serialisation belongs to armill-formats and armill-study",
    ),
    (
        "serde_json",
        "serialisation belongs to armill-formats and armill-study",
    ),
    ("rand", "seeds and samples come in as parameters"),
];

/// Looks at the core without its tests; comments and literals may name these things.
fn check(tree: &Tree) -> Vec<Violation> {
    tree.rust_files("crates/core/src/")
        .iter()
        .flat_map(check_file)
        .collect()
}

fn check_file(file: &RustFile<'_>) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (line, name) in file.names_after("std") {
        if let Some((module, hint)) = STD_MODULES.iter().find(|(module, _)| *module == name) {
            violations.push(Violation::new(
                file.path,
                line,
                format!("std::{module} in the core"),
                *hint,
            ));
        }
    }
    for (index, code) in file.code.iter().enumerate() {
        for name in PRINTING {
            if find_word(code, name).is_some_and(|at| code[at + name.len()..].starts_with('!')) {
                let hint = "return the value, or report progress to the Watch";
                violations.push(Violation::new(
                    file.path,
                    index + 1,
                    format!("{name}! in the core"),
                    hint,
                ));
            }
        }
        for (name, hint) in NAMES {
            // `rand` can be a word of prose in an identifier, but as a crate it is followed by its path.
            let found =
                find_word(code, name).filter(|at| *name != "rand" || code[at + 4..].starts_with("::"));
            if found.is_some() {
                violations.push(Violation::new(
                    file.path,
                    index + 1,
                    format!("{name} in the core"),
                    *hint,
                ));
            }
        }
    }
    violations
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Vec<String> {
        let violations = check(&Tree::of(&[("crates/core/src/a.rs", text)]));
        violations
            .into_iter()
            .map(|violation| format!("{} {}", violation.line, violation.what))
            .collect()
    }

    #[test]
    fn files_and_clocks_are_told_also_from_a_group() {
        let text = "use std::{f64, fs};\nlet t = std::time::Instant::now();\n";
        assert_eq!(found(text), ["1 std::fs in the core", "2 std::time in the core"]);
    }

    #[test]
    fn printing_and_hash_order_are_told() {
        let text = "println!(\"\");\nlet m: HashMap<u8, u8>;\nrand::random();\n#[derive(serde::Serialize)]\n";
        assert_eq!(
            found(text),
            [
                "1 println! in the core",
                "2 HashMap in the core",
                "3 rand in the core",
                "4 serde in the core"
            ]
        );
    }

    #[test]
    fn comments_literals_tests_and_other_crates_pass() {
        let text = "// HashMap and std::fs\nlet rand = \"println!\";\nuse std::fmt;\nwrite!(f, \"\");\n\
                    #[cfg(test)]\nmod tests {\n    use std::fs;\n}\n";
        assert!(found(text).is_empty());
        assert!(check(&Tree::of(&[("crates/cli/src/a.rs", "use std::fs;")])).is_empty());
    }
}
