//! Which crate may depend on which; the programs of the repository separately.
//!
//! ```text
//! core <- formats <- programs <- study <- {measure, plan} <- api <- {web <- cli <- py, browser}        core <- report <- study
//! validation, bench, fuzz, xtask: no crate uses them
//! ```
//!
//! Direct dependencies alone are read, in any table of a `Cargo.toml`, tests included: a test may not turn the
//! direction round either. That a direction is used is checked too, so that the list stays true.

use super::Rule;
use super::toml_tables::line_of;
use super::tree::Tree;
use super::violation::Violation;
use toml::de::DeTable;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "crate direction",
    reason: "the mechanics must be readable and testable without files, pictures or servers",
    check,
};

/// What tests alone depend on: they compare with it what the crate serves.
const TESTS_USE: &[(&str, &[&str])] = &[("web", &["measure", "plan"])];

/// Each folder of `crates/` with those of our crates that it depends on; its tests may depend on no other, but for
/// [`TESTS_USE`].
const USES: &[(&str, &[&str])] = &[
    ("core", &[]),
    ("formats", &["core"]),
    ("report", &["core"]),
    ("programs", &["core", "formats"]),
    ("study", &["core", "formats", "programs", "report"]),
    ("measure", &["core", "formats", "programs", "report", "study"]),
    ("plan", &["core", "formats", "programs", "report", "study"]),
    ("api", &["core", "formats", "measure", "plan", "study"]),
    ("web", &["api", "core", "formats", "study"]),
    ("browser", &["api", "core", "formats", "study"]),
    (
        "cli",
        &[
            "core", "formats", "measure", "plan", "programs", "report", "study", "web",
        ],
    ),
    ("py", &["cli", "core", "formats", "plan", "study"]),
];

/// Programs of the repository, on which nothing depends.
const PROGRAMS: &[&str] = &["validation", "bench", "fuzz", "xtask"];

/// Programs that are not members of the workspace: peers and counters are never built with armill.
const APART: &[&str] = &["bench", "fuzz"];

/// All that the core is built of.
const LIBRARIES_OF_CORE: &[&str] = &["nalgebra", "libm", "rayon", "thiserror"];

/// All that the tasks are built of: they are what a new checkout compiles first.
const LIBRARIES_OF_XTASK: &[&str] = &["proc-macro2", "syn", "toml"];

/// Reads the dependency tables of every Cargo.toml.
fn check(tree: &Tree) -> Vec<Violation> {
    let crates = tree.texts_in("crates/", "/Cargo.toml");
    let mut violations: Vec<Violation> = crates.flat_map(|(path, text)| check_crate(path, text)).collect();
    for (path, text) in tree.texts().filter(|(path, _)| path.ends_with("Cargo.toml")) {
        for found in dependencies(text) {
            let name = found.name.strip_prefix("armill-").unwrap_or(&found.name);
            if PROGRAMS.contains(&name) {
                violations.push(found.reported(path, "a program of the repository: nothing depends on it"));
            } else if path == "xtask/Cargo.toml" && !LIBRARIES_OF_XTASK.contains(&name) {
                let hint = format!("xtask is built first, of {}", LIBRARIES_OF_XTASK.join(", "));
                violations.push(found.reported(path, &hint));
            }
        }
    }
    violations.extend(APART.iter().filter_map(|program| check_apart(tree, program)));
    violations
}

/// Against its place in [`USES`]; the core also against the libraries that it is built of.
fn check_crate(path: &str, text: &str) -> Vec<Violation> {
    let folder = path.split('/').nth(1).unwrap_or_default();
    let Some((_, uses)) = USES.iter().find(|(name, _)| *name == folder) else {
        let hint = "give it a place in USES in xtask/src/tidy/crate_direction.rs";
        let what = format!("crate `{folder}` has no place in the order");
        return vec![Violation::new(path, 1, what, hint)];
    };
    let all = dependencies(text);
    let mut violations = Vec::new();
    for found in &all {
        let ours = found.ours();
        let of_tests = |ours| {
            TESTS_USE
                .iter()
                .any(|(name, uses)| *name == folder && uses.contains(&ours))
        };
        if found.of_tests && ours.is_some_and(of_tests) {
            continue;
        }
        if ours.is_some_and(|ours| !uses.contains(&ours)) {
            let hint = match uses {
                [] => "it may depend on no other crate of ours".to_owned(),
                _ => format!("it may depend on {}", uses.join(", ")),
            };
            violations.push(found.reported(path, &hint));
        } else if folder == "core" && !found.of_tests && !LIBRARIES_OF_CORE.contains(&found.name.as_str()) {
            let hint = format!("the core is built of {}", LIBRARIES_OF_CORE.join(", "));
            violations.push(found.reported(path, &hint));
        }
    }
    let missing = uses.iter().filter(|name| {
        let mut shipped = all.iter().filter(|found| !found.of_tests);
        !shipped.any(|found| found.ours() == Some(**name))
    });
    let hint = "correct the page and USES in xtask/src/tidy/crate_direction.rs";
    violations.extend(missing.map(|name| {
        let what = format!("`{folder}` does not depend on `{name}`, as ARCHITECTURE.md says");
        Violation::new(path, 1, what, hint)
    }));
    violations
}

/// A program that must be a workspace of its own, but is not.
fn check_apart(tree: &Tree, program: &str) -> Option<Violation> {
    let path = format!("{program}/Cargo.toml");
    let own = DeTable::parse_recoverable(tree.text(&path)?)
        .0
        .get_ref()
        .contains_key("workspace");
    let root = DeTable::parse_recoverable(tree.text("Cargo.toml").unwrap_or_default()).0;
    let members = root
        .get_ref()
        .get("workspace")
        .and_then(|root| root.get_ref().get("members")?.get_ref().as_array());
    let member = members.into_iter().flat_map(|members| members.iter());
    let member = member
        .filter_map(|member| member.get_ref().as_str())
        .any(|member| member == program);
    (!own || member).then(|| {
        let what = format!("`{program}` is built with armill");
        Violation::new(
            &path,
            1,
            what,
            "give it a [workspace] of its own, and no place among the members",
        )
    })
}

/// A dependency of a Cargo.toml.
#[derive(Debug, PartialEq)]
struct Dependency {
    line: usize,
    /// Of the package, where it is used under another name.
    name: String,
    /// Of tests, benchmarks or build scripts alone.
    of_tests: bool,
}

impl Dependency {
    /// The folder in `crates/` that it means, if it is one of ours.
    fn ours(&self) -> Option<&str> {
        match self.name.as_str() {
            "armill" => Some("cli"),
            name => name.strip_prefix("armill-"),
        }
    }

    /// The violation that this dependency is.
    fn reported(&self, path: &str, hint: &str) -> Violation {
        let folder = path.trim_end_matches("/Cargo.toml").trim_start_matches("crates/");
        let what = format!(
            "`{folder}` depends on `{}`",
            self.name.strip_prefix("armill-").unwrap_or(&self.name)
        );
        Violation::new(path, self.line, what, hint)
    }
}

/// All dependencies of a Cargo.toml, but for those that a workspace lists for its members.
fn dependencies(text: &str) -> Vec<Dependency> {
    let mut found = Vec::new();
    collect(text, DeTable::parse_recoverable(text).0.get_ref(), &mut found);
    found.sort_by_key(|dependency| dependency.line);
    found
}

/// Adds the dependencies of `table` and of the tables in it.
fn collect(text: &str, table: &DeTable<'_>, found: &mut Vec<Dependency>) {
    for (key, value) in table {
        let key = key.get_ref().as_ref();
        let Some(inside) = value.get_ref().as_table().filter(|_| key != "workspace") else {
            continue;
        };
        if !key.ends_with("dependencies") {
            collect(text, inside, found);
            continue;
        }
        found.extend(inside.iter().map(|(name, given)| {
            let package = given
                .get_ref()
                .get("package")
                .and_then(|package| package.get_ref().as_str());
            Dependency {
                line: line_of(text, name.span()),
                name: package.unwrap_or(name.get_ref()).to_owned(),
                of_tests: key != "dependencies",
            }
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reported(files: &[(&str, &str)]) -> Vec<String> {
        let violations = check(&Tree::of(files)).into_iter();
        violations
            .map(|violation| format!("{}:{} {}", violation.path, violation.line, violation.what))
            .collect()
    }

    #[test]
    fn a_dependency_upwards_is_reported_with_its_line() {
        let text = "[package]\nname = \"armill-core\"\n[dev-dependencies]\narmill-formats.workspace = true\n";
        assert_eq!(
            reported(&[("crates/core/Cargo.toml", text)]),
            ["crates/core/Cargo.toml:4 `core` depends on `formats`"]
        );
    }

    #[test]
    fn every_way_to_write_a_dependency_is_seen() {
        let text = "[dependencies]\narmill-core = { path = \"\" }\n# why\n[target.x.dependencies.armill]\nversion = \"1\"\n\
                    [dev-dependencies]\ncsv = \"1\"\n";
        let found = dependencies(text);
        let found: Vec<_> = found
            .iter()
            .map(|found| (found.line, found.name.as_str(), found.of_tests))
            .collect();
        assert_eq!(
            found,
            [(2, "armill-core", false), (4, "armill", false), (7, "csv", true)]
        );
    }

    #[test]
    fn dependencies_downwards_pass_and_one_that_is_missing_is_reported() {
        let three = "[dependencies]\narmill-core.workspace = true\narmill-formats = \"1\"\narmill-report = \"1\"\nserde = \"1\"\n";
        let ours = ["measure", "plan", "programs", "web"].map(|name| format!("armill-{name} = \"1\"\n"));
        let three = &format!("{three}{}", ours.concat());
        let all = format!("{three}armill-study = \"1\"\n");
        assert!(reported(&[("crates/cli/Cargo.toml", &all)]).is_empty());
        assert_eq!(
            reported(&[("crates/cli/Cargo.toml", three)]),
            ["crates/cli/Cargo.toml:1 `cli` does not depend on `study`, as ARCHITECTURE.md says"]
        );
    }

    #[test]
    fn a_crate_without_a_place_is_reported() {
        assert_eq!(reported(&[("crates/new/Cargo.toml", "")]).len(), 1);
    }

    #[test]
    fn forbidden_modules_are_reported_in_the_core_but_allowed_in_its_tests() {
        let text = "[dependencies]\nnalgebra = \"1\"\nserde = \"1\"\n[dev-dependencies]\nproptest = \"1\"\n";
        assert_eq!(
            reported(&[("crates/core/Cargo.toml", text)]),
            ["crates/core/Cargo.toml:3 `core` depends on `serde`"]
        );
    }

    #[test]
    fn programs_are_separate_from_the_crates() {
        let root = "[workspace]\nmembers = [\"crates/*\", \"fuzz\"]\n[workspace.dependencies]\narmill-fuzz = \"1\"\n";
        let found = reported(&[
            ("Cargo.toml", root),
            (
                "bench/Cargo.toml",
                "[package]\n[workspace]\n[dependencies]\narmill-validation = \"1\"\n",
            ),
            ("fuzz/Cargo.toml", "[workspace]\n"),
            ("xtask/Cargo.toml", "[dependencies]\nserde = \"1\"\n"),
        ]);
        assert_eq!(
            found,
            [
                "bench/Cargo.toml:4 `bench` depends on `validation`",
                "xtask/Cargo.toml:2 `xtask` depends on `serde`",
                "fuzz/Cargo.toml:1 `fuzz` is built with armill",
            ]
        );
    }
}
