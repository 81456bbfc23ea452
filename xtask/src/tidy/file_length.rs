//! No Rust file is too long to be read at once, its tests not included.
//!
//! 500 lines, comments and blank lines included; `predict.rs`, which shows the whole idea, has 80.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "file length",
    reason: "a file is one idea, and short enough to be read at once",
    check,
};

/// Lines before the tests.
const LIMIT: usize = 500;

/// The file that shows the whole idea, and its number of lines.
const IDEA: (&str, usize) = ("crates/core/src/predict.rs", 80);

/// Looks at all Rust; files that are tests alone may be longer.
fn check(tree: &Tree) -> Vec<Violation> {
    let files = tree.rust_files("");
    let long = files.filter_map(|file| {
        let limit = if file.path == IDEA.0 { IDEA.1 } else { LIMIT };
        let lines = file.lines.len();
        (lines > limit).then(|| {
            let what = format!("{lines} lines before the tests, limit {limit}");
            Violation::new(&file.path, limit + 1, what, "split it by idea")
        })
    });
    long.collect()
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
            ("bench/src/long.rs", long.as_str()),
            (IDEA.0, &tests[..80 * 5 + 5]),
        ]);
        let given: Vec<(String, usize)> = check(&tree)
            .into_iter()
            .map(|violation| (violation.path, violation.line))
            .collect();
        let expected = [
            ("bench/src/long.rs", 501),
            ("crates/core/src/long.rs", 501),
            (IDEA.0, 81),
        ];
        assert_eq!(given, expected.map(|(path, line)| (path.to_owned(), line)));
    }
}
