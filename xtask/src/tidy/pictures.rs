//! Every picture is in the table of its crate and in the gallery.
//!
//! Found by text: a type whose `impl` has a `pub fn to_svg(`. The table is that of the crate's head, where each
//! picture answers a question; the gallery is an example that draws one of each.

use super::Rule;
use super::rust::find_word;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "pictures",
    reason: "every picture must be listed in the table and shown in the gallery",
    check,
};

const FOLDER: &str = "crates/report/src/";
const TABLE: &str = "crates/report/src/lib.rs";
const GALLERY: &str = "crates/report/examples/gallery/";

/// A picture is a public type with `to_svg`.
fn check(tree: &Tree) -> Vec<Violation> {
    let table: Vec<&str> = tree
        .text(TABLE)
        .unwrap_or_default()
        .lines()
        .filter(|line| line.starts_with("//! |"))
        .collect();
    let table = table.join("\n");
    let gallery: String = tree.texts_in(GALLERY, ".rs").map(|(_, text)| text).collect();
    let mut violations = Vec::new();
    for file in tree.rust_files(FOLDER) {
        for (index, name) in pictures(&file.lines) {
            if !table.contains(&format!("[`{name}`]")) {
                let what = format!("`{name}` is not in the table of {TABLE}");
                violations.push(Violation::new(
                    &file.path,
                    index + 1,
                    what,
                    "say which question it answers",
                ));
            }
            if find_word(&gallery, name).is_none() {
                let what = format!("`{name}` is not in {GALLERY}");
                violations.push(Violation::new(&file.path, index + 1, what, "show one there"));
            }
        }
    }
    violations
}

/// The types of a file that have a public `to_svg`, with the line of their `impl`.
fn pictures(code: &[String]) -> Vec<(usize, &str)> {
    let mut of = None;
    let mut found = Vec::new();
    for (index, line) in code.iter().enumerate() {
        if let Some(name) = line.strip_prefix("impl ") {
            of = name.split([' ', '<']).next().map(|name| (index, name));
        } else if line.trim_start().starts_with("pub fn to_svg(") {
            found.extend(of);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_without_row_or_example_is_reported() {
        let picture = |name: &str| {
            format!("pub struct {name} {{}}\nimpl {name} {{\n    pub fn to_svg(&self) -> String {{}}\n}}\n")
        };
        let tree = Tree::of(&[
            ("crates/report/src/map.rs", &picture("Map")),
            ("crates/report/src/plot.rs", &picture("Plot")),
            (
                "crates/report/src/svg.rs",
                "impl Svg {\n    fn to_svg(&self) {}\n}\n",
            ),
            (TABLE, "//! | where? | [`Map`] |\n"),
            ("crates/report/examples/gallery/main.rs", "Map::default()"),
        ]);
        let given: Vec<String> = check(&tree).into_iter().map(|violation| violation.what).collect();
        assert_eq!(
            given,
            [
                "`Plot` is not in the table of crates/report/src/lib.rs",
                "`Plot` is not in crates/report/examples/gallery/"
            ]
        );
    }
}
