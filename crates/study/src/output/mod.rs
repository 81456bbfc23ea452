//! What a study leaves behind: `result.json`, tables, pictures and a report in one folder.
//!
//! Every file is written beside its place and renamed, and `result.json` comes last: a study that was killed leaves no
//! half file, and a folder without `result.json` is not finished. Files of an earlier run that this one does not write
//! are removed.
//!
//! ```text
//! result.json             the answer
//! report.html             question, answer, inputs with sources, tables, pictures, warnings
//! ASK.parquet, ASK.csv    a row a point; ASK.limits.csv: what a program permits
//! ASK.vtp, ASK.vti        for ParaView: planes and paths, boxes
//! ASK.svg, ASK-WHAT.svg   pictures, each as .png too
//! .armill-files           the names of all these, for the next run
//! ```
//!
//! `ASK` is the `slug` of the ask's name. `folder`: which files; `rows`: the points; `tables`, `pictures`, `plates`,
//! `path` with `along`, `holes`, `lattice`, `limits`, `arm`, `report`: what they show.

pub(crate) mod along;
mod arm;
mod folder;
mod holes;
mod lattice;
mod limits;
mod path;
mod pictures;
mod plates;
pub(crate) mod report;
mod rows;
mod tables;

pub use arm::{arm_drawing, arm_posture, posture_drawing};
pub use pictures::Picture;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use armill_formats::file::{create_folder, remove_abandoned, write_atomically};
use armill_formats::table::{Column, ColumnData, Table, csv};
use rayon::prelude::*;

use crate::answer::StudyAnswer;
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::run::Done;

/// What to write beside `result.json`, Parquet and VTK.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// Whether there are pictures and a report.
    pub pictures: Pictures,
    /// Which asks get a CSV.
    pub csv: Csv,
    /// What the report begins with, where the study was changed before it was run.
    pub opening: Option<&'a Opening>,
}

/// The first chapter of a report: what was looked for and found before the study was run.
#[derive(Clone, Debug)]
pub struct Opening {
    /// Its heading.
    pub heading: &'static str,
    /// What was found, a sentence each.
    pub sentences: Vec<String>,
    /// Pictures of the search.
    pub pictures: Vec<Picture>,
}

impl Wanted<'static> {
    /// What a run writes unless it is told otherwise.
    pub const USUAL: Wanted<'static> = Wanted {
        pictures: Pictures::Drawn,
        csv: Csv::MapsAndPaths,
        opening: None,
    };
    /// No pictures, no report.
    pub const TABLES: Wanted<'static> = Wanted {
        pictures: Pictures::None,
        ..Wanted::USUAL
    };
}

/// Which asks get a CSV; Parquet has the same columns and a third of the size or less.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Csv {
    /// Maps and paths, which one looks through in a spreadsheet.
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

/// Pixels a picture is drawn in for each of its own: sharp on paper.
#[cfg(feature = "png")]
const PNG_SCALE: f64 = 2.0;

/// What pictures of an ask add to its name.
const PICTURES: [&str; 16] = [
    "budget", "measured", "waves", "holes", "cells", "turns", "region", "shares", "ellipse", "arm",
    "vectors", "along", "polar", "track", "process", "forces",
];

/// Whether files called `slug` could be pictures of the ask called `ask`.
pub(crate) fn is_picture_of(slug: &str, ask: &str) -> bool {
    slug.strip_prefix(ask)
        .and_then(|rest| rest.strip_prefix('-'))
        .is_some_and(|rest| PICTURES.contains(&rest))
}

/// A part of a file name that every system takes: letters (of any script), digits and hyphens.
///
/// Different names may give the same; a name without letters and digits gives nothing.
pub fn slug(name: &str) -> String {
    let mut slug = String::new();
    for c in name.chars() {
        if c.is_alphanumeric() {
            slug.extend(c.to_lowercase());
        } else if !slug.ends_with('-') {
            slug.push('-');
        }
    }
    slug.trim_matches('-').to_owned()
}

/// Makes the folder `out` and refuses it if nothing can be written there, before any work is done.
///
/// # Errors
/// The folder cannot be made or written to.
pub fn prepare(out: &Path) -> Result<(), StudyError> {
    create_folder(out)?;
    remove_abandoned(out);
    let probe = out.join(".armill-probe");
    write_atomically(&probe, b"")?;
    // A probe that cannot be removed again does no harm.
    let _ = std::fs::remove_file(probe);
    Ok(())
}

/// Writes everything into `out` and gives the paths of the files; `note` hears each name as it comes, from any thread.
///
/// # Errors
/// A file cannot be written.
pub fn write(
    study: &Study,
    done: &[Done<'_>],
    answer: &StudyAnswer,
    (out, wanted): (&Path, Wanted<'_>),
    note: &(dyn Fn(&str) + Sync),
) -> Result<Vec<PathBuf>, StudyError> {
    let drawn = match wanted.pictures {
        Pictures::Drawn => pictures::draw(study, done, answer),
        Pictures::None => Vec::new(),
    };
    let names = names(study, &drawn, wanted);
    replace((out, &names), note, |files| {
        let tables = || {
            let asks = study.asks.par_iter().zip(done).with_max_len(1);
            asks.try_for_each(|(ask, done)| {
                let slug = slug(&ask.name);
                tables::files(study, (ask, done), wanted.csv, &|extension, bytes| {
                    files.save(&format!("{slug}.{extension}"), bytes)
                })
            })
        };
        let pictures = || match wanted.pictures {
            Pictures::Drawn => {
                save_pictures(&drawn, files)?;
                files.save(
                    REPORT,
                    report::html(study, answer, (&drawn, wanted.opening)).as_bytes(),
                )
            }
            Pictures::None => Ok(()),
        };
        let (tables, (pictures, text)) = rayon::join(tables, || rayon::join(pictures, || json(answer)));
        tables.and(pictures)?;
        text
    })
}

/// Puts the files called `names`, the answer last, in the place of those of an earlier run, and gives their paths. `work`
/// saves all but the answer, whose text it gives.
///
/// # Errors
/// That of `work`; a file cannot be written.
pub(crate) fn replace(
    (out, names): (&Path, &[String]),
    note: &(dyn Fn(&str) + Sync),
    work: impl FnOnce(&folder::Folder<'_>) -> Result<String, StudyError>,
) -> Result<Vec<PathBuf>, StudyError> {
    // An older answer beside newer tables would pass for theirs if this run were killed; what cannot be removed
    // cannot be replaced either, and writing it will say so.
    let _ = std::fs::remove_file(out.join(RESULT));
    let mine: BTreeSet<String> = names.iter().cloned().collect();
    // What this run and those before it wrote, in case this one is killed.
    let earlier = folder::listed(out);
    folder::list(out, &earlier.union(&mine).cloned().collect())?;
    let mut text = String::new();
    folder::write_together(out, note, |files| {
        text = work(files)?;
        Ok(())
    })?;
    folder::remove(out, earlier.difference(&mine));
    if earlier != mine {
        folder::list(out, &mine)?;
    }
    write_atomically(out.join(RESULT), text.as_bytes())?;
    note(RESULT);
    Ok(names.iter().map(|name| out.join(name)).collect())
}

/// The answer, written last.
pub(crate) const RESULT: &str = "result.json";
/// The report, where pictures are drawn.
pub(crate) const REPORT: &str = "report.html";

/// The names of all files, the answer last.
fn names(study: &Study, drawn: &[Picture], wanted: Wanted) -> Vec<String> {
    let tables = study.asks.iter().flat_map(|ask| {
        let slug = slug(&ask.name);
        let extensions = tables::extensions(ask, wanted.csv).into_iter();
        extensions.map(move |extension| format!("{slug}.{extension}"))
    });
    let pictures = drawn.iter().flat_map(picture_files);
    let report = (wanted.pictures == Pictures::Drawn).then(|| REPORT.to_owned());
    tables
        .chain(pictures)
        .chain(report)
        .chain([RESULT.to_owned()])
        .collect()
}

/// The files of a picture.
pub(crate) fn picture_files(picture: &Picture) -> impl Iterator<Item = String> {
    let png = cfg!(feature = "png").then(|| format!("{}.png", picture.name));
    std::iter::once(format!("{}.svg", picture.name)).chain(png)
}

/// Writes every picture.
///
/// # Errors
/// A picture that cannot be drawn, a file that cannot be written.
pub(crate) fn save_pictures(drawn: &[Picture], files: &folder::Folder<'_>) -> Result<(), StudyError> {
    drawn.par_iter().with_max_len(1).try_for_each(|picture| {
        #[cfg(feature = "png")]
        files.save(&format!("{}.png", picture.name), &png(&picture.svg)?)?;
        files.save(&format!("{}.svg", picture.name), picture.svg.as_bytes())
    })
}

/// The pictures of every ask, in the order of the report.
pub fn pictures(study: &Study, done: &[Done<'_>], answer: &StudyAnswer) -> Vec<Picture> {
    pictures::draw(study, done, answer)
}

/// A picture in pixels, as it is written beside its SVG.
///
/// # Errors
/// A picture that cannot become pixels.
#[cfg(feature = "png")]
pub fn png(svg: &str) -> Result<Vec<u8>, StudyError> {
    Ok(armill_report::raster::png(svg, PNG_SCALE)?)
}

/// The points of one ask with their columns.
///
/// # Errors
/// A table that cannot be made, which would be a fault of armill.
pub fn points_table(study: &Study, done: &Done<'_>) -> Result<Table, StudyError> {
    tables::rows_of(study, done)
}

/// The table of one ask as the CSV that is written of it.
///
/// # Errors
/// A table that cannot be made, which would be a fault of armill.
pub fn table_csv(study: &Study, done: &Done<'_>) -> Result<Vec<u8>, StudyError> {
    Ok(csv::write(&points_table(study, done)?))
}

/// Writes pictures that are not those of an ask into `out`, in place of all there whose names begin with `begin`.
///
/// # Errors
/// A file cannot be written; a picture cannot be drawn in pixels.
pub fn write_pictures(begin: &str, pictures: &[Picture], out: &Path) -> Result<(), StudyError> {
    let names = std::fs::read_dir(out).into_iter().flatten().flatten();
    for file in names.map(|entry| entry.path()) {
        let is_picture = file.extension().is_some_and(|end| end == "svg" || end == "png");
        let name = file
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if is_picture && name.starts_with(begin) {
            // What cannot be removed is written over, or does no harm.
            let _ = std::fs::remove_file(file);
        }
    }
    for picture in pictures {
        #[cfg(feature = "png")]
        write_atomically(out.join(format!("{}.png", picture.name)), &png(&picture.svg)?)?;
        write_atomically(out.join(format!("{}.svg", picture.name)), picture.svg.as_bytes())?;
    }
    Ok(())
}

/// The answer as JSON, one line.
///
/// # Errors
/// Never in practice: the answer holds strings, finite numbers and lists of them.
pub fn json(answer: &StudyAnswer) -> Result<String, StudyError> {
    Ok(serde_json::to_string(answer)? + "\n")
}

/// A column whose every row has a number.
pub(crate) fn column(
    name: &str,
    unit: &str,
    description: &str,
    (decimals, values): (u8, Vec<f64>),
) -> Column {
    Column {
        name: name.to_owned(),
        unit: Some(unit.to_owned()),
        description: description.to_owned(),
        decimals: Some(decimals),
        data: ColumnData::Float(values),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slugs_are_plain_and_keep_different_names_apart() {
        assert_eq!(slug("Table 4: x = 600 mm"), "table-4-x-600-mm");
        assert_eq!(slug("--Ä--"), "ä");
        assert_ne!(slug("größe"), slug("grüße"));
        assert_eq!(slug("../?"), "");
    }
}
