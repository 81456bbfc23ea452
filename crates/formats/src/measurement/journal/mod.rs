//! The journal of an arm: every measurement with its day, its temperature, and its file.
//!
//! ```text
//! format = 1, robot = "yaskawa/mh12", tool_mm = [0, 0, 150]
//! [prior]            length_mm, angle_deg, factor
//! [[measurement]]    date, temperature_c, kind = "part" | "tracker" | "ball-bar" | "load-tests", file, u_um, calibrated, sha256, point_mm, note
//! ```
//!
//! `file` has the tables as written; here they are checked and converted to SI. All keys: `docs/guide/journal.md`.

mod file;

use armill_core::calibrate;
use armill_core::nalgebra::Vector3;
use armill_core::units::{from_deg, from_mm, from_um};
use armill_core::update::PriorFactors;

use self::file::{JournalFile, KindWord, MeasurementTable};
use crate::document::{Document, Problem, Problems, schema_json};

/// The measurements of an arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Journal {
    /// Robot of the library, or robot file.
    pub robot: String,
    /// Tip of the tool, flange frame, m.
    pub tool_point: Vector3<f64>,
    /// What is known of an arm of this kind.
    pub prior: PriorFactors,
    /// In their order.
    pub measurements: Vec<Entry>,
}

/// One measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Day, as 2026-11-24.
    pub date: String,
    /// Temperature of the arm, deg C.
    pub temperature_c: f64,
    /// What was measured.
    pub kind: Kind,
    /// Its table, relative to the journal.
    pub file: String,
    /// Checksum that the file must have.
    pub sha256: Option<String>,
    /// The measured point, flange frame, m.
    pub point: Vector3<f64>,
    /// For people.
    pub note: Option<String>,
}

/// What was measured, with the standard uncertainty of a coordinate or distance, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Features that the tool cut.
    Part(f64),
    /// A point on the tool.
    Tracker(f64),
    /// Displacements under load.
    LoadTests,
    /// Distances of a point on the tool from a fixed pivot.
    BallBar {
        /// Standard uncertainty, m.
        u: f64,
        /// Whether the length of the bar is known.
        is_calibrated: bool,
    },
}

/// Reads a journal; `name` is the file name shown in problems.
///
/// # Errors
/// All problems of the file.
pub fn read(name: &str, bytes: &[u8]) -> Result<Journal, Problems> {
    let document = Document::from_bytes(name, bytes)?;
    let file: JournalFile = document.read()?;
    let mut problems = Vec::new();
    let within = |point: [f64; 3]| Vector3::from(point).map(from_mm);
    let mut entries = Vec::new();
    for (index, table) in file.measurement.into_iter().enumerate() {
        match entry(&document, index, table, file.tool_mm) {
            Ok(entry) => entries.push(entry),
            Err(wrong) => problems.extend(wrong),
        }
    }
    Problems::from(problems).into_result()?;
    Ok(Journal {
        robot: file.robot,
        tool_point: within(file.tool_mm),
        prior: PriorFactors {
            geometry: calibrate::Prior {
                length: from_mm(file.prior.length_mm),
                angle: from_deg(file.prior.angle_deg),
            },
            factor: file.prior.factor,
        },
        measurements: entries,
    })
}

/// The schema of a journal, JSON.
pub fn schema() -> String {
    schema_json::<JournalFile>()
}

fn entry(
    document: &Document,
    index: usize,
    table: MeasurementTable,
    tool_mm: [f64; 3],
) -> Result<Entry, Vec<Problem>> {
    let mut problems = Vec::new();
    let mut report = |key: &str, message: String, hint: &str| {
        problems.push(document.problem(&format!("measurement[{index}].{key}"), message, Some(hint)));
    };
    if !is_day(&table.date) {
        report(
            "date",
            format!("`{}` is not a day", table.date),
            "year, month and day, as 2026-11-24",
        );
    }
    let is_sum = |sum: &String| sum.len() == 64 && sum.bytes().all(|digit| digit.is_ascii_hexdigit());
    if table.sha256.as_ref().is_some_and(|sum| !is_sum(sum)) {
        report(
            "sha256",
            "the checksum is not one of SHA-256".to_owned(),
            "64 hexadecimal digits, as `sha256sum FILE` prints them; or leave it out",
        );
    }
    let u = table.u_um.map(from_um);
    let kind = match (table.kind, u) {
        (KindWord::Part, Some(u)) => Some(Kind::Part(u)),
        (KindWord::Tracker, Some(u)) => Some(Kind::Tracker(u)),
        (KindWord::BallBar, Some(u)) => Some(Kind::BallBar {
            u,
            is_calibrated: table.calibrated.unwrap_or(false),
        }),
        (KindWord::LoadTests, None) => Some(Kind::LoadTests),
        (KindWord::LoadTests, Some(_)) => {
            let hint = "remove it: the file of load tests states it for each displacement (d_u_mm)";
            report(
                "u_um",
                "load tests have an uncertainty of their own".to_owned(),
                hint,
            );
            None
        }
        (KindWord::Part | KindWord::Tracker | KindWord::BallBar, None) => {
            let hint = "add u_um = 10, the standard uncertainty of a measured coordinate or distance";
            report("kind", "the measurement has no uncertainty".to_owned(), hint);
            None
        }
    };
    if table.kind != KindWord::BallBar && table.calibrated.is_some() {
        let hint = "remove it: it says whether the length of a ball-bar is known";
        report("calibrated", "the measurement has no ball-bar".to_owned(), hint);
    }
    if table.kind == KindWord::Part && table.point_mm.is_some() {
        let hint = "remove it: the tip of the tool cut the part (tool_mm)";
        report(
            "point_mm",
            "a part has no measured point on the flange".to_owned(),
            hint,
        );
    }
    match kind.filter(|_| problems.is_empty()) {
        None => Err(problems),
        Some(kind) => Ok(Entry {
            date: table.date,
            temperature_c: table.temperature_c,
            kind,
            file: table.file,
            sha256: table.sha256.map(|sum| sum.to_lowercase()),
            point: Vector3::from(table.point_mm.unwrap_or(tool_mm)).map(from_mm),
            note: table.note,
        }),
    }
}

/// Whether a text is a day of the calendar, as 2026-11-24.
fn is_day(text: &str) -> bool {
    let parts: Vec<&str> = text.split('-').collect();
    let &[year, month, day] = parts.as_slice() else {
        return false;
    };
    let number = |part: &str, digits: usize| {
        let plain = part.len() == digits && part.bytes().all(|digit| digit.is_ascii_digit());
        part.parse::<u32>().ok().filter(|_| plain)
    };
    let (Some(year), Some(month), Some(day)) = (number(year, 4), number(month, 2), number(day, 2)) else {
        return false;
    };
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let days = match month {
        2 if leap => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => 0,
    };
    (1..=days).contains(&day)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"format = 1
robot = "yaskawa/mh12"
tool_mm = [0, 0, 150]

[prior]
length_mm = 0.3

[[measurement]]
date = "2026-11-24"
temperature_c = 21.5
kind = "part"
file = "part.csv"
u_um = 5

[[measurement]]
date = "2028-02-29"
temperature_c = 24
kind = "load-tests"
file = "loads.csv"
"#;

    #[test]
    fn a_journal_is_read_in_si() {
        let journal = read("arm.toml", GOOD.as_bytes()).unwrap();
        assert_eq!(journal.tool_point, Vector3::new(0.0, 0.0, 0.15));
        assert!((journal.prior.geometry.length - 3e-4).abs() < 1e-18 && journal.prior.factor == 2.0);
        let kinds: Vec<Kind> = journal.measurements.iter().map(|entry| entry.kind).collect();
        assert_eq!(kinds, [Kind::Part(5.0 * 1e-6), Kind::LoadTests]);
        assert_eq!(journal.measurements[1].point, journal.tool_point);
        assert!(schema().contains("temperature_c"));
        let bar = GOOD.replace("kind = \"part\"", "kind = \"ball-bar\"\ncalibrated = true");
        let bar = read("arm.toml", bar.as_bytes()).unwrap().measurements[0].kind;
        let is_calibrated = true;
        assert_eq!(
            bar,
            Kind::BallBar {
                u: 5.0 * 1e-6,
                is_calibrated
            }
        );
    }

    #[test]
    fn all_problems_are_reported_with_their_places() {
        let bad = GOOD
            .replace("2026-11-24", "24.11.2026")
            .replace("u_um = 5", "sha256 = \"12\"\npoint_mm = [0, 0, 1]")
            .replace(
                "file = \"loads.csv\"",
                "file = \"loads.csv\"\nu_um = 3\ncalibrated = true",
            )
            .replace("2028-02-29", "2026-02-29");
        let problems = read("arm.toml", bad.as_bytes()).unwrap_err().to_string();
        for part in [
            "`24.11.2026` is not a day",
            "arm.toml:9:",
            "add u_um = 10",
            "64 hexadecimal",
            "the tip of the tool cut",
            "`2026-02-29` is not a day",
            "d_u_mm",
            "the measurement has no ball-bar",
        ] {
            assert!(problems.contains(part), "{part}: {problems}");
        }
        let none = "format = 1\nrobot = \"a\"\ntool_mm = [0, 0, 0]\nmeasurement = []\nwhat = 1\n";
        let problems = read("arm.toml", none.as_bytes()).unwrap_err().to_string();
        assert!(
            problems.contains("what") && problems.contains("measurement"),
            "{problems}"
        );
    }
}
