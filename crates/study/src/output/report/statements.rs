//! Published statements, compared with these results: a table a statement.

use armill_report::html::Table;

use crate::analysis::cells::columns;
use crate::answer::{StatementAnswer, StudyAnswer};

/// A row a reading: its range of deviations against the stated bound.
pub(super) fn tables(answer: &StudyAnswer) -> Vec<Table> {
    let table = |statement: &StatementAnswer| Table {
        caption: format!(
            "{} ({}): at most {} µm.",
            statement.text, statement.source, statement.at_most_um
        ),
        columns: columns(&[
            ("reading", ""),
            ("branch", ""),
            ("in-plane deviation", "µm"),
            ("inside joint limits", ""),
            ("verdict", ""),
        ]),
        rows: statement
            .readings
            .iter()
            .map(|reading| {
                let range = reading
                    .in_plane_um
                    .map_or("–".to_owned(), |[a, b]| format!("{a:.1} … {b:.1}"));
                vec![
                    reading.name.clone(),
                    reading.branch.clone(),
                    range,
                    if reading.inside_joint_limits { "yes" } else { "no" }.to_owned(),
                    if reading.consistent {
                        "consistent"
                    } else {
                        "not consistent"
                    }
                    .to_owned(),
                ]
            })
            .collect(),
    };
    answer.statements.iter().map(table).collect()
}
