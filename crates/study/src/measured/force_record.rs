//! A record of measured forces, from its file.

use std::io::BufReader;
use std::path::Path;

use armill_core::load::{ActsOn, Record};
use armill_formats::input;
use armill_formats::measurement::format::{self, ForceReadOptions};

use crate::error::StudyError;
use crate::measured::treatment::Refusal;

/// A record as its file has it.
#[derive(Clone, Debug)]
pub struct SensorRecord {
    /// Axes of the sensor.
    pub record: Record,
    /// Format of the file.
    pub format: &'static str,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// Which cycle of how many.
    pub cycle: [usize; 2],
}

/// Reason why there is no record: the file or a setting is wrong.
#[derive(Debug)]
pub enum Unread {
    /// Problems of the file.
    File(StudyError),
    /// A value that cannot be.
    Value(Refusal),
}

/// Reads the record in `path`; `shown` is its name in problems, `cycle` counts from 1.
///
/// # Errors
/// The file cannot be read; its problems; several cycles and none given, or one that it does not have.
pub fn read(
    shown: &str,
    path: &Path,
    acts_on: ActsOn,
    requested: &ForceReadOptions,
    cycle: Option<usize>,
) -> Result<SensorRecord, Unread> {
    let file = input::open(path).map_err(|error| {
        Unread::Value(Refusal::new(
            "file",
            format!("cannot read {shown}: {error}"),
            "a text export of DynoWare, or a CSV with `time_s,fx_n,fy_n,fz_n`",
        ))
    })?;
    let known = format::read(shown, BufReader::new(file), acts_on, requested);
    let mut known = known.map_err(|problems| Unread::File(problems.into()))?;
    let count = known.records.len();
    // One cycle needs no choice; of several none is taken by chance.
    let chosen = match (cycle, count) {
        (None, 1) => 1,
        (Some(cycle), _) if (1..=count).contains(&cycle) => cycle,
        (given, _) => {
            let message = match given {
                None => format!("{shown} has {count} cycles"),
                Some(given) => format!("{shown} has {count} cycles, but no cycle {given}"),
            };
            let hint = format!("choose one, from 1 to {count}");
            return Err(Unread::Value(Refusal::new("cycle", message, hint)));
        }
    };
    Ok(SensorRecord {
        record: known.records.swap_remove(chosen - 1),
        format: known.format.name(),
        unused: known.unused,
        cycle: [chosen, count],
    })
}
