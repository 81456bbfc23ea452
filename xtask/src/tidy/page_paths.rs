//! Every path that ARCHITECTURE.md names in backticks is there.
//!
//! A path may be given from the root, or by an end that only one file has: `backend.rs`. NAME and MAKER are
//! placeholders for any name.

use super::Rule;
use super::rust::is_word;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "paths of the page",
    reason: "every path on the page must exist",
    check,
};

const PAGE: &str = "ARCHITECTURE.md";

/// Words in a path that are placeholders for any name.
const ANY: &[&str] = &["NAME", "MAKER"];

/// Endings of files that the page names without a folder.
const ENDINGS: &[&str] = &[".rs", ".toml", ".md"];

/// Files of a study or of a user's folder: not files of the repository.
const OF_USERS: &[&str] = &["study.toml"];

/// Looks at what is between backticks outside of code blocks.
fn check(tree: &Tree) -> Vec<Violation> {
    let mut in_block = false;
    let mut violations = Vec::new();
    for (index, line) in tree.text(PAGE).unwrap_or_default().lines().enumerate() {
        in_block ^= line.starts_with("```");
        if in_block {
            continue;
        }
        for token in line.split('`').skip(1).step_by(2).filter(|token| is_path(token)) {
            let found = tree.paths().filter(|path| leads_to(token, path)).count();
            let (what, hint) = match found {
                0 => (format!("`{token}` is not there"), "correct it"),
                1 => continue,
                _ if is_whole(tree, token) => continue,
                _ => (
                    format!("`{token}` may mean {found} files"),
                    "write its whole path",
                ),
            };
            violations.push(Violation::new(PAGE, index + 1, what, hint));
        }
    }
    violations
}

/// Whether `token` is written like a path: of files with an ending, or with a folder in it.
fn is_path(token: &str) -> bool {
    let like_a_path = token.chars().all(|c| is_word(c) || matches!(c, '.' | '/' | '-'));
    let has_ending = ENDINGS.iter().any(|ending| token.ends_with(ending));
    like_a_path && (token.contains('/') || has_ending) && !OF_USERS.contains(&token)
}

/// Whether `path`, or a folder that it is in, is `token` or ends with it.
fn leads_to(token: &str, path: &str) -> bool {
    let token: Vec<&str> = token.trim_end_matches('/').split('/').collect();
    let parts: Vec<&str> = path.split('/').collect();
    let same = |(requested, part): (&&str, &&str)| {
        let any =
            |any: &&str| part.ends_with(requested.trim_start_matches(any)) && requested.starts_with(any);
        requested == part || ANY.iter().any(any)
    };
    parts
        .windows(token.len())
        .any(|window| token.iter().zip(window).all(same))
}

/// Whether `token` is relative to the root, or matches several files.
fn is_whole(tree: &Tree, token: &str) -> bool {
    let token = token.trim_end_matches('/');
    let folder = token.rsplit_once('/').map_or("", |(folder, _)| folder);
    let is_placeholder = ANY.iter().any(|any| token.contains(any));
    tree.has(token) || (is_placeholder && tree.has(folder.split("/MAKER").next().unwrap_or_default()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reported(page: &str) -> Vec<String> {
        let tree = Tree::of(&[
            (PAGE, page),
            ("crates/core/src/robot/mod.rs", ""),
            ("crates/core/src/load/mod.rs", ""),
            ("crates/core/src/load/law.rs", ""),
            ("robots/kuka/a.toml", ""),
        ]);
        check(&tree).into_iter().map(|violation| violation.what).collect()
    }

    #[test]
    fn paths_that_lead_nowhere_or_to_several_files_are_reported() {
        assert_eq!(
            reported("`gone.rs`, `mod.rs`\n`crates/none/`\n```\n`gone.rs`\n```\n"),
            [
                "`gone.rs` is not there",
                "`mod.rs` may mean 2 files",
                "`crates/none/` is not there"
            ]
        );
    }

    #[test]
    fn full_paths_unique_ends_and_placeholders_pass() {
        let page = "`law.rs`, `load/mod.rs`, `crates/core/src/load/NAME.rs`, `robots/MAKER/`, `crates/core/src/`, `no path`";
        assert_eq!(reported(page), [""; 0]);
    }
}
