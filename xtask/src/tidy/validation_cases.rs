//! Every validation case explains itself, and is in the overview and in the table of achieved errors.
//!
//! | must be there | for each folder in `validation/` |
//! |---|---|
//! | `README.md` in it | what is compared, the witness, the tolerance and why |
//! | a link in `validation/README.md` | which kind of witness it is |
//! | a row of `validation/TABLE.md` | that it runs |
//!
//! and no row without its folder.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;
use std::collections::BTreeSet;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "validation cases",
    reason: "a case without a page is not explained, and one outside the table is not run",
    check,
};

const FOLDER: &str = "validation/";
const TABLE: &str = "validation/TABLE.md";
const OVERVIEW: &str = "validation/README.md";

/// Folders of `validation/` that are code, or sets of the page *Measured*, not cases.
const NOT_CASES: &[&str] = &["src", "tests", "benches", "measured"];

/// Compares the folders of `validation/` with the first column of its table, both ways.
fn check(tree: &Tree) -> Vec<Violation> {
    let mut cases = tree.folders_in(FOLDER);
    cases.retain(|case| !NOT_CASES.contains(case));
    let mut violations = Vec::new();
    let overview = tree.text(OVERVIEW).unwrap_or_default();
    for case in &cases {
        let page = format!("{FOLDER}{case}/README.md");
        if !overview.contains(&format!("]({case}/README.md)")) {
            let what = format!("case `{case}` is not linked");
            violations.push(Violation::new(
                OVERVIEW,
                1,
                what,
                "say which kind of witness it is",
            ));
        }
        if !tree.has(&page) {
            violations.push(Violation::new(
                &page,
                1,
                "the page is missing",
                "say what, from where, tolerance and why",
            ));
        }
    }
    let rows = tree.text(TABLE).map(rows).unwrap_or_default();
    let listed: BTreeSet<&str> = rows.iter().map(|(_, case)| *case).collect();
    for case in cases.difference(&listed) {
        let what = format!("case `{case}` is not in the table");
        violations.push(Violation::new(
            TABLE,
            1,
            what,
            "write it again: cargo xtask validate",
        ));
    }
    for (line, case) in rows.iter().filter(|(_, case)| !cases.contains(case)) {
        let what = format!("case `{case}` has no folder");
        violations.push(Violation::new(
            TABLE,
            *line,
            what,
            "write it again: cargo xtask validate",
        ));
    }
    violations
}

/// The first cell of each row of a Markdown table, with its line; a row that continues a case has none.
fn rows(table: &str) -> Vec<(usize, &str)> {
    let lines: Vec<&str> = table.lines().collect();
    let is_rule = |line: &str| line.starts_with('|') && line.chars().all(|c| "|-: ".contains(c));
    let mut rows = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let is_header = lines.get(index + 1).is_some_and(|next| is_rule(next));
        if !line.starts_with('|') || is_rule(line) || is_header {
            continue;
        }
        let cell = line.split('|').nth(1).unwrap_or_default().trim();
        // A link shows its text; backticks are not part of the name.
        let cell = cell
            .strip_prefix('[')
            .and_then(|cell| cell.split(']').next())
            .unwrap_or(cell);
        let case = cell.trim_matches('`');
        if !case.is_empty() {
            rows.push((index + 1, case));
        }
    }
    rows
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
    fn a_case_without_page_or_row_and_a_row_without_case_are_reported() {
        let table = "| case | error |\n|---|---:|\n| `gone` | 1 |\n";
        let violations = reported(&[
            ("validation/new/data.csv", ""),
            (TABLE, table),
            ("validation/src/main.rs", ""),
        ]);
        assert_eq!(
            violations,
            [
                "validation/README.md:1 case `new` is not linked",
                "validation/new/README.md:1 the page is missing",
                "validation/TABLE.md:1 case `new` is not in the table",
                "validation/TABLE.md:3 case `gone` has no folder",
            ]
        );
    }

    #[test]
    fn cases_with_page_and_row_pass() {
        let table = "| case | error |\n|---|---|\n| [circle](circle/README.md) | 1 |\n| | 2 |\n";
        let page = (OVERVIEW, "| drawn | [circle](circle/README.md) |");
        assert!(reported(&[("validation/circle/README.md", ""), (TABLE, table), page]).is_empty());
    }

    #[test]
    fn no_cases_need_no_table() {
        assert!(reported(&[("validation/src/main.rs", "")]).is_empty());
    }
}
