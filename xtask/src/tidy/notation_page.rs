//! docs/notation.md defines every word once, and every unit that a name may end in.
//!
//! Words are those in bold in the first column of the table under `| word |`, suffixes those in backticks under
//! `| suffix |`. The units are those of the rule of units.

use super::Rule;
use super::tree::Tree;
use super::units::{UNITS, UNITS_AFTER_PER};
use super::violation::Violation;
use std::collections::BTreeSet;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "notation page",
    reason: "one word for one idea: a word with two meanings is ambiguous",
    check,
};

const PAGE: &str = "docs/notation.md";

/// Looks at the table of words and at the table of suffixes.
fn check(tree: &Tree) -> Vec<Violation> {
    let Some(page) = tree.text(PAGE) else {
        return Vec::new();
    };
    let mut given = BTreeSet::new();
    let mut violations = Vec::new();
    for (line, cell) in first_cells(page, "| word |") {
        for word in cell.split("**").skip(1).step_by(2) {
            if !given.insert(word) {
                let what = format!("`{word}` is defined twice");
                violations.push(Violation::new(
                    PAGE,
                    line,
                    what,
                    "merge the rows, or find another word",
                ));
            }
        }
    }
    let suffixes: BTreeSet<&str> = first_cells(page, "| suffix |")
        .flat_map(|(_, cell)| cell.split('`').skip(1).step_by(2))
        .flat_map(|suffix| suffix.split('_'))
        .collect();
    let units = UNITS.iter().chain(UNITS_AFTER_PER);
    let missing = units.filter(|unit| !suffixes.contains(**unit));
    violations.extend(missing.map(|unit| {
        let what = format!("the suffix `_{unit}` is in no row");
        Violation::new(
            PAGE,
            1,
            what,
            "add its unit, or remove it from xtask/src/tidy/units.rs",
        )
    }));
    violations
}

/// The first cell of each row of the table that begins with `head`, with its line.
fn first_cells<'a>(page: &'a str, head: &'a str) -> impl Iterator<Item = (usize, &'a str)> {
    let lines = page.lines().enumerate();
    let table = lines.skip_while(move |(_, line)| !line.starts_with(head)).skip(2);
    let table = table.take_while(|(_, line)| line.starts_with('|'));
    table.filter_map(|(index, line)| Some((index + 1, line.split('|').nth(1)?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_defined_twice_and_a_suffix_in_no_row_are_reported() {
        let suffixes: Vec<String> = UNITS
            .iter()
            .chain(UNITS_AFTER_PER)
            .map(|unit| format!("`_{unit}`"))
            .collect();
        let page = |suffixes: &[String]| {
            format!(
                "| word | meaning |\n|---|---|\n| **arm**, **robot** | a |\n| **robot** | b |\n\n| suffix | unit |\n|---|---|\n| {} | u |\n",
                suffixes.join(", ")
            )
        };
        let given = |page: &str| -> Vec<String> {
            check(&Tree::of(&[(PAGE, page)]))
                .into_iter()
                .map(|violation| violation.what)
                .collect()
        };
        assert_eq!(given(&page(&suffixes)), ["`robot` is defined twice"]);
        let first = format!("the suffix `_{}` is in no row", UNITS[0]);
        assert_eq!(
            given(&page(&suffixes[1..])),
            ["`robot` is defined twice".to_owned(), first]
        );
    }
}
