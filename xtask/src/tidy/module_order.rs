//! Inside the core a module uses only those above it in the reading order.

use super::Rule;
use super::rust::RustFile;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "module order",
    reason: "the core can be read from top to bottom: nothing is needed that was not yet told",
    check,
};

/// The modules of the core, file or folder, in reading order.
const READING_ORDER: &[&str] = &[
    "frame",
    "spatial",
    "robot",
    "compliance",
    "load",
    "source",
    "predict",
    "budget",
    "workpiece",
    "path",
    "watch",
    "kernel",
    "map",
    "optimize",
    "identify",
    "measure",
];

/// What every module may use: how things fail, and how long work is watched and cancelled.
const FOR_ALL: &[&str] = &["error", "watch", "Error", "Result", "Watch"];

const SOURCE_FOLDER: &str = "crates/core/src/";

/// Looks at every path that begins at the root of the core; tests may use everything.
fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for file in tree.rust_files(SOURCE_FOLDER) {
        let Some((module, depth)) = module_and_depth(file.path) else {
            continue;
        };
        let place = READING_ORDER.iter().position(|name| *name == module);
        if place.is_none() && !FOR_ALL.contains(&module) {
            let what = format!("module `{module}` has no place in the reading order");
            let hint = "give it one in READING_ORDER in xtask/src/tidy/module_order.rs";
            violations.push(Violation::new(file.path, 1, what, hint));
            continue;
        }
        let before = &READING_ORDER[..place.unwrap_or(0)];
        for (line, used) in names_from_root(&file, depth) {
            if used == module || before.contains(&used.as_str()) || FOR_ALL.contains(&used.as_str()) {
                continue;
            }
            let (what, hint) = if READING_ORDER.contains(&used.as_str()) {
                let what = format!("`{module}` uses `{used}`, which comes after it");
                (what, "move the shared part up, or the caller down")
            } else {
                let what = format!("`crate::{used}` hides the module it comes from");
                (what, "name the module, so that the order is seen")
            };
            violations.push(Violation::new(file.path, line, what, hint));
        }
    }
    violations
}

/// The module of the reading order that the file at `path` belongs to, and how deep in it; nothing for lib.rs.
fn module_and_depth(path: &str) -> Option<(&str, usize)> {
    let inside = path.strip_prefix(SOURCE_FOLDER)?.strip_suffix(".rs")?;
    let inside = inside.strip_suffix("/mod").unwrap_or(inside);
    let module = inside.split('/').next()?;
    (module != "lib").then(|| (module, inside.split('/').count()))
}

/// What the file takes from the root of the core, through `crate::` or through enough `super::`.
fn names_from_root(file: &RustFile<'_>, depth: usize) -> Vec<(usize, String)> {
    let mut names = file.names_after("crate");
    names.extend(file.names_after(&vec!["super"; depth].join("::")));
    names.retain(|(_, name)| name != "self");
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(path: &str, text: &str) -> Vec<usize> {
        check(&Tree::of(&[(path, text)]))
            .iter()
            .map(|violation| violation.line)
            .collect()
    }

    #[test]
    fn a_module_that_comes_after_is_told() {
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
    fn what_comes_before_and_what_is_for_all_passes() {
        let text = "use crate::error::Error;\nuse crate::watch::Watch;\nuse crate::robot::{self, Robot};\n\
                    use super::joint::Joint;\nuse crate::compliance::gravity;\n";
        assert_eq!(lines("crates/core/src/compliance/cartesian.rs", text), []);
    }

    #[test]
    fn tests_may_use_everything() {
        let text = "// crate::map\n#[cfg(test)]\nmod tests {\n    use crate::measure::x;\n}\n";
        assert_eq!(lines("crates/core/src/frame.rs", text), []);
        assert_eq!(lines("crates/core/src/robot/tests.rs", "use crate::map::x;"), []);
    }

    #[test]
    fn a_module_without_a_place_is_told() {
        assert_eq!(lines("crates/core/src/new.rs", ""), [1]);
        assert_eq!(
            lines("crates/core/src/lib.rs", "pub mod new;\nuse crate::map::x;\n"),
            []
        );
    }
}
