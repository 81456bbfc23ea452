//! A table as comma separated values: RFC 4180, with a header.
//!
//! | value | cell |
//! |---|---|
//! | number | the significant decimals of its column, without zeros at the end; if the column does not specify them, the fewest digits that give the same number back: `0.1`, `1e300` |
//! | missing | empty; `""` where the table has a single column, since readers skip empty lines |
//! | flag | `true`, `false` |
//! | category | its label |
//! | text that begins with `=`, `+`, `-`, `@`, a tab or a line end | in quotes, behind an apostrophe: `"'=1+1"` |
//!
//! A spreadsheet would run the last as a formula, for example the name of a robot or joint. Our readers take the
//! apostrophe off again.
//!
//! Source: RFC 4180; OWASP, CSV injection. Lines end with CR LF. Units are in the header; descriptions have no place
//! here.

use std::io::Write;

use super::{Column, ColumnData, Table};

/// The table as UTF-8 text, a header and one line for each row.
///
/// Lines end with CR LF, the last one too.
pub fn write(table: &Table) -> Vec<u8> {
    let columns = table.columns();
    let mut out = Vec::with_capacity((table.row_count() + 1) * columns.len() * BYTES_PER_CELL);
    for (index, column) in columns.iter().enumerate() {
        separate(&mut out, index);
        text(&mut out, &column.name);
    }
    out.extend_from_slice(END_OF_LINE);
    for row in 0..table.row_count() {
        let start = out.len();
        for (index, column) in columns.iter().enumerate() {
            separate(&mut out, index);
            cell(&mut out, column, row);
        }
        if columns.len() == 1 && out.len() == start {
            out.extend_from_slice(b"\"\"");
        }
        out.extend_from_slice(END_OF_LINE);
    }
    out
}

/// What a cell of a table of deviations takes, about; only the first allocation depends on it.
const BYTES_PER_CELL: usize = 9;

/// As RFC 4180 has it.
const END_OF_LINE: &[u8] = b"\r\n";

/// A comma before every cell but the first of a line.
fn separate(out: &mut Vec<u8>, index: usize) {
    if index > 0 {
        out.push(b',');
    }
}

/// The value of a column in a row; nothing where it is missing.
fn cell(out: &mut Vec<u8>, column: &Column, row: usize) {
    let float = |out: &mut Vec<u8>, value| match column.decimals {
        Some(decimals) => rounded(out, value, usize::from(decimals)),
        None => number(out, value),
    };
    match &column.data {
        ColumnData::Float(values) => float(out, values[row]),
        ColumnData::OptionalFloat(values) => values[row].into_iter().for_each(|value| float(out, value)),
        ColumnData::Integer(values) => formatted(out, format_args!("{}", values[row])),
        ColumnData::OptionalInteger(values) => {
            if let Some(value) = values[row] {
                formatted(out, format_args!("{value}"));
            }
        }
        ColumnData::Flag(values) => out.extend_from_slice(if values[row] { b"true" } else { b"false" }),
        ColumnData::Text(values) => text(out, &values[row]),
        ColumnData::Category { codes, labels } => text(out, &labels[codes[row] as usize]),
    }
}

/// A text as a cell, for tables that are not made of columns.
pub fn text_cell(cell: &str) -> String {
    let mut out = Vec::with_capacity(cell.len());
    text(&mut out, cell);
    String::from_utf8(out).expect("quotes and apostrophes are added to text")
}

/// Whether a spreadsheet would run the text; also one with apostrophes before it, so that it reads back equal.
pub(super) fn is_formula(text: &str) -> bool {
    text.trim_start_matches('\'')
        .starts_with(['=', '+', '-', '@', '\t', '\r', '\n'])
}

/// Text in quotes where a reader would take it apart or a spreadsheet run it otherwise.
fn text(out: &mut Vec<u8>, text: &str) {
    let parts = |c: u8| matches!(c, b',' | b'"' | b'\r' | b'\n');
    let formula = is_formula(text);
    if !formula && !text.bytes().any(parts) {
        return out.extend_from_slice(text.as_bytes());
    }
    out.push(b'"');
    if formula {
        out.push(b'\'');
    }
    for byte in text.bytes() {
        if byte == b'"' {
            out.push(b'"');
        }
        out.push(byte);
    }
    out.push(b'"');
}

/// The shortest text that reads back equal, with an exponent where that is shorter.
///
/// A whole number has no point: `1`, not `1.0`.
fn number(out: &mut Vec<u8>, value: f64) {
    let start = out.len();
    formatted(out, format_args!("{value:?}"));
    if out[start..].ends_with(b".0") {
        out.truncate(out.len() - 2);
    }
}

/// By exponent: with more than nine decimals all digits are written.
const POWERS_OF_TEN: [f64; 10] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9];
/// Below this a whole number of the last decimal is exact.
const EXACT: f64 = 9e15;

/// At most so many decimals, without zeros at the end; numbers that are too large for that in full.
///
/// A half is rounded away from zero. A number that rounds to zero is written without sign.
fn rounded(out: &mut Vec<u8>, value: f64, decimals: usize) {
    let scaled = match POWERS_OF_TEN.get(decimals) {
        Some(power) => (value * power).abs() + 0.5,
        None => f64::INFINITY,
    };
    if scaled < EXACT {
        decimal(out, value < 0.0, scaled as u64, decimals);
    } else {
        number(out, value);
    }
}

/// So many parts of the last decimal.
///
/// `parts` over ten to the power of `decimals`, digit by digit from the last; zeros behind the point are left out.
fn decimal(out: &mut Vec<u8>, negative: bool, parts: u64, decimals: usize) {
    // Sixteen digits at most, a point, a sign, and zeros after the point.
    let mut digits = [b'0'; 32];
    let mut first = digits.len();
    let (mut rest, mut place) = (parts, 0);
    while rest > 0 || place <= decimals {
        if place == decimals && decimals > 0 {
            first -= 1;
            digits[first] = b'.';
        }
        first -= 1;
        digits[first] = b'0' + (rest % 10) as u8;
        rest /= 10;
        place += 1;
    }
    if negative && parts > 0 {
        first -= 1;
        digits[first] = b'-';
    }
    let mut end = digits.len();
    if decimals > 0 {
        while digits[end - 1] == b'0' {
            end -= 1;
        }
        if digits[end - 1] == b'.' {
            end -= 1;
        }
    }
    out.extend_from_slice(&digits[first..end]);
}

/// Puts formatted text behind what is there.
fn formatted(out: &mut Vec<u8>, arguments: std::fmt::Arguments<'_>) {
    out.write_fmt(arguments).expect("writing to memory does not fail");
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    /// The cells of a column, read back by the csv crate.
    fn read_back(table: &Table, index: usize) -> Vec<String> {
        let bytes = write(table);
        let mut reader = ::csv::Reader::from_reader(bytes.as_slice());
        reader
            .records()
            .map(|record| record.unwrap()[index].to_owned())
            .collect()
    }

    #[test]
    fn every_number_reads_back_bit_for_bit() {
        let table = sample();
        let ColumnData::Float(expected) = &table.columns()[0].data else {
            panic!("the sample starts with numbers")
        };
        for (cell, expected) in read_back(&table, 0).iter().zip(expected) {
            assert_eq!(
                cell.parse::<f64>().unwrap().to_bits(),
                expected.to_bits(),
                "{cell}"
            );
        }
        let integers: Vec<i64> = read_back(&table, 2)
            .iter()
            .map(|cell| cell.parse().unwrap())
            .collect();
        assert_eq!(ColumnData::Integer(integers), table.columns()[2].data);
    }

    #[test]
    fn a_missing_number_is_an_empty_cell() {
        let cells = read_back(&sample(), 1);
        assert_eq!(cells, ["0.3333333333333333", "", "-7.5e-9", ""]);
    }

    #[test]
    fn text_with_commas_quotes_and_line_breaks_reads_back_equal() {
        let table = sample();
        assert_eq!(ColumnData::Text(read_back(&table, 4)), table.columns()[4].data);
    }

    #[test]
    fn formulas_are_written_behind_an_apostrophe_and_read_back_without_it() {
        for (text, expected) in [
            ("=cmd|' /C calc'!A0", "\"'=cmd|' /C calc'!A0\""),
            ("+1", "\"'+1\""),
            ("-2+3", "\"'-2+3\""),
            ("@SUM(1,2)", "\"'@SUM(1,2)\""),
            ("\t=1", "\"'\t=1\""),
            ("'=1", "\"''=1\""),
            ("'plain", "'plain"),
            ("a=1", "a=1"),
            ("", ""),
        ] {
            let cell = text_cell(text);
            assert_eq!(cell, expected);
            let line = format!("x,{cell},y");
            let read = super::super::sheet::cells(&line, ',');
            assert_eq!(read[1].text, text, "{line}");
        }
        // Names of columns as well; numbers stay numbers.
        let column = |name: &str, data| Column {
            name: name.to_owned(),
            unit: None,
            description: String::new(),
            decimals: None,
            data,
        };
        let note = ColumnData::Text(vec!["=1+1".to_owned()]);
        let columns = vec![column("-a", ColumnData::Float(vec![-5.0])), column("note", note)];
        let written = write(&Table::new("t", columns).unwrap());
        assert_eq!(
            String::from_utf8(written).unwrap(),
            "\"'-a\",note\r\n-5,\"'=1+1\"\r\n"
        );
    }

    #[test]
    fn flags_and_categories_are_words() {
        assert_eq!(read_back(&sample(), 3), ["true", "false", "false", "true"]);
        assert_eq!(
            read_back(&sample(), 5),
            ["beyond joint 3", "reached", "reached", "beyond joint 3"]
        );
    }

    #[test]
    fn the_text_is_as_rfc_4180_wants_it() {
        let text = String::from_utf8(write(&sample())).unwrap();
        let expected = "x_mm,in_plane_um,count,within_limit,note,reach,worst_case\r\n\
             0.1,0.3333333333333333,-9223372036854775808,true,,beyond joint 3,9223372036854775807\r\n\
             -0,,0,false,\"comma, \"\"quote\"\"\",reached,\r\n\
             1e300,-7.5e-9,-1,false,\"line\r\nbreak\",reached,1\r\n";
        assert!(text.starts_with(expected), "{text}");
        assert!(text.ends_with("\r\n"));
    }

    fn shown(value: f64, decimals: usize) -> String {
        let mut out = Vec::new();
        rounded(&mut out, value, decimals);
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn decimals_that_mean_nothing_are_left_out() {
        let cases = [
            (179.312_345_6, 3, "179.312"),
            (-0.000_6, 3, "-0.001"),
            (-0.000_4, 3, "0"),
            (-0.0, 6, "0"),
            (1000.0, 6, "1000"),
            (1000.0, 0, "1000"),
            (999.999_6, 3, "1000"),
            (0.05, 6, "0.05"),
            (-102.5, 1, "-102.5"),
            (1e300, 3, "1e300"),
            (0.1, 200, "0.1"),
        ];
        for (value, decimals, text) in cases {
            assert_eq!(shown(value, decimals), text, "{value} to {decimals} decimals");
        }
    }

    #[test]
    fn a_rounded_number_is_the_one_that_formatting_gives() {
        for n in 0..100_000_u32 {
            // Odd 1/1024ths are never halfway between two decimals of at most 6 digits.
            let value = (f64::from(n * 2 + 1) / 1024.0 - 60.0) * 1.7;
            for decimals in [0, 3, 6] {
                let text = format!("{value:.decimals$}");
                let bare = if decimals > 0 {
                    text.trim_end_matches('0').trim_end_matches('.')
                } else {
                    &text
                };
                let bare = if bare == "-0" { "0" } else { bare };
                assert_eq!(shown(value, decimals), bare, "{value} to {decimals} decimals");
            }
        }
    }

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        let texts: Vec<String> = [0.0, 2.0, 1e20, 0.1 + 0.2, 5e-324, 1234567.0]
            .map(|value| {
                let mut out = Vec::new();
                number(&mut out, value);
                String::from_utf8(out).unwrap()
            })
            .to_vec();
        assert_eq!(
            texts,
            ["0", "2", "1e20", "0.30000000000000004", "5e-324", "1234567"]
        );
    }

    #[test]
    fn a_single_column_keeps_the_rows_of_its_missing_values() {
        let data = ColumnData::OptionalFloat(vec![None, Some(1.0), None]);
        let column = Column {
            name: "a_mm".to_owned(),
            unit: None,
            description: String::new(),
            decimals: None,
            data,
        };
        assert_eq!(
            write(&Table::new("t", vec![column]).unwrap()),
            b"a_mm\r\n\"\"\r\n1\r\n\"\"\r\n"
        );
    }

    #[test]
    fn a_table_without_rows_is_its_header() {
        let column = Column {
            name: "a".to_owned(),
            unit: None,
            description: String::new(),
            decimals: None,
            data: ColumnData::Flag(vec![]),
        };
        assert_eq!(write(&Table::new("t", vec![column]).unwrap()), b"a\r\n");
    }
}
