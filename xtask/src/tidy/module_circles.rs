//! No circle between the top-level modules of any crate.
//!
//! ```text
//! a -> b -> c -> a        none of the three can be read, tested or moved without the others
//! ```
//!
//! Looked at are `crate::name` and as many `super::` as lead to the root; tests may use everything. A name that the
//! root re-exports is no module and leads nowhere.

use super::Rule;
use super::circles::{Uses, circles};
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "module circles",
    reason: "a module must be readable, testable and movable without the ones that use it",
    check,
};

/// Finds the circles of each crate.
fn check(tree: &Tree) -> Vec<Violation> {
    let manifests = tree.texts_in("crates/", "/Cargo.toml");
    let folders = manifests.filter_map(|(path, _)| path.strip_suffix("Cargo.toml"));
    folders
        .flat_map(|folder| {
            let uses = uses(tree, &format!("{folder}src/"));
            circles(&uses, "move what both need into a module below them")
        })
        .collect()
}

/// The uses between the modules below this folder.
fn uses(tree: &Tree, source: &str) -> Uses {
    let mut uses = Uses::new();
    for file in tree.rust_files(source) {
        let Some(inside) = file
            .path
            .strip_prefix(source)
            .and_then(|path| path.strip_suffix(".rs"))
        else {
            continue;
        };
        let inside = inside.strip_suffix("/mod").unwrap_or(inside);
        let parts: Vec<&str> = inside.split('/').collect();
        let module = parts[0];
        let of_module = uses.entry(module.to_owned()).or_default();
        let mut names = file.names_after("crate");
        names.extend(file.names_after(&vec!["super"; parts.len()].join("::")));
        names.sort();
        for (line, name) in names.into_iter().filter(|(_, name)| name != module) {
            of_module.entry(name).or_insert((file.path.clone(), line));
        }
    }
    uses
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(files: &[(&str, &str)]) -> Vec<String> {
        let mut all = vec![("crates/some/Cargo.toml", "[package]\nname = \"armill-some\"\n")];
        all.extend(files);
        check(&Tree::of(&all))
            .into_iter()
            .map(|violation| format!("{}:{}: {}", violation.path, violation.line, violation.what))
            .collect()
    }

    #[test]
    fn a_circle_over_three_modules_is_reported_with_its_way() {
        let files = [
            ("crates/some/src/a.rs", "use crate::b::x;\n"),
            ("crates/some/src/b/mod.rs", "use super::c;\n"),
            ("crates/some/src/c/deep/file.rs", "\nfn f() { crate::a::g() }\n"),
        ];
        assert_eq!(
            given(&files),
            ["crates/some/src/c/deep/file.rs:2: `c` uses `a`, which leads back to it: a -> b -> c"]
        );
    }

    #[test]
    fn uses_in_one_direction_and_those_of_tests_pass() {
        let files = [
            (
                "crates/some/src/a.rs",
                "use crate::b::x;\n#[cfg(test)]\nmod tests { use crate::c::y; }\n",
            ),
            ("crates/some/src/b.rs", "use crate::Root;\n"),
            ("crates/some/src/c.rs", "use crate::a::z;\n"),
        ];
        assert_eq!(given(&files), Vec::<String>::new());
    }
}
