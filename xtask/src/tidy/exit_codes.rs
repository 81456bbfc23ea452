//! The exit codes of the command are described with the same words everywhere.
//!
//! Compared are the words from the first `Exit code` of a file to the full stop, line breaks and `//!` taken
//! out.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "exit codes",
    reason: "scripts rely on the described exit codes",
    check,
};

/// Where they are described; the others must match the first.
const PLACES: &[&str] = &[
    "crates/cli/src/lib.rs",
    "ARCHITECTURE.md",
    "docs/guide/results.md",
];

/// Compares the sentences that begin with `Exit code`.
fn check(tree: &Tree) -> Vec<Violation> {
    let there = PLACES.iter().filter_map(|path| Some((*path, tree.text(path)?)));
    let given: Vec<(&str, String)> = there.map(|(path, text)| (path, codes(text))).collect();
    let Some((_, witness)) = given.first() else {
        return Vec::new();
    };
    let others = given.iter().skip(1).filter(|(_, codes)| codes != witness);
    others
        .map(|(path, codes)| {
            let what = format!("exit codes `{codes}`, where {} has `{witness}`", PLACES[0]);
            Violation::new(path, 1, what, "use the same words")
        })
        .collect()
}

/// The codes with their meanings, on one line: `0: fine; 1: ...`.
fn codes(text: &str) -> String {
    let sentence = text.split_once("Exit code ").map_or("", |(_, rest)| rest);
    let lines = sentence.lines().map(|line| line.trim_start_matches("//!").trim());
    let words = lines
        .take_while(|line| !line.is_empty())
        .collect::<Vec<_>>()
        .join(" ");
    words.split('.').next().unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_words_are_reported_and_line_breaks_are_ignored() {
        let tree = Tree::of(&[
            (
                PLACES[0],
                "//! Talk. Exit code 0: fine;\n//! 2: bad input. More.\n",
            ),
            (PLACES[1], "Exit code 0: fine; 2: bad input.\n"),
            (PLACES[2], "Exit code 0: fine; 3: bad input.\n"),
        ]);
        let violations = check(&tree);
        assert_eq!(violations.len(), 1);
        assert_eq!(violations[0].path, PLACES[2]);
    }
}
