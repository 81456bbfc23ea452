//! Formats that robots are written in, by name and ending.

use std::str::FromStr;

/// A format that robots are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportFormat {
    /// URDF.
    Urdf,
    /// xacro, with its arguments in a YAML file.
    Xacro,
    /// Calibration file of `ur_description`.
    Ur,
    /// Denavit-Hartenberg table.
    Dh,
    /// SDF.
    Sdf,
    /// MJCF.
    Mjcf,
}

impl ExportFormat {
    /// Every format.
    pub const ALL: [ExportFormat; 6] = [
        ExportFormat::Urdf,
        ExportFormat::Xacro,
        ExportFormat::Ur,
        ExportFormat::Dh,
        ExportFormat::Sdf,
        ExportFormat::Mjcf,
    ];

    /// Its name, as `--format` takes it.
    pub fn name(self) -> &'static str {
        match self {
            ExportFormat::Urdf => "urdf",
            ExportFormat::Xacro => "xacro",
            ExportFormat::Ur => "ur",
            ExportFormat::Dh => "dh",
            ExportFormat::Sdf => "sdf",
            ExportFormat::Mjcf => "mjcf",
        }
    }

    /// The format of files with this ending (without point, any case).
    pub fn of_ending(ending: &str) -> Option<ExportFormat> {
        match ending.to_lowercase().as_str() {
            "urdf" => Some(ExportFormat::Urdf),
            "xacro" => Some(ExportFormat::Xacro),
            "yaml" | "yml" => Some(ExportFormat::Ur),
            "dh" | "csv" => Some(ExportFormat::Dh),
            "sdf" => Some(ExportFormat::Sdf),
            "mjcf" | "xml" => Some(ExportFormat::Mjcf),
            _ => None,
        }
    }
}

impl FromStr for ExportFormat {
    type Err = String;

    /// The format of this name.
    ///
    /// # Errors
    /// A name that no format has; the message lists those that they have.
    fn from_str(name: &str) -> Result<ExportFormat, String> {
        let found = ExportFormat::ALL.into_iter().find(|format| format.name() == name);
        found.ok_or_else(|| {
            let names = ExportFormat::ALL.map(ExportFormat::name).join(", ");
            format!("`{name}` is none of {names}")
        })
    }
}

/// How a format is called in a sentence.
pub(super) fn title(format: ExportFormat) -> &'static str {
    match format {
        ExportFormat::Urdf => "URDF",
        ExportFormat::Xacro => "xacro",
        ExportFormat::Ur => "a UR calibration file",
        ExportFormat::Dh => "a Denavit-Hartenberg table",
        ExportFormat::Sdf => "SDF",
        ExportFormat::Mjcf => "MJCF",
    }
}
