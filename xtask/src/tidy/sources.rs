//! Every number of a robot or a material names its source.
//!
//! ```text
//! [joints]                 a number here is covered by `source` here, or in a table around it,
//! source = "paper"         or by `joints_source` in the table just outside
//! [sources.paper]          needs no source; must be used
//! ```
//!
//! All slips of a file are reported in the order of its lines.

use super::Rule;
use super::toml_tables::{Table, tables};
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "sources of numbers",
    reason: "a stiffness without a traceable source is a guess, and so is a prediction from it",
    check,
};

/// The folders with the numbers.
const LIBRARIES: &[&str] = &["robots/", "materials/"];

/// `[sources.NAME]` says what and where a source is; `source = "NAME"` or `mass_source = "NAME"` refers to it.
fn check(tree: &Tree) -> Vec<Violation> {
    let files = LIBRARIES.iter().flat_map(|folder| tree.texts_in(folder, ".toml"));
    files
        .flat_map(|(path, text)| check_file(path, &tables(text)))
        .collect()
}

/// Sources that are not defined, numbers without one, sources that are not used.
fn check_file(path: &str, tables: &[Table]) -> Vec<Violation> {
    let mut violations = Vec::new();
    let defined: Vec<(&str, usize)> = tables
        .iter()
        .filter_map(|table| Some((table.name.strip_prefix("sources.")?, table.line)))
        .collect();
    let used: Vec<&str> = tables
        .iter()
        .flat_map(|table| &table.sources)
        .map(|source| source.name.as_str())
        .collect();

    for (index, table) in tables.iter().enumerate() {
        for source in &table.sources {
            if !defined.iter().any(|(name, _)| *name == source.name) {
                let what = format!("{} \"{}\" is not in [sources]", source.key, source.name);
                let hint = format!("add [sources.{}] with what, where and licence", source.name);
                violations.push(Violation::new(path, source.line, what, hint));
            }
        }
        if let Some(line) = table
            .first_number
            .filter(|_| !is_about_a_source(table) && !has_source(tables, index))
        {
            let name = if table.name.is_empty() {
                "the first table"
            } else {
                &table.name
            };
            let hint = "add source = \"NAME\" to it, or to the table around it";
            violations.push(Violation::new(
                path,
                line,
                format!("{name} has numbers without a source"),
                hint,
            ));
        }
    }
    for (name, line) in defined.iter().filter(|(name, _)| !used.contains(name)) {
        let what = format!("source \"{name}\" is not used");
        violations.push(Violation::new(
            path,
            *line,
            what,
            "name it where its numbers are, or remove it",
        ));
    }
    violations.sort_by_key(|violation| violation.line);
    violations
}

/// A year or a page number in `[sources.NAME]` needs no source itself.
fn is_about_a_source(table: &Table) -> bool {
    table.name == "sources" || table.name.starts_with("sources.")
}

/// Whether a source is named in the table at `index`, in a table around it, or for it by name just outside.
fn has_source(tables: &[Table], index: usize) -> bool {
    if !tables[index].sources.is_empty() {
        return true;
    }
    let mut name = tables[index].name.as_str();
    while !name.is_empty() {
        let (outside, own) = name.rsplit_once('.').unwrap_or(("", name));
        // Of tables that repeat, the last one before this is the one around it.
        let around = tables[..index].iter().rev().find(|table| table.name == outside);
        let by_name = format!("{own}_source");
        let covers = |key: &str| key == by_name || !outside.is_empty();
        if around.is_some_and(|table| table.sources.iter().any(|source| covers(&source.key))) {
            return true;
        }
        name = outside;
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reported(text: &str) -> Vec<String> {
        let violations = check(&Tree::of(&[("robots/maker/model.toml", text)]));
        violations
            .into_iter()
            .map(|violation| format!("{} {}", violation.line, violation.what))
            .collect()
    }

    const PAPER: &str = "[sources.paper]\nwhat = \"Made up\"\nyear = 2020\n";

    #[test]
    fn numbers_without_a_source_are_reported() {
        let text = format!("{PAPER}[joints]\nsource = \"paper\"\nk = 1\n[mass]\nm_kg = 2.0\n");
        assert_eq!(reported(&text), ["8 mass has numbers without a source"]);
    }

    #[test]
    fn a_source_that_is_not_defined_or_not_used_is_reported() {
        let text = format!("{PAPER}[joints]\nstiffness_source = \"book\"\n");
        assert_eq!(
            reported(&text),
            [
                "1 source \"paper\" is not used",
                "5 stiffness_source \"book\" is not in [sources]"
            ]
        );
    }

    #[test]
    fn the_table_around_may_name_the_source() {
        let inside = format!("{PAPER}[a]\nsource = \"paper\"\n[a.b]\nk = 1\n[[a.c]]\nk = 1\n");
        assert_eq!(reported(&inside), Vec::<String>::new());
        let by_name = format!("joints_source = \"paper\"\n{PAPER}[[joints]]\nk = 1\n[[joints]]\nk = 2\n");
        assert_eq!(reported(&by_name), Vec::<String>::new());
    }

    #[test]
    fn a_source_of_another_table_does_not_help() {
        let text = format!("mass_source = \"paper\"\n{PAPER}[[joints]]\nk = 1\n");
        assert_eq!(reported(&text), ["6 joints has numbers without a source"]);
    }
}
