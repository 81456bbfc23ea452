//! What is to be written: the results of a study, and which files are made of them.

use crate::analysis::AnalysisResult;
use crate::analysis::picture::Picture;
use crate::answer::StudyAnswer;
use crate::file::resolve::Study;

/// A study with its results.
#[derive(Clone, Copy, Debug)]
pub struct StudyResults<'a> {
    /// The study.
    pub study: &'a Study,
    /// The result of each analysis, in the order of the study.
    pub done: &'a [AnalysisResult<'a>],
    /// The answer from these.
    pub answer: &'a StudyAnswer,
}

/// What to write in addition to `result.json`, Parquet and VTK.
#[derive(Clone, Copy, Debug)]
pub struct OutputOptions<'a> {
    /// Whether there are pictures and a report.
    pub pictures: Pictures,
    /// Which analyses get a CSV.
    pub csv: Csv,
    /// First chapter of the report, if the study was changed before it was run.
    pub opening: Option<&'a Opening>,
}

/// The first chapter of a report: the search that preceded the run, and its result.
#[derive(Clone, Debug)]
pub struct Opening {
    /// Its heading.
    pub heading: &'static str,
    /// The result, a sentence each.
    pub sentences: Vec<String>,
    /// Pictures of the search.
    pub pictures: Vec<Picture>,
}

impl OutputOptions<'static> {
    /// The default of a run.
    pub const USUAL: OutputOptions<'static> = OutputOptions {
        pictures: Pictures::Drawn,
        csv: Csv::MapsAndPaths,
        opening: None,
    };
    /// No pictures, no report.
    pub const TABLES: OutputOptions<'static> = OutputOptions {
        pictures: Pictures::None,
        ..OutputOptions::USUAL
    };
}

/// Which analyses get a CSV; Parquet has the same columns and a third of the size or less.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Csv {
    /// Maps and paths, which are often opened in a spreadsheet.
    MapsAndPaths,
    /// Series and volumes too.
    Every,
}

/// Whether pictures are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pictures {
    /// Pictures and the report.
    Drawn,
    /// Tables only.
    None,
}
