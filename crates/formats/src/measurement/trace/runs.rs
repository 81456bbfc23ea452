//! The points of a file of traces, run by run.

use armill_core::nalgebra::Vector3;

use crate::table::sheet::RowLimit;

/// Maximum length that a tracker measures, m.
pub(super) const FARTHEST: f64 = 1e4;
pub(super) const LIMIT: RowLimit = RowLimit {
    most: 5_000_000,
    rows: "points",
    hint: "keep every tenth point, for example",
};

/// Points of one run, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// Its name; empty if the file has no names.
    pub run: String,
    /// m
    pub points: Vec<Vector3<f64>>,
    /// Line of each point, from 1.
    pub lines: Vec<usize>,
}

/// Content of a file of traces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Traces {
    /// In the order in which they begin in the file; each has at least one point.
    pub runs: Vec<Trace>,
    /// Ignored columns.
    pub unused: Vec<String>,
}

impl Traces {
    /// Adds a point of a run.
    pub(super) fn take(&mut self, run: String, point: Vector3<f64>, line: usize) {
        // Points of one run usually follow each other.
        let place = self.runs.iter().rposition(|trace| trace.run == run);
        let place = place.unwrap_or_else(|| {
            self.runs.push(Trace {
                run,
                ..Trace::default()
            });
            self.runs.len() - 1
        });
        self.runs[place].points.push(point);
        self.runs[place].lines.push(line);
    }
}
