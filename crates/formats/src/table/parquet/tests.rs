//! Tables that are written read back; files of others are refused by name.

use super::super::sample;
use super::*;

fn metadata() -> Metadata {
    Metadata::from([
        ("study".to_owned(), "mh12-groove".to_owned()),
        ("armill".to_owned(), "0.1.0".to_owned()),
    ])
}

#[test]
fn a_table_reads_back_equal() {
    let bytes = write(&sample(), &metadata()).unwrap();
    assert_eq!(read(&bytes).unwrap(), (sample(), metadata()));
}

#[test]
fn the_same_table_gives_the_same_bytes() {
    // The order of hash maps changes from run to run: eight writings would show it.
    let first = write(&sample(), &metadata()).unwrap();
    for _ in 0..8 {
        assert_eq!(write(&sample(), &metadata()).unwrap(), first);
    }
}

#[test]
fn units_and_meanings_are_in_the_metadata_of_the_file() {
    let bytes = Bytes::from(write(&sample(), &metadata()).unwrap());
    let file = SerializedFileReader::new(bytes).unwrap();
    let pairs = file.metadata().file_metadata().key_value_metadata().unwrap();
    let text = pairs
        .iter()
        .find(|pair| pair.key == "columns")
        .unwrap()
        .value
        .as_ref()
        .unwrap();
    let columns: serde_json::Value = serde_json::from_str(text).unwrap();
    let columns = columns.as_array().unwrap();
    let of = |name: &str| columns.iter().find(|column| column["name"] == name).unwrap();
    assert_eq!(of("in_plane_um")["unit"], "um");
    assert!(
        of("in_plane_um")["description"]
            .as_str()
            .unwrap()
            .starts_with("what in_plane_um means")
    );
    // In the order of the columns, as any reader of the schema sees them.
    let names: Vec<&str> = columns
        .iter()
        .map(|column| column["name"].as_str().unwrap())
        .collect();
    let schema = file.metadata().file_metadata().schema_descr().columns().iter();
    assert_eq!(names, schema.map(|column| column.name()).collect::<Vec<_>>());
}

#[test]
fn row_groups_are_bounded_and_compressed_with_snappy() {
    let values: Vec<f64> = (0..150_000).map(f64::from).collect();
    let column = Column {
        name: "x_mm".to_owned(),
        unit: None,
        description: String::new(),
        decimals: None,
        data: ColumnData::Float(values),
    };
    let table = Table::new("long", vec![column]).unwrap();
    let bytes = write(&table, &Metadata::new()).unwrap();
    let file = SerializedFileReader::new(Bytes::from(bytes.clone())).unwrap();
    let rows: Vec<i64> = file
        .metadata()
        .row_groups()
        .iter()
        .map(::parquet::file::metadata::RowGroupMetaData::num_rows)
        .collect();
    assert_eq!(rows, [65_536, 65_536, 18_928]);
    assert_eq!(
        file.metadata().row_group(0).column(0).compression(),
        Compression::SNAPPY
    );
    assert_eq!(read(&bytes).unwrap().0, table);
}

/// A column of 100 000 numbers that all differ, every fifth missing.
fn deviations(decimals: Option<u8>) -> Table {
    let value = |i: u32| (!i.is_multiple_of(5)).then(|| (f64::from(i) * 0.618).sin() * 200.0);
    let column = Column {
        name: "in_plane_um".to_owned(),
        unit: Some("um".to_owned()),
        description: String::new(),
        decimals,
        data: ColumnData::OptionalFloat((0..100_000).map(value).collect()),
    };
    Table::new("map", vec![column]).unwrap()
}

#[test]
fn numbers_without_decimals_read_back_bit_for_bit() {
    let table = deviations(None);
    assert_eq!(read(&write(&table, &Metadata::new()).unwrap()).unwrap().0, table);
}

#[test]
fn numbers_with_decimals_read_back_to_them_and_take_half_the_room() {
    let (exact, table) = (deviations(None), deviations(Some(3)));
    let bytes = write(&table, &Metadata::new()).unwrap();
    let back = read(&bytes).unwrap().0;
    assert_eq!(back.columns()[0].decimals, Some(3));
    let numbers = |table: &Table| match &table.columns()[0].data {
        ColumnData::OptionalFloat(values) => values.clone(),
        _ => panic!("the column has numbers"),
    };
    for (kept, value) in numbers(&back).into_iter().zip(numbers(&table)) {
        // Half of 2^-10.
        assert!(
            kept.zip(value)
                .is_none_or(|(kept, value)| (kept - value).abs() <= 0.5 / 1024.0)
        );
        assert_eq!(kept.is_some(), value.is_some());
    }
    let all = write(&exact, &Metadata::new()).unwrap();
    assert!(
        bytes.len() * 2 < all.len(),
        "{} of {} bytes",
        bytes.len(),
        all.len()
    );
}

#[test]
fn numbers_too_large_for_their_decimals_are_kept_whole() {
    let kept = kept(Some(3));
    assert_eq!(
        (kept(1e300), kept(-1e13), kept(-0.2)),
        (1e300, -1e13, -205.0 / 1024.0)
    );
    assert_eq!(kept(179.312), 183_615.0 / 1024.0);
}

#[test]
fn a_table_without_rows_reads_back_equal() {
    let columns = sample().columns.into_iter().map(|mut column| {
        column.data = match column.data {
            ColumnData::Float(_) => ColumnData::Float(vec![]),
            ColumnData::OptionalFloat(_) => ColumnData::OptionalFloat(vec![]),
            ColumnData::Integer(_) => ColumnData::Integer(vec![]),
            ColumnData::OptionalInteger(_) => ColumnData::OptionalInteger(vec![]),
            ColumnData::Flag(_) => ColumnData::Flag(vec![]),
            ColumnData::Text(_) => ColumnData::Text(vec![]),
            ColumnData::Category { labels, .. } => ColumnData::Category {
                codes: vec![],
                labels,
            },
        };
        column
    });
    let table = Table::new("empty", columns.collect()).unwrap();
    assert_eq!(read(&write(&table, &Metadata::new()).unwrap()).unwrap().0, table);
}

#[test]
fn bytes_that_are_not_parquet_are_refused() {
    for bytes in [b"".as_slice(), b"PAR1", b"PAR1PAR1", b"a,b\r\n1,2\r\n"] {
        assert!(matches!(read(bytes), Err(ParquetError::Format(_))));
    }
}

#[test]
fn a_file_cut_short_is_refused() {
    let bytes = write(&sample(), &metadata()).unwrap();
    for length in 0..bytes.len() {
        assert!(read(&bytes[..length]).is_err(), "{length}");
    }
}

#[test]
fn a_damaged_file_is_refused_or_read_but_never_a_panic() {
    let bytes = write(&sample(), &metadata()).unwrap();
    let mut outcomes = [0, 0, 0];
    for at in 0..bytes.len() {
        for bits in [0x01, 0x80, 0xff] {
            let mut damaged = bytes.clone();
            damaged[at] ^= bits;
            outcomes[match read(&damaged) {
                Ok(_) => 0,
                Err(ParquetError::Damaged) => 1,
                Err(_) => 2,
            }] += 1;
        }
    }
    println!("read, panicked inside the crate, refused: {outcomes:?}");
    assert!(outcomes[2] > 0);
}

/// A file with one column `x` of this type, written by `values`, and with this metadata `columns`.
fn foreign(
    kind: PhysicalType,
    repetition: Repetition,
    columns: Option<&str>,
    values: impl FnOnce(&mut ColumnWriter<'_>),
) -> Vec<u8> {
    let text = (kind == PhysicalType::BYTE_ARRAY).then_some(LogicalType::String);
    let field = Type::primitive_type_builder("x", kind)
        .with_repetition(repetition)
        .with_logical_type(text);
    let fields = vec![Arc::new(field.build().unwrap())];
    let schema = Type::group_type_builder("other")
        .with_fields(fields)
        .build()
        .unwrap();
    let given = columns.map(|text| vec![KeyValue::new("columns".to_owned(), text.to_owned())]);
    let properties = WriterProperties::builder().set_key_value_metadata(given).build();
    let mut file = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties)).unwrap();
    let mut group = file.next_row_group().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    values(column.untyped());
    column.close().unwrap();
    group.close().unwrap();
    file.into_inner().unwrap()
}

/// Why such a file is not a table.
fn refused(bytes: &[u8]) -> String {
    read(bytes).unwrap_err().to_string()
}

#[test]
fn types_that_no_table_can_represent_are_refused_by_name() {
    let short = foreign(PhysicalType::FLOAT, Repetition::REQUIRED, None, |column| {
        let ColumnWriter::FloatColumnWriter(column) = column else {
            panic!("of floats")
        };
        column.write_batch(&[1.0], None, None).unwrap();
    });
    assert!(
        refused(&short).starts_with("Parquet column `x` is FLOAT: expected"),
        "{}",
        refused(&short)
    );
    let gaps = foreign(PhysicalType::BOOLEAN, Repetition::OPTIONAL, None, |column| {
        let ColumnWriter::BoolColumnWriter(column) = column else {
            panic!("of flags")
        };
        column.write_batch(&[true], Some(&[1, 0]), None).unwrap();
    });
    assert!(
        refused(&gaps).starts_with("Parquet column `x` is BOOLEAN with missing values"),
        "{}",
        refused(&gaps)
    );
}

#[test]
fn a_file_of_others_is_a_table_without_meanings() {
    let whole = foreign(PhysicalType::INT64, Repetition::OPTIONAL, None, |column| {
        let ColumnWriter::Int64ColumnWriter(column) = column else {
            panic!("of integers")
        };
        column.write_batch(&[1], Some(&[1, 0]), None).unwrap();
    });
    let (table, metadata) = read(&whole).unwrap();
    assert!(metadata.is_empty() && table.columns()[0].unit.is_none());
    assert_eq!(
        table.columns()[0].data,
        ColumnData::OptionalInteger(vec![Some(1), None])
    );
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let strange = foreign(PhysicalType::DOUBLE, Repetition::REQUIRED, None, |column| {
        let ColumnWriter::DoubleColumnWriter(column) = column else {
            panic!("of numbers")
        };
        column.write_batch(&[f64::NAN], None, None).unwrap();
    });
    let error = read(&strange).unwrap_err();
    assert!(
        matches!(error, ParquetError::Table(TableError::NotFinite { .. })),
        "{error}"
    );
}

#[test]
fn a_category_that_is_no_label_is_refused_and_so_are_columns_that_are_no_list() {
    let of = |columns: &str| {
        foreign(
            PhysicalType::BYTE_ARRAY,
            Repetition::REQUIRED,
            Some(columns),
            |column| {
                let ColumnWriter::ByteArrayColumnWriter(column) = column else {
                    panic!("of texts")
                };
                column.write_batch(&["a", "b"].map(bytes_of), None, None).unwrap();
            },
        )
    };
    let facts = |labels: &str| {
        format!(
            "[{{\"name\": \"x\", \"unit\": null, \"description\": \"\", \"decimals\": null, \"labels\": {labels}}}]"
        )
    };
    assert_eq!(
        refused(&of(&facts("[\"a\"]"))),
        "Parquet column `x` has \"b\" in row 1: not among its labels"
    );
    assert!(read(&of(&facts("[\"a\", \"b\"]"))).is_ok());
    assert!(refused(&of("{}")).starts_with("the metadata `columns` of the Parquet file is not a list"));
}

#[test]
fn metadata_of_a_taken_name_is_refused() {
    for key in ["table", "columns"] {
        let error = write(&sample(), &Metadata::from([(key.to_owned(), String::new())])).unwrap_err();
        assert!(matches!(error, ParquetError::ReservedKey { .. }), "{error}");
    }
}
