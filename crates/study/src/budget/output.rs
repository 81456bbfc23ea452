//! Table and pictures of a budget.
//!
//! ```text
//! budget.csv      a row an angle: each contribution, their sum, the part and what is not explained
//! budget.svg      how large each contribution is, the sums and the part; budget.png is the same
//! radial.svg      part and prediction round the circle, magnified
//! waves.svg       amplitude and phase, wave by wave
//! ```

use std::path::{Path, PathBuf};

use armill_formats::file::write_atomically;
use armill_formats::table::{Column, ColumnData, Table, csv};

use super::answer::BudgetAnswer;
use super::combine::Combined;
use crate::StudyError;
use crate::output::{prepare, slug};

/// Writes table and pictures into the folder `out` and gives their paths.
///
/// # Errors
/// The folder or a file cannot be written.
pub fn write(told: &BudgetAnswer, combined: &Combined, out: &Path) -> Result<Vec<PathBuf>, StudyError> {
    prepare(out)?;
    let table = out.join("budget.csv");
    write_atomically(&table, &csv::write(&table_of(told, combined)?))?;
    Ok(vec![table])
}

/// A row an angle.
fn table_of(told: &BudgetAnswer, combined: &Combined) -> Result<Table, StudyError> {
    let column = |name: String, unit: &str, (decimals, data): (u8, Vec<f64>)| Column {
        name,
        unit: Some(unit.to_owned()),
        description: String::new(),
        decimals: Some(decimals),
        data: ColumnData::Float(data),
    };
    let um = |curve: &[f64]| (4, curve.iter().map(|value| value * 1e6).collect());
    let angle = combined
        .turn
        .angle()
        .iter()
        .map(|angle| angle.to_degrees())
        .collect();
    let mut columns = vec![column("angle_deg".to_owned(), "deg", (4, angle))];
    let balance = &combined.balance;
    for (one, said) in balance.contributions.iter().zip(&told.contributions) {
        let name = slug(&said.name).replace('-', "_");
        columns.push(column(format!("{name}_um"), "um", um(&one.bias)));
    }
    columns.push(column("sum_um".to_owned(), "um", um(&balance.sums.bias)));
    columns.push(column("scatter_um".to_owned(), "um", um(&balance.sums.scatter)));
    if let Some(part) = &balance.comparison {
        columns.push(column("part_um".to_owned(), "um", um(&part.measured)));
        columns.push(column(
            "residual_um".to_owned(),
            "um",
            um(&part.together.residual),
        ));
    }
    Ok(Table::new("budget", columns)?)
}
