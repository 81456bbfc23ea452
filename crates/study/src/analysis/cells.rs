//! Format of words and numbers in the tables of a report.
//!
//! A column with a unit contains numbers and is right-aligned; the first column names the row. A dash means that
//! there is no number.

use armill_report::html::{Align, Column, Input, Table};

/// The unit of a column of dimensionless numbers.
pub const COUNT: &str = "count";

/// Columns by name and unit: those with a unit contain numbers, except for the first.
pub fn columns(names: &[(&str, &str)]) -> Vec<Column> {
    let column = |(i, (name, unit)): (usize, &(&str, &str))| Column {
        name: (*name).to_owned(),
        unit: if *unit == COUNT { "" } else { *unit }.to_owned(),
        align: if i == 0 || unit.is_empty() {
            Align::Left
        } else {
            Align::Number
        },
    };
    names.iter().enumerate().map(column).collect()
}

/// A number with one decimal; a dash if there is none.
pub fn um(value: Option<f64>) -> String {
    value.map_or_else(|| NONE.to_owned(), |value| format!("{value:.1}"))
}

/// The text of a missing number.
pub const NONE: &str = "–";

/// A fraction in percent.
pub fn percent(fraction: f64) -> String {
    format!("{:.1}", fraction * 100.0)
}

/// One input number.
pub fn input(name: &str, value: String, unit: &str, source: &str) -> Input {
    Input {
        name: name.to_owned(),
        value,
        unit: unit.to_owned(),
        source: source.to_owned(),
    }
}

/// The table without empty columns.
pub fn without_empty_columns(mut table: Table) -> Table {
    let empty = |k: usize| {
        let mut cells = table.rows.iter().filter_map(|row| row.get(k));
        !table.rows.is_empty() && cells.all(|cell| cell.is_empty() || cell == NONE)
    };
    let kept: Vec<bool> = (0..table.columns.len()).map(|k| !empty(k)).collect();
    let mut keep = kept.iter();
    table.columns.retain(|_| keep.next() == Some(&true));
    for row in &mut table.rows {
        let mut keep = kept.iter();
        row.retain(|_| keep.next() == Some(&true));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_without_a_cell_are_left_out() {
        let row = |cells: [&str; 3]| cells.map(str::to_owned).to_vec();
        let table = without_empty_columns(Table {
            caption: String::new(),
            columns: columns(&[("a", ""), ("b", "µm"), ("c", "µm")]),
            rows: vec![row(["1", NONE, ""]), row(["", "", "2"])],
        });
        let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["a", "c"]);
        assert_eq!(table.rows, [["1", ""], ["", "2"]]);
    }
}
