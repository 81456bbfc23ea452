//! Detects the format of a robot file and reads it.
//!
//! | ending | format |
//! |---|---|
//! | `.toml` | our own robot file |
//! | `.urdf` | URDF, or xacro if it contains xacro elements |
//! | `.xacro` | xacro |
//! | `.xml` | URDF or xacro, by its content |
//! | `.yaml`, `.yml` | OPW parameters, or a calibration file of Universal Robots, by its content |
//! | `.dh`, `.csv` | Denavit-Hartenberg table |
//! | `.chain`, `.fsf` | chain of elementary motions |
//! | `.txt` | a table if it names a convention or `alpha`, else a chain |
//!
//! Text is UTF-8, with or without byte order mark, with any line ends; other bytes of a foreign file are taken as
//! Latin-1, which only comments and names can contain.

use std::path::Path;
use std::str::FromStr;

use super::description::RobotDescription;
use super::{armill, chain, dh, opw, ur, urdf};
use crate::document::{Document, Problems, Source};

/// A kind of robot file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Our own robot file.
    Armill,
    /// URDF.
    Urdf,
    /// xacro: URDF with macros.
    Xacro,
    /// OPW parameters in YAML.
    Opw,
    /// Calibration file of Universal Robots in YAML.
    Ur,
    /// A Denavit-Hartenberg table.
    Dh,
    /// A chain of elementary motions.
    Chain,
}

/// Endings, what their files contain (for people, where the ending does not say it), and the format of a text with
/// such an ending.
type FormatRow = (&'static [&'static str], &'static str, fn(&str) -> Option<Format>);

/// Every ending, in the order of messages; the header explains those that several formats share.
const KNOWN: [FormatRow; 8] = [
    (&["toml"], "", |_| Some(Format::Armill)),
    (&["urdf"], "", |text| {
        Some(if text.contains("<xacro:") {
            Format::Xacro
        } else {
            Format::Urdf
        })
    }),
    (&["xacro"], "", |_| Some(Format::Xacro)),
    (&["xml"], "", |text| {
        let macros = text.contains("<xacro:") || text.contains("xmlns:xacro");
        let format = if macros { Format::Xacro } else { Format::Urdf };
        text.contains("<robot").then_some(format)
    }),
    (&["yaml", "yml"], " (OPW parameters, UR calibration)", |text| {
        let is_ur = text.lines().any(|line| line.starts_with("kinematics:"));
        Some(if is_ur { Format::Ur } else { Format::Opw })
    }),
    (&["dh", "csv"], " (Denavit-Hartenberg)", |_| Some(Format::Dh)),
    (&["chain", "fsf"], " (elementary motions)", |_| {
        Some(Format::Chain)
    }),
    (&["txt"], "", |text| {
        let lower = text.to_lowercase();
        let table = lower.contains("convention") || lower.contains("alpha");
        Some(if table { Format::Dh } else { Format::Chain })
    }),
];

/// The supported endings, for people: `.toml, .urdf, ..., .dh or .csv (Denavit-Hartenberg), ...`.
pub fn endings() -> String {
    let known = KNOWN.map(|(endings, what, _)| format!(".{}{what}", endings.join(" or .")));
    known.join(", ")
}

impl Format {
    /// Every format.
    pub const ALL: [Format; 7] = [
        Format::Armill,
        Format::Urdf,
        Format::Xacro,
        Format::Opw,
        Format::Ur,
        Format::Dh,
        Format::Chain,
    ];

    /// Its name, as `--format` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Format::Armill => "armill",
            Format::Urdf => "urdf",
            Format::Xacro => "xacro",
            Format::Opw => "opw",
            Format::Ur => "ur",
            Format::Dh => "dh",
            Format::Chain => "chain",
        }
    }

    /// Whether a path ends like a robot file, regardless of its content.
    pub fn has_ending(path: &Path) -> bool {
        known(path).is_some()
    }

    /// The format of a file by its ending and content; `None` if neither is known.
    pub fn of(path: &Path, text: &str) -> Option<Format> {
        let (_, _, format) = known(path)?;
        format(text)
    }
}

impl FromStr for Format {
    type Err = String;

    /// The format of this name, as `--format` takes it.
    ///
    /// # Errors
    /// A name that no format has; the message lists those that they have.
    fn from_str(name: &str) -> Result<Format, String> {
        let found = Format::ALL.into_iter().find(|format| format.name() == name);
        found.ok_or_else(|| {
            let names = Format::ALL.map(Format::name).join(", ");
            format!("`{name}` is none of {names}")
        })
    }
}

/// The row of [`KNOWN`] for a path; capitals in its ending do not count.
fn known(path: &Path) -> Option<&'static FormatRow> {
    let ending = ending(path)?;
    KNOWN
        .iter()
        .find(|(endings, ..)| endings.contains(&ending.as_str()))
}

/// What follows the last point of a file's name, in small letters.
fn ending(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_lowercase())
}

/// What a user may specify of a robot file in addition to its path.
#[derive(Clone, Debug, Default)]
pub struct RobotReadOptions {
    /// Its format; by ending and content if not given.
    pub format: Option<Format>,
    /// The link of a URDF or xacro that is the flange.
    pub tip: Option<String>,
}

/// The robot of a file that was read from `path`; `id` is the robot's name in results.
///
/// A given format takes precedence over ending and content. Other files are read by xacro, which includes some, and by ours, for a learnt
/// residual.
///
/// # Errors
/// Bytes that are not text, an empty file, an unknown format, and the problems of the format.
pub fn read(
    path: &Path,
    id: &str,
    bytes: &[u8],
    requested: &RobotReadOptions,
) -> Result<RobotDescription, Problems> {
    let shown = path.display().to_string();
    let text = text_of(&shown, bytes)?;
    let whole = |message: String, hint: &str| {
        Problems::from(Source::new(&shown, &text).problem(0..0, message, Some(hint.to_owned())))
    };
    let Some(format) = requested.format.or_else(|| Format::of(path, &text)) else {
        let message = match ending(path).as_deref() {
            Some("xml") => "this XML is not a robot: it has no <robot> element".to_owned(),
            Some(ending) => format!("`.{ending}` is not an ending of robot files"),
            None => "a robot file without ending".to_owned(),
        };
        return Err(whole(
            message,
            &format!("supported are {}; or give the format with --format", endings()),
        ));
    };
    if requested.tip.is_some() && !matches!(format, Format::Urdf | Format::Xacro) {
        let message = format!(
            "a tip was named, but a file of format {} has no links",
            format.name()
        );
        return Err(whole(message, "leave --tip out"));
    }
    match format {
        // Ours is UTF-8, whatever else others may be.
        Format::Armill => {
            let text = Document::text_of(&shown, bytes)?;
            let found = armill::read(&shown, id, text)?;
            armill::with_residuals_of_its_file(found, path, text)
        }
        Format::Urdf => urdf::read_to_tip(&shown, id, &text, requested.tip.as_deref()),
        #[cfg(feature = "xacro")]
        Format::Xacro => super::xacro::read_to_tip(path, id, &text, requested.tip.as_deref()),
        #[cfg(not(feature = "xacro"))]
        Format::Xacro => Err(whole(
            "this build of armill does not read xacro".to_owned(),
            "expand the file to URDF first, or build with the feature `xacro`",
        )),
        Format::Opw => opw::read(&shown, id, &text),
        Format::Ur => ur::read(&shown, id, &text),
        Format::Dh => dh::read(&shown, id, &text),
        Format::Chain => chain::read(&shown, id, &text),
    }
}

/// The text of a file.
///
/// # Errors
/// An empty file; bytes that no text has.
fn text_of(shown: &str, bytes: &[u8]) -> Result<String, Problems> {
    let ends = bytes
        .iter()
        .rposition(|byte| *byte != 0)
        .map_or(0, |last| last + 1);
    let text = decoded(bytes.get(..ends).unwrap_or_default());
    let source = Source::new(shown, &text);
    let refused = |at: usize, message: String, hint: &str| {
        Err(Problems::from(source.problem(
            at..at,
            message,
            Some(hint.to_owned()),
        )))
    };
    if source.text().trim().is_empty() {
        return refused(0, "the file is empty".to_owned(), "a robot file is required");
    }
    let strange = |c: char| c.is_ascii_control() && !matches!(c, '\t' | '\n' | '\r' | '\x0c');
    if let Some((at, c)) = source.text().char_indices().find(|(_, c)| strange(*c)) {
        let hint = match bytes {
            [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "this file is UTF-16: save it as UTF-8",
            _ => "robot files are text: this is a file of another kind",
        };
        return refused(
            at,
            format!("not a text file: it contains the byte 0x{:02x}", u32::from(c)),
            hint,
        );
    }
    Ok(source.text().to_owned())
}

/// UTF-8, or Latin-1 where that cannot be; line ends of old Macs as ours.
///
/// A carriage return ends a line only in a text without any line feed; elsewhere it stays, as white space.
fn decoded(bytes: &[u8]) -> String {
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    };
    match text.contains('\n') {
        true => text,
        false => text.replace('\r', "\n"),
    }
}

#[cfg(test)]
mod tests;
