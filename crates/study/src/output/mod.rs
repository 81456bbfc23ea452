//! What a study leaves behind: `result.json`, tables, pictures and a report in one folder.
//!
//! Every file is written beside its place and renamed, and `result.json` comes last: a study that was killed
//! leaves no half file, and a folder without `result.json` is not finished.

mod arm;
mod pictures;
mod plates;
mod report;
mod rows;
mod tables;

pub use arm::{arm_drawing, arm_posture, posture_drawing};
pub use pictures::Picture;

use std::path::{Path, PathBuf};

use armill_formats::file::{create_folder, write_atomically};

use crate::answer::StudyAnswer;
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::run::Found;

/// What to write beside the tables.
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
const PICTURES: [&str; 7] = ["region", "shares", "ellipse", "arm", "vectors", "along", "polar"];

/// Whether files called `slug` could be pictures of the ask called `ask`.
pub(crate) fn is_picture_of(slug: &str, ask: &str) -> bool {
    slug.strip_prefix(ask)
        .and_then(|rest| rest.strip_prefix('-'))
        .is_some_and(|rest| PICTURES.contains(&rest))
}

/// A part of a file name that every system takes: letters (of any script), digits and hyphens.
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
    let probe = out.join(".armill-probe");
    write_atomically(&probe, b"")?;
    // A probe that cannot be removed again does no harm.
    let _ = std::fs::remove_file(probe);
    Ok(())
}

/// Writes everything into `out` and gives the names of the files; `note` hears each name as it comes.
///
/// # Errors
/// A file cannot be written.
pub fn write(
    study: &Study,
    found: &[Found],
    answer: &StudyAnswer,
    place: (&Path, Pictures),
    note: &dyn Fn(&str),
) -> Result<Vec<PathBuf>, StudyError> {
    let (out, pictures) = place;
    // An older answer beside newer tables would pass for theirs if this run were killed; what cannot be removed
    // cannot be replaced either, and writing it will say so.
    let _ = std::fs::remove_file(out.join("result.json"));
    let mut written = Vec::new();
    let mut save = |name: &str, bytes: &[u8]| -> Result<(), StudyError> {
        let path = out.join(name);
        write_atomically(&path, bytes)?;
        note(name);
        written.push(path);
        Ok(())
    };
    for (ask, found) in study.asks.iter().zip(found) {
        for (extension, bytes) in tables::files(study, ask, found)? {
            save(&format!("{}.{extension}", slug(&ask.name)), &bytes)?;
        }
    }
    if pictures == Pictures::Drawn {
        let drawn = pictures::draw(study, found, answer);
        for picture in &drawn {
            save(&format!("{}.svg", picture.name), picture.svg.as_bytes())?;
            #[cfg(feature = "png")]
            save(
                &format!("{}.png", picture.name),
                &armill_report::raster::png(&picture.svg, PNG_SCALE)?,
            )?;
        }
        save("report.html", report::html(study, answer, &drawn).as_bytes())?;
    }
    save("result.json", json(answer)?.as_bytes())?;
    Ok(written)
}

/// The answer as JSON, one line.
///
/// # Errors
/// Never in practice: the answer holds strings, finite numbers and lists of them.
pub fn json(answer: &StudyAnswer) -> Result<String, StudyError> {
    Ok(serde_json::to_string(answer)? + "\n")
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
