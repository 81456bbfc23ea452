//! Every robot, material and study of the repository is built into the command.
//!
//! Found by name: a path in any Rust file of the library counts, so that a list in a comment would pass. The
//! tests of the library read every entry.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "embedded library",
    reason: "every command works from an empty folder: files must be embedded",
    check,
};

/// Where the library is embedded: this file, or a folder of that name.
const LIBRARY: &str = "crates/study/src/library";

/// The library must name each file of `robots/`, `materials/` and `studies/` by its path from the repository root.
/// Pages for readers (`.md`) need not be embedded.
fn check(tree: &Tree) -> Vec<Violation> {
    let library: String = tree.texts_in(LIBRARY, ".rs").map(|(_, text)| text).collect();
    let files = tree.paths().filter(|path| {
        ["robots/", "materials/", "studies/"]
            .iter()
            .any(|folder| path.starts_with(folder))
    });
    let missing = files.filter(|path| !path.ends_with(".md") && !library.contains(path));
    missing
        .map(|path| {
            let what = format!("not embedded: {LIBRARY}.rs does not name it");
            Violation::new(path, 1, what, "add it there, or remove it from the library")
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILES: &[(&str, &str)] = &[
        ("robots/maker/one.toml", ""),
        ("robots/README.md", ""),
        ("materials/steel.toml", ""),
        ("studies/groove/study.toml", ""),
    ];

    #[test]
    fn files_missing_in_the_library_are_reported() {
        let library = "include_str!(\"../../../robots/maker/one.toml\")";
        let tree = Tree::of(&[FILES, &[("crates/study/src/library.rs", library)]].concat());
        let paths: Vec<String> = check(&tree).into_iter().map(|violation| violation.path).collect();
        assert_eq!(paths, ["materials/steel.toml", "studies/groove/study.toml"]);
    }

    #[test]
    fn a_library_that_names_all_passes() {
        let library = "robots/maker/one.toml materials/steel.toml studies/groove/study.toml";
        let tree = Tree::of(&[FILES, &[("crates/study/src/library/mod.rs", library)]].concat());
        assert!(check(&tree).is_empty());
    }
}
