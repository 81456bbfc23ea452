//! Inside the core a module uses only those above it in the reading order.
//!
//! The order is that of the table of modules in ARCHITECTURE.md. Looked at are `crate::name` and as many
//! `super::` as lead to the root; a name that the root re-exports hides its module and is reported too.

use super::Rule;
use super::rust::RustFile;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "module order",
    reason: "the core can be read from top to bottom: each module uses only earlier ones",
    check,
};

/// What every module may use: how long work is watched and cancelled.
const FOR_ALL: &[&str] = &["watch", "Watch"];

/// The page with the order, the root that declares the modules, and their folder.
const PAGE: &str = "ARCHITECTURE.md";
const ROOT: &str = "crates/core/src/lib.rs";
const SOURCE_FOLDER: &str = "crates/core/src/";

/// Looks at every path that begins at the root of the core; tests may use everything.
fn check(tree: &Tree) -> Vec<Violation> {
    let order = reading_order(tree);
    let mut violations = against_root(tree, &order);
    for file in tree.rust_files(SOURCE_FOLDER) {
        let Some((module, depth)) = module_and_depth(&file.path) else {
            continue;
        };
        let place = order.iter().position(|name| *name == module);
        if place.is_none() && !FOR_ALL.contains(&module) {
            let what = format!("module `{module}` is missing in the reading order");
            let hint = "give it a row in the table of modules of ARCHITECTURE.md";
            violations.push(Violation::new(&file.path, 1, what, hint));
            continue;
        }
        let before = &order[..place.unwrap_or(0)];
        for (line, used) in names_from_root(file, depth) {
            if used == module || before.contains(&used.as_str()) || FOR_ALL.contains(&used.as_str()) {
                continue;
            }
            let (what, hint) = if order.contains(&used.as_str()) {
                let what = format!("`{module}` uses `{used}`, which comes after it");
                (what, "move the shared part up, or the caller down")
            } else {
                let what = format!("`crate::{used}` hides the module it comes from");
                (what, "name the module, so that the order is visible")
            };
            violations.push(Violation::new(&file.path, line, what, hint));
        }
    }
    violations
}

/// The modules of the core in reading order: the first column of the table of the page.
fn reading_order(tree: &Tree) -> Vec<&str> {
    let lines = tree.text(PAGE).unwrap_or_default().lines();
    let rows = lines.skip_while(|line| !line.starts_with("| module |"));
    let rows = rows.take_while(|line| line.starts_with('|'));
    rows.filter_map(|row| row.strip_prefix("| `")?.split('`').next())
        .collect()
}

/// Modules that the core has and the table does not, and the other way round.
fn against_root(tree: &Tree, order: &[&str]) -> Vec<Violation> {
    let Some(root) = tree.text(ROOT) else {
        return Vec::new();
    };
    let declared = |line: &'_ str| {
        line.strip_prefix("pub mod ")
            .or_else(|| line.strip_prefix("pub(crate) mod "))?
            .strip_suffix(';')
            .map(str::to_owned)
    };
    let declared: Vec<String> = root.lines().filter_map(declared).collect();
    let absent = order
        .iter()
        .filter(|name| !declared.iter().any(|declared| declared == *name));
    let absent = absent.map(|name| {
        let what = format!("`{name}` of the table of modules is not in the core");
        Violation::new(PAGE, 1, what, "remove its row")
    });
    let unlisted = declared.iter().filter(|name| !order.contains(&name.as_str()));
    let unlisted = unlisted.map(|name| {
        let what = format!("module `{name}` has no row in the table of modules of {PAGE}");
        Violation::new(ROOT, 1, what, "say which question it answers, in reading order")
    });
    absent.chain(unlisted).collect()
}

/// The module of the reading order that the file at `path` belongs to, and how deep in it; nothing for lib.rs.
fn module_and_depth(path: &str) -> Option<(&str, usize)> {
    let inside = path.strip_prefix(SOURCE_FOLDER)?.strip_suffix(".rs")?;
    let inside = inside.strip_suffix("/mod").unwrap_or(inside);
    let module = inside.split('/').next()?;
    (module != "lib").then(|| (module, inside.split('/').count()))
}

/// What the file takes from the root of the core, through `crate::` or through enough `super::`.
fn names_from_root(file: &RustFile, depth: usize) -> Vec<(usize, String)> {
    let mut names = file.names_after("crate");
    names.extend(file.names_after(&vec!["super"; depth].join("::")));
    names.retain(|(_, name)| name != "self");
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "| module | question |\n|---|---|\n| `frame` | ? |\n| `spatial` | ? |\n| `robot` | ? |\n\
                         | `compliance` | ? |\n| `load` | ? |\n| `watch` | ? |\n| `map` | ? |\n\n| `other` | ? |\n";

    fn lines(path: &str, text: &str) -> Vec<usize> {
        check(&Tree::of(&[(PAGE, TABLE), (path, text)]))
            .iter()
            .map(|violation| violation.line)
            .collect()
    }

    #[test]
    fn a_module_that_comes_after_is_reported() {
        let text =
            "use crate::frame::Isometry;\nuse crate::{robot::Robot, load};\nfn f() { crate::map::g() }\n";
        assert_eq!(lines("crates/core/src/compliance/joint.rs", text), [2, 3]);
    }

    #[test]
    fn the_way_around_through_super_is_seen() {
        assert_eq!(
            lines("crates/core/src/spatial.rs", "use super::robot::Robot;\n"),
            [1]
        );
        assert_eq!(
            lines(
                "crates/core/src/robot/joint.rs",
                "use super::super::load::Case;\n"
            ),
            [1]
        );
        assert_eq!(
            lines("crates/core/src/robot/mod.rs", "use super::{frame, map};\n"),
            [1]
        );
    }

    #[test]
    fn names_of_the_root_hide_the_order() {
        assert_eq!(lines("crates/core/src/map/mod.rs", "use crate::Robot;\n"), [1]);
    }

    #[test]
    fn earlier_and_shared_modules_pass() {
        let text = "use crate::watch::Watch;\nuse crate::robot::{self, Robot};\n\
                    use super::joint::Joint;\nuse crate::compliance::gravity;\n";
        assert_eq!(lines("crates/core/src/compliance/cartesian.rs", text), []);
    }

    #[test]
    fn tests_may_use_everything() {
        let text = "// crate::map\n#[cfg(test)]\nmod tests {\n    use crate::elsewhere::x;\n}\n";
        assert_eq!(lines("crates/core/src/frame.rs", text), []);
        assert_eq!(lines("crates/core/src/robot/tests.rs", "use crate::map::x;"), []);
    }

    #[test]
    fn a_module_without_a_place_is_reported() {
        assert_eq!(lines("crates/core/src/new.rs", ""), [1]);
    }

    #[test]
    fn the_table_and_the_core_name_the_same_modules() {
        let root = "pub(crate) mod frame;\npub mod new;\npub mod spatial;\npub mod robot;\npub mod compliance;\npub mod load;\n\
                    pub mod map;\nuse crate::map::x;\n";
        let violations = check(&Tree::of(&[(PAGE, TABLE), (ROOT, root)]));
        let given: Vec<&str> = violations
            .iter()
            .map(|violation| violation.what.as_str())
            .collect();
        assert_eq!(
            given,
            [
                "`watch` of the table of modules is not in the core",
                "module `new` has no row in the table of modules of ARCHITECTURE.md"
            ]
        );
    }
}
