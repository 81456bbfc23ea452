//! The folder of the measurements, and the tables in it.

use std::path::{Path, PathBuf};

/// The folder that `ARMILL_SAMPLES` names.
#[derive(Clone, Debug)]
pub struct Samples(PathBuf);

impl Samples {
    /// The folder; none if the variable is not set.
    pub fn from_environment() -> Option<Samples> {
        std::env::var_os("ARMILL_SAMPLES").map(|folder| Samples(PathBuf::from(folder)))
    }

    /// A file or folder in the folder of data sets.
    pub fn path(&self, file: &str) -> PathBuf {
        self.0.join("datasets").join(file)
    }

    /// Rows of numbers of a table with a line of titles; with `;` between cells, decimal commas are read. Cells that are not
    /// numbers are NaN.
    ///
    /// # Panics
    /// Where the file is missing: a sample that is not there is a failed comparison.
    pub fn rows(&self, file: &str) -> Vec<Vec<f64>> {
        let text = text(&self.path(file));
        let separator = if text.contains(';') { ';' } else { ',' };
        let number = |cell: &str| cell.trim().replace(',', ".").parse().unwrap_or(f64::NAN);
        text.lines()
            .skip(1)
            .map(|line| line.split(separator).map(number).collect())
            .collect()
    }
}

fn text(path: &Path) -> String {
    match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) => panic!("{}: {error}", path.display()),
    }
}
