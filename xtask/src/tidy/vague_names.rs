//! No file, folder or module has a name that would fit anything.
//!
//! Compared are whole names, up to their first dot: `common.rs` and `common/` are vague, `uncommon.rs` is not.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;
use std::collections::BTreeSet;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "vague names",
    reason: "a vague name says nothing about the content, and search does not find it",
    check,
};

const VAGUE: &[&str] = &[
    "util", "utils", "helper", "helpers", "misc", "common", "func", "funcs", "manager", "managers",
];

const HINT: &str = "name it for what it contains";

/// Looks at every file and folder of any kind, and at modules written inside a Rust file.
fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    let mut given = BTreeSet::new();
    for path in tree.paths() {
        let mut end = 0;
        for part in path.split('/') {
            end += part.len();
            let name = part.split('.').next().unwrap_or_default();
            // A folder is reported once, not once for each file in it.
            if VAGUE.contains(&name) && given.insert(&path[..end]) {
                violations.push(Violation::new(path, 1, format!("`{part}` says nothing"), HINT));
            }
            end += 1;
        }
    }
    for file in tree.rust_files("") {
        for row in file.tokens.windows(3) {
            if row[0].text == "mod" && row[2].text == "{" && VAGUE.contains(&row[1].text.as_str()) {
                let what = format!("`mod {}` says nothing", row[1].text);
                violations.push(Violation::new(&file.path, row[0].line, what, HINT));
            }
        }
    }
    violations
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vague_files_folders_and_modules_are_reported_once() {
        let tree = Tree::of(&[
            ("a/utils.rs", ""),
            ("b/common/one.ts", ""),
            ("b/common/two.ts", ""),
            ("c/real.rs", "pub mod helpers {\n}\n"),
        ]);
        let paths: Vec<String> = check(&tree).into_iter().map(|violation| violation.path).collect();
        assert_eq!(paths, ["a/utils.rs", "b/common/one.ts", "c/real.rs"]);
    }

    #[test]
    fn names_that_only_contain_a_vague_word_pass() {
        let tree = Tree::of(&[
            ("a/uncommon.rs", "mod commonality {\n}\n"),
            ("a/utility_function.rs", ""),
        ]);
        assert!(check(&tree).is_empty());
    }
}
