//! No path of the machine where the project is developed.

use super::Rule;
use super::rust::is_word;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "machine paths",
    reason: "a path of one machine is not valid on another",
    check,
};

/// In two parts each: this file must not break its own rule.
const PATHS: &[&str] = &[
    concat!("/wor", "k/"),
    concat!("/roo", "t/"),
    concat!("/.li", "brary"),
    concat!(".li", "brary/"),
];

/// Looks at every text file; `/home/` and the like are not listed, as examples may show them.
fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (path, text) in tree.texts() {
        for (index, line) in text.lines().enumerate() {
            if let Some(found) = PATHS.iter().find(|found| begins_a_path(line, found)) {
                let what = format!("`{found}` is a path of one machine");
                violations.push(Violation::new(
                    path,
                    index + 1,
                    what,
                    "give the path relative to the repository, or remove it",
                ));
            }
        }
    }
    violations
}

/// Whether `found` is in `line` as the beginning of a path, not inside of a longer one or a method call.
fn begins_a_path(line: &str, found: &str) -> bool {
    let inside = |c: char| is_word(c) || matches!(c, '.' | ')' | ']' | '}' | '-');
    // A hidden folder may be in any other.
    let hidden = found.starts_with("/.");
    line.match_indices(found)
        .any(|(at, _)| hidden || !line[..at].ends_with(inside))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<usize> {
        let text = text.replace('~', "");
        check(&Tree::of(&[("a.md", &text)]))
            .iter()
            .map(|violation| violation.line)
            .collect()
    }

    #[test]
    fn paths_of_one_machine_are_reported() {
        assert_eq!(
            lines("see /wo~rk/main\nfine\n\"/ro~ot/.cargo\"\n/x/.lib~rary\n"),
            [1, 3, 4]
        );
    }

    #[test]
    fn longer_paths_and_method_calls_pass() {
        assert_eq!(
            lines("https://example.org/wo~rk/x\n../wo~rk/x\nself.lib~rary()\na.lib~rary/2\n"),
            []
        );
    }
}
