//! Where a value of an analysis is in the file: in the analysis itself, or in the study if it is inherited.
//!
//! The value `tolerance_um` of the second analysis is `analysis[1].tolerance_um` if that analysis has it, else the
//! `tolerance_um` of the study; if neither has it, it is missing in the analysis.

use armill_formats::document::{Document, Problem};

/// Collects problems of one analysis (or of the study itself), each at the key of its value.
pub struct ProblemLog<'a> {
    document: &'a Document,
    analysis: Option<usize>,
    /// The problems so far.
    pub problems: Vec<Problem>,
}

impl<'a> ProblemLog<'a> {
    /// Problems of the analysis with this index; of the study itself where there is none.
    pub fn new(document: &'a Document, analysis: Option<usize>) -> ProblemLog<'a> {
        ProblemLog {
            document,
            analysis,
            problems: Vec::new(),
        }
    }

    /// A problem of the value `path`, such as `plane.step_mm`.
    pub fn problem(&mut self, path: &str, message: impl Into<String>, hint: &str) {
        let place = self.place(path);
        self.problems
            .push(self.document.problem(&place, message, Some(hint)));
    }

    /// A problem at the analysis itself.
    pub fn problem_here(&mut self, message: impl Into<String>, hint: &str) {
        let place = self
            .analysis
            .map_or_else(String::new, |index| format!("analysis[{index}]"));
        self.problems
            .push(self.document.problem(&place, message, Some(hint)));
    }

    /// The path in the document of the value `path` of this analysis.
    fn place(&self, path: &str) -> String {
        match self.analysis.map(|index| format!("analysis[{index}].{path}")) {
            Some(own) if self.document.contains(&own) || !self.document.contains(path) => own,
            _ => path.to_owned(),
        }
    }
}
