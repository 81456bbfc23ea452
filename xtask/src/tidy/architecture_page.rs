//! ARCHITECTURE.md names every crate and every folder of the root.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "architecture page",
    reason: "a folder that the map leaves out is one that a stranger cannot place",
    check,
};

const PAGE: &str = "ARCHITECTURE.md";

/// Folders whose name begins with a dot are exempt: tools find them by that name, readers skip them.
fn check(tree: &Tree) -> Vec<Violation> {
    let Some(page) = tree.text(PAGE) else {
        return vec![Violation::new(
            PAGE,
            1,
            "the page is missing",
            "say what each folder is for",
        )];
    };
    let root = tree
        .folders_in("")
        .into_iter()
        .filter(|folder| !folder.starts_with('.'));
    let missing = root
        .chain(tree.folders_in("crates/"))
        .filter(|folder| !names(page, folder));
    missing
        .map(|folder| {
            Violation::new(
                PAGE,
                1,
                format!("`{folder}/` is not mentioned"),
                "say in a line what it is for",
            )
        })
        .collect()
}

/// Whether `page` has `folder/` as a whole word.
fn names(page: &str, folder: &str) -> bool {
    let with_slash = format!("{folder}/");
    page.match_indices(&with_slash)
        .any(|(at, _)| !page[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '-'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_is_not_mentioned_is_told() {
        let page = "crates/\n  core/ the mechanics\nmyrobots/\n";
        let tree = Tree::of(&[
            (PAGE, page),
            ("crates/core/a.rs", ""),
            ("robots/a.toml", ""),
            (".ci/run", ""),
        ]);
        let violations = check(&tree);
        assert_eq!(violations.len(), 1);
        assert!(violations[0].what.contains("robots/"));
    }

    #[test]
    fn a_page_that_names_all_passes() {
        let tree = Tree::of(&[
            (PAGE, "crates/core/ and `robots/`"),
            ("crates/core/a.rs", ""),
            ("robots/a.toml", ""),
        ]);
        assert!(check(&tree).is_empty());
    }
}
