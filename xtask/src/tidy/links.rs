//! Every relative link of a page leads to a file.
//!
//! Followed are `[text](target)`, pictures and `[name]: target`, from the folder of their page, or from the
//! root where they begin with `/`. Left alone are code blocks, what is in backticks, addresses with `://`,
//! anchors, paths of Rust.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "links",
    reason: "a broken link costs the reader time and trust",
    check,
};

/// Looks at every Markdown page; anchors are not followed, addresses elsewhere are not opened.
fn check(tree: &Tree) -> Vec<Violation> {
    tree.texts_in("", ".md")
        .flat_map(|(path, text)| check_page(tree, path, text))
        .collect()
}

/// The links of one page that lead nowhere.
fn check_page(tree: &Tree, path: &str, text: &str) -> Vec<Violation> {
    let mut violations = Vec::new();
    let mut in_code = false;
    for (index, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        }
        if in_code {
            continue;
        }
        for target in targets(&without_code(line)) {
            if is_relative(target) && !resolve(path, target).is_some_and(|target| tree.has(&target)) {
                let what = format!("link to `{target}` leads nowhere");
                violations.push(Violation::new(
                    path,
                    index + 1,
                    what,
                    "correct it; it counts from this page",
                ));
            }
        }
    }
    violations
}

/// `line` without what is between backticks.
fn without_code(line: &str) -> String {
    line.split('`').step_by(2).collect::<Vec<_>>().join(" ")
}

/// The targets of `[text](target)`, `![text](target "title")` and `[name]: target`.
fn targets(line: &str) -> Vec<&str> {
    let inline = line.match_indices("](").map(|(at, _)| {
        let rest = &line[at + 2..];
        rest.split([')', ' ']).next().unwrap_or_default()
    });
    let definition = line
        .trim_start()
        .strip_prefix('[')
        .and_then(|rest| rest.split_once("]:"));
    let definition = definition.and_then(|(_, target)| target.split_whitespace().next());
    inline
        .chain(definition)
        .map(|target| target.trim_matches(['<', '>']))
        .collect()
}

/// Whether `target` means a file of ours: no address elsewhere, no place on the page, no path of Rust.
fn is_relative(target: &str) -> bool {
    let elsewhere = target.contains("://") || target.starts_with("mailto:") || target.contains("::");
    !target.is_empty() && !target.starts_with('#') && !elsewhere
}

/// The path from the repository root that `target` on the page at `path` means; nothing outside of it.
fn resolve(path: &str, target: &str) -> Option<String> {
    let target = target.split('#').next().unwrap_or_default();
    let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
    let from_root = if let Some(target) = target.strip_prefix('/') {
        target.to_owned()
    } else {
        format!("{folder}/{target}")
    };
    let mut parts = Vec::new();
    for part in from_root.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            _ => parts.push(part),
        }
    }
    Some(parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(page: &str) -> Vec<usize> {
        let tree = Tree::of(&[
            ("docs/page.md", page),
            ("docs/other.md", ""),
            ("robots/a/b.toml", ""),
        ]);
        check(&tree).iter().map(|violation| violation.line).collect()
    }

    #[test]
    fn links_that_lead_nowhere_are_reported() {
        let page =
            "[a](missing.md) and [b](other.md)\n![c](../robots/c.png \"title\")\n[d]: ../../outside.md\n";
        assert_eq!(lines(page), [1, 2, 3]);
    }

    #[test]
    fn links_to_files_folders_anchors_and_elsewhere_pass() {
        let page = "[a](other.md#part) [b](../robots/a) [c](#here) [d](https://example.org/x) [e](/docs/other.md)\n\
                    [f](crate::frame) [g](..)\n";
        assert_eq!(lines(page), []);
    }

    #[test]
    fn code_is_not_read_as_links() {
        assert_eq!(lines("`[a](missing.md)`\n```\n[b](missing.md)\n```\n"), []);
    }
}
