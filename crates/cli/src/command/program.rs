//! Options of a robot program in SI, for `compensate` and `ballbar`; and its files, written.

use armill_core::units::{from_mm, from_um};
use std::path::{Path, PathBuf};

use armill_formats::file::{Writer, create_folder};
use armill_programs::{Language, Written};
use armill_study::StudyError;
use armill_study::program_out::ProgramSettings;

use crate::arguments::ProgramOptions;
use crate::arguments::numbers::within;
use crate::terminal::say;

/// The requested program and its folder; `feed_mm_per_min` is the feed if the path does not specify it.
///
/// # Errors
/// An unknown extension; invalid numbers.
pub(super) fn requested(
    options: &ProgramOptions,
    feed_mm_per_min: Option<f64>,
) -> Result<Option<(PathBuf, ProgramSettings)>, StudyError> {
    let Some(file) = &options.program else {
        return Ok(None);
    };
    let ending = file
        .extension()
        .and_then(|ending| ending.to_str())
        .map(str::to_lowercase);
    let language = ending.as_deref().and_then(Language::of_ending);
    let language = language.ok_or_else(|| {
        let message = format!(
            "--program: the extension of {} is not that of a robot language",
            file.display()
        );
        StudyError::value(message, ".src, .mod, .jbi, .ls, .script or .pjx")
    })?;
    let requested = ProgramSettings {
        language,
        name: file
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
        frame_number: options.frame,
        tool_number: options.tool,
        within: from_um(within("--within-um", options.within_um, [0.1, 1e6])?),
        rounding: from_um(options.within_um),
        retract: from_mm(within("--retract-mm", options.retract_mm, [0.0, 1e4])?),
        blend: from_mm(within("--blend-mm", options.blend_mm, [0.0, 1e3])?),
        feed: match feed_mm_per_min {
            Some(feed) => Some(within("--feed-mm-per-min", feed, [1.0, 1e6])? / 60e3),
            None => None,
        },
    };
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    Ok(Some((folder.unwrap_or(".".as_ref()).to_path_buf(), requested)))
}

/// Writes the files of a program into `folder`, and reports them.
///
/// # Errors
/// A folder or file that cannot be written.
pub(super) fn save(writer: &Writer, folder: &Path, written: &Written) -> Result<(), StudyError> {
    create_folder(folder)?;
    let files: Vec<(PathBuf, &[u8])> = (written.files.iter())
        .map(|(name, bytes)| (folder.join(name), &bytes[..]))
        .collect();
    writer.write_all(&files)?;
    for (path, _) in &files {
        say(&format!(
            "program {}",
            path.strip_prefix(".").unwrap_or(path).display()
        ));
    }
    written
        .notes
        .iter()
        .for_each(|note| say(&format!("note: {note}")));
    Ok(())
}
