//! The command makes no JSON by hand: what it prints are answers of the crates below it.
//!
//! Looked for is the macro of serde that writes JSON in place; answers are types that serialise.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "thin command",
    reason: "every answer must be available in the command, on the page and in Python",
    check,
};

/// Where problems become JSON: they are of no answer.
const PROBLEMS: &str = "crates/cli/src/terminal.rs";

/// Looks at the command without its tests.
fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    let files = tree
        .rust_files("crates/cli/src/")
        .filter(|file| file.path != PROBLEMS);
    for file in files {
        violations.extend(file.find(&["json", "!"]).map(|token| {
            let hint = "give armill-study a type that serialises";
            Violation::new(&file.path, token.line, "json! by hand", hint)
        }));
    }
    violations
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_by_hand_is_reported_but_for_problems() {
        let tree = Tree::of(&[
            (
                "crates/cli/src/a.rs",
                "if arguments.json { f() }\nserde_json::json!({})\n",
            ),
            (PROBLEMS, "json!([])\n"),
            ("crates/study/src/a.rs", "json!([])\n"),
        ]);
        let lines: Vec<usize> = check(&tree).iter().map(|violation| violation.line).collect();
        assert_eq!(lines, [2]);
    }
}
