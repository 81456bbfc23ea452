//! No Rust file is longer than a sitting, its tests not counted.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "file length",
    reason: "a file is one idea, and one idea fits into one sitting",
    check,
};

/// Lines before the tests.
const LIMIT: usize = 500;

/// Looks at `crates/`, `xtask/` and `validation/`; files that are tests alone may be longer.
fn check(tree: &Tree) -> Vec<Violation> {
    let files = ["crates/", "xtask/", "validation/"]
        .into_iter()
        .flat_map(|folder| tree.rust_files(folder));
    let long = files.filter(|file| file.code.len() > LIMIT);
    long.map(|file| {
        let what = format!("{} lines before the tests, limit {LIMIT}", file.code.len());
        Violation::new(file.path, LIMIT + 1, what, "split it by idea")
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_before_the_tests_are_counted() {
        let long = "x();\n".repeat(LIMIT + 1);
        let tests = format!("{}#[cfg(test)]\nmod tests {{\n{long}}}\n", "x();\n".repeat(LIMIT));
        let tree = Tree::of(&[
            ("crates/core/src/long.rs", long.as_str()),
            ("crates/core/src/well_tested.rs", tests.as_str()),
            ("crates/core/tests/long.rs", long.as_str()),
            ("elsewhere/long.rs", long.as_str()),
        ]);
        let violations = check(&tree);
        assert_eq!(violations.len(), 1);
        assert_eq!(violations[0].path, "crates/core/src/long.rs");
        assert_eq!(violations[0].line, LIMIT + 1);
    }
}
