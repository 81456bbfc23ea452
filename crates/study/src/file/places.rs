//! Where a value of an ask stands in the file: in the ask itself, or in the study it takes it from.
//!
//! The value `tolerance_um` of the second ask is `analysis[1].tolerance_um` where that ask writes it, else the study's `tolerance_um`;
//! where neither does, it is missing in the ask.

use armill_formats::document::{Document, Problem};

/// Collects problems of one ask (or of the study itself) at the place where each value stands.
pub(super) struct Places<'a> {
    document: &'a Document,
    analysis: Option<usize>,
    /// What was found so far.
    pub problems: Vec<Problem>,
}

impl<'a> Places<'a> {
    /// Problems of the ask with this index; of the study itself where there is none.
    pub(super) fn new(document: &'a Document, analysis: Option<usize>) -> Places<'a> {
        Places {
            document,
            analysis,
            problems: Vec::new(),
        }
    }

    /// A problem of the value `path`, such as `plane.step_mm`.
    pub(super) fn problem(&mut self, path: &str, message: impl Into<String>, hint: &str) {
        let place = self.place(path);
        self.problems
            .push(self.document.problem(&place, message, Some(hint)));
    }

    /// A problem at the ask itself.
    pub(super) fn problem_here(&mut self, message: impl Into<String>, hint: &str) {
        let place = self.analysis.map_or_else(String::new, |index| format!("analysis[{index}]"));
        self.problems
            .push(self.document.problem(&place, message, Some(hint)));
    }

    /// The path in the document of the value `path` of this ask.
    fn place(&self, path: &str) -> String {
        match self.analysis.map(|index| format!("analysis[{index}].{path}")) {
            Some(own) if self.document.contains(&own) || !self.document.contains(path) => own,
            _ => path.to_owned(),
        }
    }
}
