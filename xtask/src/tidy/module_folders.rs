//! A module that is a folder begins with its `mod.rs`, which introduces every file of it: by name in its header, or by
//! a comment over a group of them.
//!
//! So there is one place to begin in a folder, never a file `name.rs` next to a folder `name/`. Test modules
//! need no introduction.

use super::Rule;
use super::rust::{RustFile, Token, find_word};
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "module folders",
    reason: "the first file of a folder states its purpose, and what to read next",
    check,
};

/// Looks at all Rust that ships; the tests of a module may be in a folder next to it.
fn check(tree: &Tree) -> Vec<Violation> {
    let files: Vec<&RustFile> = tree.rust_files("").collect();
    let mut violations = Vec::new();
    for file in &files {
        let stem = file.path.trim_end_matches(".rs");
        let folder_file = files.iter().find(|other| {
            other
                .path
                .strip_prefix(stem)
                .is_some_and(|rest| rest.starts_with('/'))
        });
        if let Some(folder_file) = folder_file {
            let what = format!("its module continues in `{}`", folder_file.path);
            let hint = format!("move it to {stem}/mod.rs");
            violations.push(Violation::new(&file.path, 1, what, hint));
        }
        if file.path.ends_with("/mod.rs") {
            violations.extend(unnamed(file));
        }
    }
    violations
}

/// Modules that a `mod.rs` neither names in its header nor introduces by a comment over their group.
fn unnamed(file: &RustFile) -> Vec<Violation> {
    let header: Vec<&str> = file
        .lines
        .iter()
        .filter_map(|line| line.strip_prefix("//!"))
        .collect();
    let header = header.join("\n");
    let declared = file
        .tokens
        .windows(3)
        .filter(|row| row[0].text == "mod" && row[2].text == ";");
    let unnamed = declared.filter(|row| {
        let before = &file.lines[..row[0].line - 1];
        let is_test = before.last().is_some_and(|line| line.trim() == "#[cfg(test)]");
        !is_test && !has_comment(before) && find_word(&header, &row[1].text).is_none()
    });
    let violation = |row: &[Token]| {
        let what = format!("the header does not name `{}`", row[1].text);
        Violation::new(
            &file.path,
            row[0].line,
            what,
            "say what it answers, in reading order",
        )
    };
    unnamed.map(violation).collect()
}

/// Whether the group of lines that `before` ends in begins with a comment.
fn has_comment(before: &[String]) -> bool {
    let group = before.iter().rev().take_while(|line| !line.is_empty());
    group.last().is_some_and(|line| line.starts_with("// "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reported(files: &[(&str, &str)]) -> Vec<String> {
        let violations = check(&Tree::of(files)).into_iter();
        violations
            .map(|violation| format!("{} {}", violation.path, violation.what))
            .collect()
    }

    #[test]
    fn a_folder_next_to_its_file_is_reported_unless_it_contains_tests_alone() {
        let found = reported(&[
            ("src/a.rs", "mod b;\n"),
            ("src/a/b.rs", ""),
            ("src/c.rs", "#[cfg(test)]\nmod tests;\n"),
            ("src/c/tests.rs", ""),
            ("src/ab.rs", ""),
        ]);
        assert_eq!(found, ["src/a.rs its module continues in `src/a/b.rs`"]);
    }

    #[test]
    fn a_module_that_the_header_leaves_out_is_reported() {
        let text = "//! [`shape`](mod@shape): what is drawn.\n\npub mod shape;\nmod sha;\n\n// Beneath it.\nmod line;\nmod point;\n\n#[cfg(test)]\nmod tests;\n";
        assert_eq!(
            reported(&[("src/a/mod.rs", text)]),
            ["src/a/mod.rs the header does not name `sha`"]
        );
    }
}
