//! Every rule that is written is checked.
//!
//! A rule is any file in `xtask/src/tidy/` with a `pub const RULE`.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "own rules",
    reason: "a rule that is never called checks nothing",
    check,
};

const FOLDER: &str = "xtask/src/tidy/";

/// Compares the files of this folder that have a `RULE` with the list in `mod.rs`.
fn check(tree: &Tree) -> Vec<Violation> {
    let list = format!("{FOLDER}mod.rs");
    let list = tree.text(&list).unwrap_or_default();
    let rules = tree
        .texts_in(FOLDER, ".rs")
        .filter(|(_, text)| text.contains("pub const RULE: Rule ="));
    let module = |path: &str| path.trim_start_matches(FOLDER).trim_end_matches(".rs").to_owned();
    rules
        .filter(|(path, _)| !list.contains(&format!("    {}::RULE,", module(path))))
        .map(|(path, _)| Violation::new(path, 1, "this rule is not in RULES", "add it in mod.rs"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rule_that_is_not_listed_is_reported() {
        let rule = "pub const RULE: Rule = Rule {};\n";
        let tree = Tree::of(&[
            (
                "xtask/src/tidy/mod.rs",
                "const RULES: &[Rule] = &[\n    one::RULE,\n];\n",
            ),
            ("xtask/src/tidy/one.rs", rule),
            ("xtask/src/tidy/two.rs", rule),
            ("xtask/src/tidy/tree.rs", ""),
        ]);
        let violations = check(&tree);
        assert_eq!(violations.len(), 1);
        assert_eq!(violations[0].path, "xtask/src/tidy/two.rs");
    }
}
