//! A table as comma separated values: RFC 4180, with a header.
//!
//! | value | cell |
//! |---|---|
//! | number | the fewest digits that give the same number back: `0.1`, `1e300` |
//! | missing | empty; `""` where the table has a single column, since readers skip empty lines |
//! | flag | `true`, `false` |
//! | category | its label |
//!
//! Source: RFC 4180; lines end with CR LF. Units are in the header; descriptions have no place here.

use super::{ColumnData, Table};

/// The table as UTF-8 text, a header and one line for each row.
pub fn write(table: &Table) -> Vec<u8> {
    let mut out = ::csv::WriterBuilder::new()
        .terminator(::csv::Terminator::CRLF)
        .from_writer(Vec::new());
    let mut line = |cells: Vec<String>| {
        out.write_record(cells)
            .expect("writing to memory does not fail, and all lines have the same number of cells");
    };
    line(table.columns().iter().map(|column| column.name.clone()).collect());
    for row in 0..table.row_count() {
        line(
            table
                .columns()
                .iter()
                .map(|column| cell(&column.data, row))
                .collect(),
        );
    }
    out.into_inner().expect("memory flushes without an error")
}

fn cell(data: &ColumnData, row: usize) -> String {
    match data {
        ColumnData::Float(values) => number(values[row]),
        ColumnData::OptionalFloat(values) => values[row].map_or_else(String::new, number),
        ColumnData::Integer(values) => values[row].to_string(),
        ColumnData::Flag(values) => values[row].to_string(),
        ColumnData::Text(values) => values[row].clone(),
        ColumnData::Category { codes, labels } => labels[codes[row] as usize].clone(),
    }
}

/// Debug gives the shortest text that reads back equal, with an exponent where that is shorter.
fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::super::{Column, sample};
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
        let expected = "x_mm,in_plane_um,count,within_limit,note,reach\r\n\
             0.1,0.3333333333333333,-9223372036854775808,true,,beyond joint 3\r\n\
             -0,,0,false,\"comma, \"\"quote\"\"\",reached\r\n\
             1e300,-7.5e-9,-1,false,\"line\r\nbreak\",reached\r\n";
        assert!(text.starts_with(expected), "{text}");
        assert!(text.ends_with("\r\n"));
    }

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        let shown: Vec<String> = [0.0, 2.0, 1e20, 0.1 + 0.2, 5e-324, 1234567.0]
            .map(number)
            .to_vec();
        assert_eq!(
            shown,
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
            data: ColumnData::Flag(vec![]),
        };
        assert_eq!(write(&Table::new("t", vec![column]).unwrap()), b"a\r\n");
    }
}
