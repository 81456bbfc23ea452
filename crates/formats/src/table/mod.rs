//! Which numbers belong to which point? Columns of results, and the files they go to.
//!
//! - [`Table`]: columns of equal length, each with its unit in its name.
//! - [`csv`]: for spreadsheets and for reading by eye.
//! - `parquet` (feature `parquet`): for analysis; keeps types, units and meanings.
//! - [`vtk`]: for ParaView, fields in space rather than rows.
//!
//! `sheet`: cells of a text table with their places, as readers need them.

pub mod csv;
#[cfg(feature = "parquet")]
pub mod parquet;
pub(crate) mod sheet;
pub mod vtk;

/// Columns of equal length under a name.
///
/// Checked when it is made: at least one column, names that are not empty and differ, equal lengths, finite numbers,
/// category codes that have a label. Not checked: whether a unit fits its name.
///
/// ```
/// use armill_formats::table::{Column, ColumnData, Table};
///
/// let deviation = Column {
///     name: "in_plane_um".to_owned(),
///     unit: Some("um".to_owned()),
///     description: "deviation within the plane".to_owned(),
///     decimals: Some(3),
///     data: ColumnData::OptionalFloat(vec![Some(12.5), None]),
/// };
/// let table = Table::new("map", vec![deviation])?;
/// assert_eq!(armill_formats::table::csv::write(&table), b"in_plane_um\r\n12.5\r\n\"\"\r\n");
/// # Ok::<(), armill_formats::table::TableError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// For people, and for the metadata of a file.
    name: String,
    /// At least one; all of `row_count` values.
    columns: Vec<Column>,
    /// Zero for a table without rows.
    row_count: usize,
}

/// One column: what it is called, what it measures, and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// The header, with the unit at its end: `in_plane_um`.
    pub name: String,
    /// The unit as people write it, `um`; none for counts, names and flags.
    pub unit: Option<String>,
    /// What the values mean, in one sentence.
    pub description: String,
    /// How many decimals of its numbers mean something; files keep these and may drop the rest. None: all of them.
    pub decimals: Option<u8>,
    /// One value for each row.
    pub data: ColumnData,
}

/// The values of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum ColumnData {
    /// Numbers, all there.
    Float(Vec<f64>),
    /// Numbers, some of them missing.
    OptionalFloat(Vec<Option<f64>>),
    /// Whole numbers.
    Integer(Vec<i64>),
    /// Whole numbers, some of them missing.
    OptionalInteger(Vec<Option<i64>>),
    /// Yes or no.
    Flag(Vec<bool>),
    /// Any text.
    Text(Vec<String>),
    /// One of few names for each row, such as the reason why a point is not reached.
    Category {
        /// For each row the index of its label.
        codes: Vec<u32>,
        /// The names, in the order of their meaning.
        labels: Vec<String>,
    },
}

/// Why columns do not make a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableError {
    /// There is no column.
    #[error("table `{table}` has no columns: at least 1 is needed")]
    NoColumns {
        /// The name of the table.
        table: String,
    },
    /// A column has an empty name.
    #[error("column {index} of table `{table}` has no name")]
    NoName {
        /// The name of the table.
        table: String,
        /// The place of the column, from 0.
        index: usize,
    },
    /// Two columns have the same name.
    #[error("table `{table}` has two columns called `{column}`")]
    SameName {
        /// The name of the table.
        table: String,
        /// The name of both columns.
        column: String,
    },
    /// A column is longer or shorter than the first.
    #[error("column `{column}` of table `{table}` has {found} rows: the first column has {expected}")]
    RowCount {
        /// The name of the table.
        table: String,
        /// The column that differs.
        column: String,
        /// Its rows.
        found: usize,
        /// The rows of the first column.
        expected: usize,
    },
    /// A number is nan or infinite; a value that is missing is `None`.
    #[error("column `{column}` of table `{table}` is {value} in row {row}: must be finite")]
    NotFinite {
        /// The name of the table.
        table: String,
        /// The column.
        column: String,
        /// The row, from 0.
        row: usize,
        /// The number.
        value: f64,
    },
    /// A category has no label.
    #[error(
        "column `{column}` of table `{table}` has category {code} in row {row}: there are {label_count} labels"
    )]
    NoLabel {
        /// The name of the table.
        table: String,
        /// The column.
        column: String,
        /// The row, from 0.
        row: usize,
        /// The category.
        code: u32,
        /// How many labels there are.
        label_count: usize,
    },
}

impl Table {
    /// A table of these columns.
    ///
    /// # Errors
    /// No columns, names that are empty or repeat, unequal lengths, numbers that are not finite, codes without a label.
    pub fn new(name: impl Into<String>, columns: Vec<Column>) -> Result<Self, TableError> {
        let table = name.into();
        let Some(first) = columns.first() else {
            return Err(TableError::NoColumns { table });
        };
        let row_count = first.data.row_count();
        for (index, column) in columns.iter().enumerate() {
            if column.name.is_empty() {
                return Err(TableError::NoName { table, index });
            }
            if columns[..index].iter().any(|other| other.name == column.name) {
                return Err(TableError::SameName {
                    table,
                    column: column.name.clone(),
                });
            }
            let found = column.data.row_count();
            if found != row_count {
                return Err(TableError::RowCount {
                    table,
                    column: column.name.clone(),
                    found,
                    expected: row_count,
                });
            }
            column.check_values(&table)?;
        }
        Ok(Self {
            name: table,
            columns,
            row_count,
        })
    }

    /// What the table is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The columns, in the order they are written.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The columns, without the table.
    pub fn into_columns(self) -> Vec<Column> {
        self.columns
    }

    /// How many values each column has.
    pub fn row_count(&self) -> usize {
        self.row_count
    }
}

impl Column {
    /// Whether every value may be in the table of this name.
    ///
    /// # Errors
    /// The first number that is not finite, or the first category without a label.
    fn check_values(&self, table: &str) -> Result<(), TableError> {
        let not_finite = |row: usize, value: f64| TableError::NotFinite {
            table: table.to_owned(),
            column: self.name.clone(),
            row,
            value,
        };
        let strange = |value: &f64| !value.is_finite();
        match &self.data {
            ColumnData::Float(values) => match values.iter().position(strange) {
                Some(row) => Err(not_finite(row, values[row])),
                None => Ok(()),
            },
            ColumnData::OptionalFloat(values) => {
                let found = values
                    .iter()
                    .enumerate()
                    .find_map(|(row, value)| value.filter(strange).map(|v| (row, v)));
                found.map_or(Ok(()), |(row, value)| Err(not_finite(row, value)))
            }
            ColumnData::Category { codes, labels } => {
                match codes.iter().position(|code| *code as usize >= labels.len()) {
                    Some(row) => Err(TableError::NoLabel {
                        table: table.to_owned(),
                        column: self.name.clone(),
                        row,
                        code: codes[row],
                        label_count: labels.len(),
                    }),
                    None => Ok(()),
                }
            }
            ColumnData::Integer(_)
            | ColumnData::OptionalInteger(_)
            | ColumnData::Flag(_)
            | ColumnData::Text(_) => Ok(()),
        }
    }
}

impl ColumnData {
    /// Numbers of which so many decimals mean something, some of them missing: whole numbers if no decimals do.
    pub fn of_decimals(values: Vec<Option<f64>>, decimals: u8) -> Self {
        if decimals > 0 {
            return Self::OptionalFloat(values);
        }
        let whole = |value: Option<f64>| value.map(|value| value.round() as i64);
        Self::OptionalInteger(values.into_iter().map(whole).collect())
    }

    /// How many values there are.
    pub fn row_count(&self) -> usize {
        match self {
            Self::Float(values) => values.len(),
            Self::OptionalFloat(values) => values.len(),
            Self::Integer(values) => values.len(),
            Self::OptionalInteger(values) => values.len(),
            Self::Flag(values) => values.len(),
            Self::Text(values) => values.len(),
            Self::Category { codes, .. } => codes.len(),
        }
    }
}

/// A table with a column of every kind and values that are easily lost on the way, for the tests of the formats.
#[cfg(test)]
fn sample() -> Table {
    let column = |name: &str, unit: Option<&str>, data: ColumnData| Column {
        name: name.to_owned(),
        unit: unit.map(str::to_owned),
        description: format!("what {name} means, \"quoted\""),
        decimals: None,
        data,
    };
    let text = ["", "comma, \"quote\"", "line\r\nbreak", " \u{e4}\u{1f600} "]
        .map(str::to_owned)
        .to_vec();
    let labels = ["unused", "reached", "beyond joint 3"]
        .map(str::to_owned)
        .to_vec();
    let columns = vec![
        column(
            "x_mm",
            Some("mm"),
            ColumnData::Float(vec![0.1, -0.0, 1e300, f64::MIN_POSITIVE / 3.0]),
        ),
        column(
            "in_plane_um",
            Some("um"),
            ColumnData::OptionalFloat(vec![Some(1.0 / 3.0), None, Some(-7.5e-9), None]),
        ),
        column(
            "count",
            None,
            ColumnData::Integer(vec![i64::MIN, 0, -1, i64::MAX]),
        ),
        column(
            "within_limit",
            None,
            ColumnData::Flag(vec![true, false, false, true]),
        ),
        column("note", None, ColumnData::Text(text)),
        column(
            "reach",
            None,
            ColumnData::Category {
                codes: vec![2, 1, 1, 2],
                labels,
            },
        ),
        column(
            "worst_case",
            None,
            ColumnData::OptionalInteger(vec![Some(i64::MAX), None, Some(1), None]),
        ),
    ];
    Table::new("map", columns).unwrap()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(name: &str, data: ColumnData) -> Column {
        Column {
            name: name.to_owned(),
            unit: None,
            description: String::new(),
            decimals: None,
            data,
        }
    }

    fn refused(columns: Vec<Column>) -> String {
        Table::new("map", columns).unwrap_err().to_string()
    }

    #[test]
    fn a_table_has_as_many_rows_as_its_columns() {
        let table = sample();
        assert_eq!(
            (table.name(), table.row_count(), table.columns().len()),
            ("map", 4, 7)
        );
    }

    #[test]
    fn numbers_without_decimals_are_whole_numbers() {
        let values = vec![Some(2.0), None, Some(-1.0)];
        assert_eq!(
            ColumnData::of_decimals(values.clone(), 0),
            ColumnData::OptionalInteger(vec![Some(2), None, Some(-1)])
        );
        assert_eq!(
            ColumnData::of_decimals(values.clone(), 1),
            ColumnData::OptionalFloat(values)
        );
    }

    #[test]
    fn a_table_without_columns_is_refused() {
        assert_eq!(
            refused(vec![]),
            "table `map` has no columns: at least 1 is needed"
        );
    }

    #[test]
    fn columns_need_names_that_differ() {
        let flag = || ColumnData::Flag(vec![true]);
        assert_eq!(
            refused(vec![column("a", flag()), column("", flag())]),
            "column 1 of table `map` has no name"
        );
        assert_eq!(
            refused(vec![column("a", flag()), column("a", flag())]),
            "table `map` has two columns called `a`"
        );
    }

    #[test]
    fn a_column_of_another_length_is_refused() {
        let columns = vec![
            column("a", ColumnData::Flag(vec![true])),
            column("b", ColumnData::Integer(vec![])),
        ];
        assert_eq!(
            refused(columns),
            "column `b` of table `map` has 0 rows: the first column has 1"
        );
    }

    #[test]
    fn a_number_that_is_not_finite_is_refused() {
        let float = column("a_mm", ColumnData::Float(vec![0.0, f64::NAN]));
        assert_eq!(
            refused(vec![float]),
            "column `a_mm` of table `map` is NaN in row 1: must be finite"
        );
        let optional = column(
            "a_mm",
            ColumnData::OptionalFloat(vec![None, None, Some(f64::NEG_INFINITY)]),
        );
        assert_eq!(
            refused(vec![optional]),
            "column `a_mm` of table `map` is -inf in row 2: must be finite"
        );
    }

    #[test]
    fn a_category_without_label_is_refused() {
        let data = ColumnData::Category {
            codes: vec![0, 1],
            labels: vec!["only".to_owned()],
        };
        assert_eq!(
            refused(vec![column("a", data)]),
            "column `a` of table `map` has category 1 in row 1: there are 1 labels"
        );
    }
}
