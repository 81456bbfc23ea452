//! Maps over a series of planes: at several distances, or at several tilts.
//!
//! [`resolve`] the planes; [`pictures`] one sheet. Answers, sentence and report are those of a map for each section.

pub mod pictures;
pub mod resolve;

use armill_core::map::PlaneMap;

use crate::analysis::sheet::Sheet;

/// One plane of a series.
#[derive(Clone, Debug)]
pub struct Section<'a> {
    /// Its label.
    pub label: &'a str,
    /// Its plane and setting.
    pub sheet: &'a Sheet,
    /// Its result.
    pub map: PlaneMap,
}
