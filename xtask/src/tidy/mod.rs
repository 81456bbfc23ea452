//! What must be true in this repository and what a machine can check: each rule with its reason, all reported at once.
//!
//! A rule looks at the text of the files that git knows or would take; it builds nothing. To add a rule: one
//! file here with its `RULE`, one line in [`RULES`].
//!
//! Whether code compiles, is formatted and passes clippy is not checked here. A violation is reported as
//! `path:line: what; hint`; the reason of a rule is printed once over its violations. Exit code 1 where there is
//! one.

// The repository as the rules see it.
mod boundary_fields;
mod circles;
mod paths;
mod rust;
mod toml_tables;
mod tree;
mod violation;

// The rules.
mod architecture_page;
mod core_absence;
mod crate_direction;
mod embedded;
mod exit_codes;
mod file_circles;
mod file_length;
mod links;
mod machine_paths;
mod module_circles;
mod module_folders;
mod module_order;
mod notation_page;
mod own_rules;
mod page_paths;
mod pictures;
mod plain_words;
mod robot_formats;
mod sources;
mod thin_command;
mod thin_python;
mod unit_factors;
mod units;
mod unsafe_code;
mod vague_names;
mod validation_cases;

use crate::command::expect_no_arguments;
use crate::{COULD_NOT_RUN, FOUND_WRONG};
use std::path::Path;
use std::process::ExitCode;
use tree::Tree;
use violation::Violation;

/// Description in the list of tasks.
pub const ABOUT: &str = "Checks the architecture: directions, sizes, names, units, sources, links.";

/// A requirement on the whole repository.
struct Rule {
    /// How people call it.
    name: &'static str,
    /// Printed with the violations: what goes wrong without the rule.
    reason: &'static str,
    /// Checks the whole tree and returns all violations.
    check: fn(&Tree) -> Vec<Violation>,
}

/// From the whole to the detail.
const RULES: &[Rule] = &[
    architecture_page::RULE,
    page_paths::RULE,
    crate_direction::RULE,
    module_order::RULE,
    module_circles::RULE,
    file_circles::RULE,
    module_folders::RULE,
    core_absence::RULE,
    unsafe_code::RULE,
    thin_command::RULE,
    thin_python::RULE,
    file_length::RULE,
    vague_names::RULE,
    plain_words::RULE,
    unit_factors::RULE,
    units::RULE,
    notation_page::RULE,
    exit_codes::RULE,
    sources::RULE,
    embedded::RULE,
    robot_formats::RULE,
    pictures::RULE,
    links::RULE,
    validation_cases::RULE,
    machine_paths::RULE,
    own_rules::RULE,
];

/// Checks every rule and reports every violation, with the reason of each broken rule.
pub fn run(arguments: &[String]) -> ExitCode {
    if let Err(code) = expect_no_arguments("tidy", arguments) {
        return code;
    }
    let tree = match Tree::read(Path::new(".")) {
        Ok(tree) => tree,
        Err(problem) => {
            eprintln!("cannot list the files of the repository: {problem}");
            return ExitCode::from(COULD_NOT_RUN);
        }
    };
    let mut total = 0;
    for rule in RULES {
        let violations = (rule.check)(&tree);
        if violations.is_empty() {
            continue;
        }
        println!("{}: {}", rule.name, rule.reason);
        for violation in &violations {
            println!("  {violation}");
        }
        println!();
        total += violations.len();
    }
    println!(
        "tidy: {} rules, {} files, {total} violations",
        RULES.len(),
        tree.paths().count()
    );
    if total == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(FOUND_WRONG)
    }
}
