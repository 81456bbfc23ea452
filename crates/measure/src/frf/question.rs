//! Settings, and reading the files.

use std::io::BufReader;
use std::path::PathBuf;

use armill_core::dynamics::modal_fit::Frf;
use armill_formats::input;
use armill_formats::measurement::frf;
use armill_study::StudyError;

use super::axes::Axes;

/// What is asked of the FRFs.
#[derive(Clone, Debug, Default)]
pub struct FrfQuestion {
    /// Band of angular frequencies, rad/s; none: that which all FRFs of a set have.
    pub band: Option<[f64; 2]>,
    /// Modes of each set; none: as many as the FRFs determine.
    pub modes: Option<usize>,
    /// Point of the tip; none: the only one with a drive point.
    pub point: Option<i64>,
    /// Directions of the measured axes in the feed frame; none: X, Y, Z are x, y, z.
    pub axes: Option<Axes>,
}

/// FRFs of all files.
#[derive(Clone, Debug, Default)]
pub struct ReadFrfs {
    /// The files.
    pub files: Vec<String>,
    /// Their FRFs.
    pub frfs: Vec<Frf>,
    /// Coherence at each frequency of each FRF; empty if it is not known.
    pub coherences: Vec<Vec<f64>>,
    /// File of each FRF: its place in `files`.
    pub file_of: Vec<usize>,
    /// Ignored columns and datasets, each with its file.
    pub unused: Vec<String>,
    /// What to know of them.
    pub notes: Vec<String>,
}

/// Reads these files.
///
/// # Errors
/// A file that cannot be read; its problems.
pub fn read(paths: &[PathBuf]) -> Result<ReadFrfs, StudyError> {
    let mut all = ReadFrfs::default();
    for path in paths {
        let file = path.display().to_string();
        let opened = input::open(path).map_err(|error| {
            StudyError::value(
                format!("cannot read {file}: {error}"),
                "a universal file (dataset 58), or a table: frequency_hz, receptance_real_um_per_n, ...",
            )
        })?;
        let found = frf::read(&file, BufReader::new(opened))?;
        all.file_of.extend(found.frfs.iter().map(|_| all.files.len()));
        all.frfs.extend(found.frfs);
        all.coherences.extend(found.coherences);
        all.unused
            .extend(found.unused.iter().map(|name| format!("{name} ({file})")));
        all.notes.extend(found.notes);
        all.files.push(file);
    }
    Ok(all)
}
