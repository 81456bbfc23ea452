//! One measured rate, as the programs in `bench/` print it: fields separated by tabs.
//!
//! ```text
//! who    work    threads    median    lower quartile    upper quartile    note
//! ```
//!
//! Rates are million poses (or points) per second. Lines with another number of fields, or words where numbers
//! belong, are other output and not rows.

/// The rate of one program at one kind of work, million poses per second.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name with version.
    pub who: String,
    /// As named in `bench/src/work.rs`.
    pub work: String,
    /// How many threads it was given.
    pub threads: usize,
    /// Median of the rounds.
    pub median: f64,
    /// Lower and upper quartile of the rounds.
    pub quartiles: [f64; 2],
    /// What a reader must know to compare it; may be empty.
    pub note: String,
}

impl Row {
    /// The row in `line`, if there is one.
    pub fn read(line: &str) -> Option<Row> {
        let fields: Vec<&str> = line.split('\t').collect();
        let [who, work, threads, median, lower, upper, note] = fields.as_slice() else {
            return None;
        };
        Some(Row {
            who: (*who).to_owned(),
            work: (*work).to_owned(),
            threads: threads.parse().ok()?,
            median: median.parse().ok()?,
            quartiles: [lower.parse().ok()?, upper.parse().ok()?],
            note: (*note).to_owned(),
        })
    }
}

/// Three digits that mean something: whole from 100 on, three decimals at most.
pub fn digits(value: f64) -> String {
    let decimals = match value.abs() {
        size if size >= 100.0 => 0,
        size if size >= 10.0 => 1,
        size if size >= 1.0 => 2,
        size if size >= 0.01 => 3,
        _ => 5,
    };
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_read_and_other_lines_are_not() {
        let row = Row::read("numpy 2\tdev\t1\t2.5\t2.4\t2.6\t");
        assert!(row.is_some_and(|row| row.median == 2.5 && row.threads == 1 && row.note.is_empty()));
        assert_eq!(Row::read("numpy 2\tdev"), None);
        assert_eq!(Row::read("a\tdev\t1\tfast\t1\t1\t"), None);
    }

    #[test]
    fn digits_follow_the_size() {
        assert_eq!(
            [297.3, 28.71, 4.2, 0.0341, 0.001_43].map(digits),
            ["297", "28.7", "4.20", "0.034", "0.00143"]
        );
    }
}
