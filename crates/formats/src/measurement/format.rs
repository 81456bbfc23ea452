//! A force record in either format. The format is recognised from the first lines.
//!
//! A DynoWare export has a line that begins with the plain word `Time` or `Zeit`, after its header. The names of a CSV
//! end in their units. If columns or a sampling rate are given, the file is a CSV; if channel names are given, it is an
//! export.

use std::io::{BufRead, Cursor, Read};

use armill_core::load::ActsOn;

pub use super::force_records::{ForceReadOptions, ForceRecords, Format};
use super::{csv, dynoware};
use crate::document::{Problems, unreadable};

/// Number of bytes that are read to recognise the format.
const HEAD_BYTES: u64 = 1 << 16;

/// Reads the record in `reader`. `path` is the file name shown in problems, `acts_on` the body that the forces act on.
///
/// # Errors
/// The problems of the file, those of [`dynoware::read`] or [`csv::read`].
pub fn read(
    path: &str,
    mut reader: impl BufRead,
    acts_on: ActsOn,
    requested: &ForceReadOptions,
) -> Result<ForceRecords, Problems> {
    let mut head = Vec::new();
    let begun = reader.by_ref().take(HEAD_BYTES).read_to_end(&mut head);
    begun.map_err(|error| unreadable(path, &error))?;
    let format = match requested {
        ForceReadOptions {
            channels: Some(_), ..
        } => Format::DynoWare,
        ForceReadOptions { rate_hz: Some(_), .. } | ForceReadOptions { columns: Some(_), .. } => Format::Csv,
        _ if has_line_of_channels(&head) => Format::DynoWare,
        _ => Format::Csv,
    };
    let whole = Cursor::new(head).chain(reader);
    match format {
        Format::DynoWare => dynoware::read(path, whole, acts_on, requested),
        Format::Csv => csv::read(path, whole, acts_on, requested),
    }
}

/// Whether one of these lines names the channels of an export; with any line ending.
fn has_line_of_channels(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    text.split(['\n', '\r']).any(dynoware::is_channels)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known(text: &str, requested: &ForceReadOptions) -> Result<ForceRecords, String> {
        let read = read("f", text.as_bytes(), ActsOn::Tool, requested);
        read.map_err(|problems| problems.to_string())
    }

    const EXPORT: &str =
        "Date:,today\nTime:,12:00\n\nTime\tFx\tFy\tFz\ns\tN\tkN\tN\n0\t1\t2\t3\n0.1\t4\t5\t6\n";
    const CSV: &str = "time_s,fx_n,fy_kn,fz_n\n0,1,2,3\n0.1,4,5,6\n";

    #[test]
    fn both_formats_give_the_same_numbers() {
        let [export, csv] = [EXPORT, CSV].map(|text| known(text, &ForceReadOptions::default()).unwrap());
        assert_eq!((export.format, csv.format), (Format::DynoWare, Format::Csv));
        let returns = EXPORT.replace('\n', "\r");
        assert_eq!(
            known(&returns, &ForceReadOptions::default()).unwrap(),
            export,
            "line endings do not matter"
        );
        assert_eq!(export.records, csv.records);
        assert_eq!(csv.records[0].force()[0].y, 2000.0);
    }

    #[test]
    fn given_options_select_the_format() {
        let by_hand = ForceReadOptions {
            rate_hz: Some(10.0),
            columns: Some(["fx_n", "fy_kn", "fz_n"].map(str::to_owned).to_vec()),
            ..ForceReadOptions::default()
        };
        let plain = known("1,2,3\n4,5,6\n", &by_hand).unwrap();
        assert_eq!(
            plain.records[0].force(),
            known(CSV, &ForceReadOptions::default()).unwrap().records[0].force()
        );
        let channels = |names: &[&str]| ForceReadOptions {
            channels: Some(names.iter().map(|name| (*name).to_owned()).collect()),
            ..ForceReadOptions::default()
        };
        let renamed = EXPORT.replace("Fx", "Kraft A");
        let found = known(&renamed, &channels(&["Kraft A", "Fy", "Fz"])).unwrap();
        assert_eq!(
            found.records,
            known(EXPORT, &ForceReadOptions::default()).unwrap().records
        );
        let given = known(&renamed, &ForceReadOptions::default()).unwrap_err();
        assert!(given.contains("missing channels: `Fx`"), "{given}");
        let given = known(EXPORT, &channels(&["Fx", "Fy"])).unwrap_err();
        assert!(given.contains("2 names of channels"), "{given}");
    }

    #[test]
    fn a_comment_line_does_not_end_a_record() {
        let remarked = EXPORT.replace("0.1", "# pause\n0.1");
        let found = known(&remarked, &ForceReadOptions::default()).unwrap();
        assert_eq!(
            found.records,
            known(EXPORT, &ForceReadOptions::default()).unwrap().records
        );
    }

    #[test]
    fn commas_between_and_inside_numbers_are_read_as_an_export() {
        let trap = "Time,Fx,Fy,Fz\ns,N,N,N\n0,0,1,5,2,25,3,5\n0,1,1,5,2,25,3,5\n";
        let found = known(trap, &ForceReadOptions::default()).unwrap();
        assert_eq!(found.records[0].force()[0].x, 1.5);
        let given = known(&trap.replace("0,1,1,5", "0,1,1"), &ForceReadOptions::default()).unwrap_err();
        assert!(given.contains("they cannot be distinguished"), "{given}");
    }

    #[test]
    fn text_in_neither_format_is_reported_as_a_table_without_forces() {
        for text in ["", "\n\n", "a,b\n1,2\n"] {
            assert!(
                known(text, &ForceReadOptions::default())
                    .unwrap_err()
                    .contains("time_s,fx_n"),
                "{text:?}"
            );
        }
    }
}
