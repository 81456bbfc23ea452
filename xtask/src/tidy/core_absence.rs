//! What the core never does: files, environment, time, printing, randomness, serialisation, hash order, global state.
//!
//! | never | instead |
//! |---|---|
//! | files, environment, clock, process, network | come in as parameters, go out as values |
//! | threads | rayon, results written by index |
//! | printing | values, or progress to the watch |
//! | hash maps and sets | `BTreeMap`, `Vec`: the same order in every run |
//! | random numbers, global state | seeds and values come in |
//!
//! Tests may do all of it. Found by name: a type that is renamed by `use ... as` is not seen.

use super::Rule;
use super::rust::RustFile;
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
    ("time", "the core does not use a clock; its callers measure time"),
    ("process", "the core starts nothing"),
    ("net", "the core reaches nothing outside itself"),
    ("thread", "work is spread by rayon, written by index"),
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
    ("thread_local", STATE),
    ("LazyLock", STATE),
    ("OnceLock", STATE),
    ("OnceCell", STATE),
];

/// What to do instead of a static.
const STATE: &str = "there is no global state: pass values as arguments and return them";

/// The only static, and where: a flag that is never set.
const NEVER: (&str, &str) = ("crates/core/src/watch.rs", "NEVER");

/// Looks at the core without its tests; comments and literals may name these things.
fn check(tree: &Tree) -> Vec<Violation> {
    tree.rust_files("crates/core/src/").flat_map(check_file).collect()
}

/// What one file of the core does that it should not.
fn check_file(file: &RustFile) -> Vec<Violation> {
    let mut violations = Vec::new();
    let mut found = |line: usize, what: String, hint: &str| {
        violations.push(Violation::new(&file.path, line, what, hint));
    };
    for (line, name) in file.names_after("std") {
        if let Some((module, hint)) = STD_MODULES.iter().find(|(module, _)| *module == name) {
            found(line, format!("std::{module} in the core"), hint);
        }
    }
    for (at, token) in file.tokens.iter().enumerate() {
        let next = file.tokens.get(at + 1).map_or("", |next| &next.text);
        let text = token.text.as_str();
        if text == "static" && (file.path.as_str(), next) != NEVER {
            found(token.line, "a static in the core".to_owned(), STATE);
        } else if next == "!" && PRINTING.contains(&text) {
            let hint = "return the value, or report progress to the Watch";
            found(token.line, format!("{text}! in the core"), hint);
        } else if let Some((_, hint)) = NAMES.iter().find(|(name, _)| *name == text)
            // `rand` can be a word of its own, but as a crate it is followed by its path.
            && (text != "rand" || next == ":")
        {
            found(token.line, format!("{text} in the core"), hint);
        }
    }
    violations.dedup();
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
    fn files_and_clocks_are_reported_also_from_a_group() {
        let text = "use std::{f64, fs};\nlet t = std::time::Instant::now();\n";
        assert_eq!(found(text), ["1 std::fs in the core", "2 std::time in the core"]);
    }

    #[test]
    fn printing_and_hash_order_are_reported() {
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
    fn global_state_is_reported_and_a_lifetime_is_not() {
        let text = "pub static A: u8 = 0;\nconst B: &'static str = \"\";\nuse std::sync::OnceLock;\nstd::thread::spawn(f);\n";
        assert_eq!(
            found(text),
            [
                "4 std::thread in the core",
                "1 a static in the core",
                "3 OnceLock in the core"
            ]
        );
        let never = "static NEVER: AtomicBool = AtomicBool::new(false);\n";
        assert!(check(&Tree::of(&[(NEVER.0, never)])).is_empty());
    }

    #[test]
    fn comments_literals_tests_and_other_crates_pass() {
        let text = "// HashMap and std::fs\nlet rand = \"println!\";\nuse std::fmt;\nwrite!(f, \"\");\n\
                    #[cfg(test)]\nmod tests {\n    use std::fs;\n}\n";
        assert!(found(text).is_empty());
        assert!(check(&Tree::of(&[("crates/cli/src/a.rs", "use std::fs;")])).is_empty());
    }
}
