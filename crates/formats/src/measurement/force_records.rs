//! What is read from a force file, and what must be given in addition to it.

use armill_core::load::Record;

/// Format of a force file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A text export of DynoWare.
    DynoWare,
    /// A table with a column for each channel.
    Csv,
}

impl Format {
    /// Its name, for messages.
    pub fn name(self) -> &'static str {
        match self {
            Format::DynoWare => "DynoWare",
            Format::Csv => "CSV",
        }
    }
}

/// Values that the file does not contain, and the names of its channels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceReadOptions {
    /// Samples per second, for a CSV without a time column.
    pub rate_hz: Option<f64>,
    /// The columns in order, for a CSV without a header. Names other than those of [`csv`](super::csv) are ignored.
    pub columns: Option<Vec<String>>,
    /// Names of the channels of an export: three forces, then three moments if there are any. The default is `Fx` to
    /// `Mz`.
    pub channels: Option<Vec<String>>,
}

/// Content of a force file.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceRecords {
    /// Its format.
    pub format: Format,
    /// The records in order: one, or one per cycle of an export; axes of the sensor.
    pub records: Vec<Record>,
    /// Ignored columns.
    pub unused: Vec<String>,
}
