//! Which crate may depend on which: core <- {formats, report} <- study <- {cli, web, py}.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "crate direction",
    reason: "the mechanics must be readable and testable without files, pictures or servers",
    check,
};

/// Each folder of `crates/` with the folders it may depend on, tests and benchmarks included.
const MAY_USE: &[(&str, &[&str])] = &[
    ("core", &[]),
    ("formats", &["core"]),
    ("report", &["core"]),
    ("study", &["core", "formats", "report"]),
    ("web", &["core", "formats", "report", "study"]),
    // `armill serve` starts the server.
    ("cli", &["core", "formats", "report", "study", "web"]),
    // The wheel installs the command.
    ("py", &["core", "formats", "report", "study", "cli"]),
];

/// Reads the dependency tables of `crates/*/Cargo.toml`.
fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (path, text) in tree.texts_in("crates/", "/Cargo.toml") {
        let folder = path.split('/').nth(1).unwrap_or_default();
        let Some((_, may_use)) = MAY_USE.iter().find(|(name, _)| *name == folder) else {
            let hint = "give it a place in MAY_USE in xtask/src/tidy/crate_direction.rs";
            violations.push(Violation::new(
                path,
                1,
                format!("crate `{folder}` has no place in the order"),
                hint,
            ));
            continue;
        };
        for (line, used) in our_dependencies(text) {
            if !may_use.contains(&used) {
                let what = format!("`{folder}` depends on `{used}`");
                let hint = match may_use {
                    [] => "it may depend on no other crate of ours".to_owned(),
                    _ => format!("it may depend on {}", may_use.join(", ")),
                };
                violations.push(Violation::new(path, line, what, hint));
            }
        }
    }
    violations
}

/// The folders of our crates that a Cargo.toml depends on, with their lines.
fn our_dependencies(text: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    let mut in_dependencies = false;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        let name = if let Some(header) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            in_dependencies = header.ends_with("dependencies");
            // `[dependencies.armill-core]` is a dependency by itself.
            header.rsplit_once("dependencies.").map(|(_, name)| name)
        } else if in_dependencies {
            line.split(['=', '.', ' ']).next()
        } else {
            None
        };
        let folder = match name {
            Some("armill") => Some("cli"),
            Some(name) => name.strip_prefix("armill-"),
            None => None,
        };
        found.extend(folder.map(|folder| (index + 1, folder)));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dependency_upwards_is_told_with_its_line() {
        let text = "[package]\nname = \"armill-core\"\n[dev-dependencies]\narmill-formats.workspace = true\n";
        let violations = check(&Tree::of(&[("crates/core/Cargo.toml", text)]));
        assert_eq!(violations.len(), 1);
        assert_eq!(violations[0].line, 4);
    }

    #[test]
    fn every_way_to_write_a_dependency_is_seen() {
        let text = "[dependencies]\narmill-core = { path = \"\" }\n[target.x.dependencies.armill]\nversion = \"1\"\n";
        assert_eq!(our_dependencies(text), [(2, "core"), (3, "cli")]);
    }

    #[test]
    fn dependencies_downwards_pass() {
        let text = "[dependencies]\narmill-core.workspace = true\narmill-web = \"1\"\nserde = \"1\"\n";
        assert!(check(&Tree::of(&[("crates/cli/Cargo.toml", text)])).is_empty());
    }

    #[test]
    fn a_crate_without_a_place_is_told() {
        assert_eq!(check(&Tree::of(&[("crates/new/Cargo.toml", "")])).len(), 1);
    }
}
