//! The results of a study: `result.json`, tables, pictures and a report in one folder.
//!
//! Every file is written under another name and renamed, and `result.json` is written last: an interrupted run leaves
//! no incomplete file, and a folder without `result.json` is not complete. `result.json` names the files that belong to
//! it, each with its SHA-256. Files of an earlier run of the same command are removed; files that were changed, and
//! files that armill did not make, are neither removed nor replaced (see [`armill_formats::file`]).
//!
//! ```text
//! result.json             the answer
//! report.html             question, answer, inputs with sources, tables, pictures, warnings
//! NAME.parquet, NAME.csv  a row a point; NAME.limits.csv: the process limits of a program
//! NAME.vtp, NAME.vti      for ParaView: planes and paths, boxes
//! NAME.svg, NAME-WHAT.svg pictures, each as .png too
//! .armill-files           which of these files armill made
//! ```
//!
//! `NAME` is the [`slug`] of the analysis's name. `options`: what is to be written; [`folder`]: writes many files at
//! once; `picture_files`: the files of a picture; `tables`, `pictures`, `arm`, `cell_view`, [`budget`], [`report`]: contents of files.

mod arm;
pub mod budget;
mod cell_view;
pub mod folder;
mod options;
mod picture_files;
mod pictures;
pub mod report;
mod tables;

pub use crate::analysis::picture::Picture;
pub use arm::{arm_drawing, posture_drawing};
pub use cell_view::bodies_drawing;
pub use options::{Csv, Opening, OutputOptions, Pictures, StudyResults};
#[cfg(feature = "png")]
pub use picture_files::png;
pub use picture_files::{picture_files, save_pictures, write_pictures};

use std::collections::BTreeMap;
use std::path::PathBuf;

use armill_formats::file::ResultFolder;
use armill_formats::table::{Column, ColumnData, Table, csv};
use rayon::prelude::*;
use serde::Serialize;

use crate::analysis::AnalysisResult;
use crate::answer::StudyAnswer;
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::file_names::slug;

/// Whether the tables, report and answer of this study may be written into `out`, before any work is done.
///
/// # Errors
/// Files there that may not be replaced.
pub fn allow(study: &Study, out: &ResultFolder, requested: OutputOptions<'_>) -> Result<(), StudyError> {
    let names = names(study, &[], requested);
    Ok(out.allow(names.iter().map(String::as_str))?)
}

/// Writes everything into `out` and returns the paths of the files; `note` receives each name when it is written, from
/// any thread.
///
/// # Errors
/// A file cannot be written.
pub fn write(
    results: StudyResults<'_>,
    out: &ResultFolder,
    requested: OutputOptions<'_>,
    note: &(dyn Fn(&str) + Sync),
) -> Result<Vec<PathBuf>, StudyError> {
    let StudyResults { study, done, answer } = results;
    let drawn = match requested.pictures {
        Pictures::Drawn => pictures(results),
        Pictures::None => Vec::new(),
    };
    let names = names(study, &drawn, requested);
    replace(out, &names, answer, note, |files| {
        let tables = || {
            let analyses = study.analyses.par_iter().zip(done).with_max_len(1);
            analyses.try_for_each(|(analysis, done)| {
                let slug = slug(&analysis.name);
                tables::files(study, analysis, done, requested.csv, &|extension, bytes| {
                    files.save(&format!("{slug}.{extension}"), bytes)
                })
            })
        };
        let pictures = || match requested.pictures {
            Pictures::Drawn => {
                save_pictures(&drawn, files)?;
                files.save(
                    REPORT,
                    report::html(study, answer, &drawn, requested.opening).as_bytes(),
                )
            }
            Pictures::None => Ok(()),
        };
        let (tables, pictures) = rayon::join(tables, pictures);
        tables.and(pictures)
    })
}

/// Replaces the files of an earlier run by those called `names`, `answer` last, and returns their paths. `work`
/// saves all but the answer.
///
/// # Errors
/// Files that may not be replaced, before anything is written; that of `work`; a file cannot be written.
pub fn replace<T: Serialize>(
    out: &ResultFolder,
    names: &[String],
    answer: &T,
    note: &(dyn Fn(&str) + Sync),
    work: impl FnOnce(&folder::Folder<'_>) -> Result<(), StudyError>,
) -> Result<Vec<PathBuf>, StudyError> {
    out.allow(names.iter().map(String::as_str))?;
    // An older answer next to newer tables would seem to belong to them if this run were interrupted.
    out.remove(RESULT);
    folder::write_together(out, note, work)?;
    let written = WrittenAnswer {
        answer,
        files: out.written(),
    };
    out.write(RESULT, (serde_json::to_string(&written)? + "\n").as_bytes())?;
    out.finish()?;
    note(RESULT);
    Ok(names.iter().map(|name| out.path().join(name)).collect())
}

/// `result.json`: the answer, and the files that were written with it.
#[derive(Serialize)]
struct WrittenAnswer<'a, T> {
    #[serde(flatten)]
    answer: &'a T,
    /// SHA-256 of each file by its name, hexadecimal.
    files: BTreeMap<String, String>,
}

/// The name of the answer, written last.
pub const RESULT: &str = "result.json";
/// The name of the report, if pictures are drawn.
pub const REPORT: &str = "report.html";

/// The names of all files, the answer last.
fn names(study: &Study, drawn: &[Picture], requested: OutputOptions) -> Vec<String> {
    let tables = study.analyses.iter().flat_map(|analysis| {
        let slug = slug(&analysis.name);
        let extensions = tables::extensions(analysis, requested.csv).into_iter();
        extensions.map(move |extension| format!("{slug}.{extension}"))
    });
    let pictures = drawn.iter().flat_map(picture_files);
    let report = (requested.pictures == Pictures::Drawn).then(|| REPORT.to_owned());
    tables
        .chain(pictures)
        .chain(report)
        .chain([RESULT.to_owned()])
        .collect()
}

/// The pictures of every analysis, in the order of the report.
pub fn pictures(results: StudyResults<'_>) -> Vec<Picture> {
    pictures::draw(results)
}

/// The points of one analysis with their columns.
///
/// # Errors
/// A table that cannot be made, which would be a fault of armill.
pub fn points_table(study: &Study, done: &AnalysisResult<'_>) -> Result<Table, StudyError> {
    tables::rows_of(study, done)
}

/// The table of one analysis as the CSV that is written for it.
///
/// # Errors
/// A table that cannot be made, which would be a fault of armill.
pub fn table_csv(study: &Study, done: &AnalysisResult<'_>) -> Result<Vec<u8>, StudyError> {
    Ok(csv::write(&points_table(study, done)?))
}

/// The answer as JSON, one line.
///
/// # Errors
/// Never in practice: the answer contains strings, finite numbers and lists of them.
pub fn json(answer: &StudyAnswer) -> Result<String, StudyError> {
    Ok(serde_json::to_string(answer)? + "\n")
}

/// A column whose every row has a number.
pub fn column(name: &str, unit: &str, description: &str, decimals: u8, values: Vec<f64>) -> Column {
    Column {
        name: name.to_owned(),
        unit: Some(unit.to_owned()),
        description: description.to_owned(),
        decimals: Some(decimals),
        data: ColumnData::Float(values),
    }
}
