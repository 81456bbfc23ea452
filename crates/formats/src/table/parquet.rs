//! A table as a Parquet file, and back: snappy, row groups of 65536 rows, missing is null.
//!
//! | column | Arrow type |
//! |---|---|
//! | float, optional float | Float64, nullable if values may be missing |
//! | integer, flag, text | Int64, Boolean, Utf8 |
//! | category | Utf8 of labels; all labels, in order, are a JSON list in the field's metadata `labels` |
//!
//! Numbers of a column that says how many decimals mean something are kept to a power of two below the last decimal
//! (1/1024 for three decimals): the bytes that are then zero take no room. Numbers are split into streams of bytes
//! (`BYTE_STREAM_SPLIT`), except where few differ: there a dictionary is shorter.
//!
//! Each field's metadata has its `unit`, `description` and `decimals`; the file's has `table` and what the caller adds. Same table,
//! same bytes, for one version of the `parquet` crate.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;
use std::sync::Arc;

use ::parquet::arrow::ArrowWriter;
use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use ::parquet::arrow::arrow_writer::{ArrowColumnChunk, ArrowColumnWriter, compute_leaves};
use ::parquet::basic::{Compression, Encoding};
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::{EnabledStatistics, WriterProperties, WriterPropertiesBuilder};
use ::parquet::schema::types::ColumnPath;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema};
use bytes::Bytes;
use rayon::prelude::*;

use super::{Column, ColumnData, Table, TableError};

/// Rows that a reader must hold at once: a few megabytes for a wide table.
const ROW_GROUP_ROWS: usize = 65_536;

const TABLE_KEY: &str = "table";
const UNIT_KEY: &str = "unit";
const DESCRIPTION_KEY: &str = "description";
const DECIMALS_KEY: &str = "decimals";
const LABELS_KEY: &str = "labels";

/// Facts about a whole file, such as the version that made it and the hash of its study.
pub type Metadata = BTreeMap<String, String>;

/// Why a Parquet file was not written or read.
#[derive(Debug, thiserror::Error)]
pub enum ParquetError {
    /// The bytes are not Parquet, or they are damaged.
    #[error("not a readable Parquet file: {0}")]
    Format(#[from] ::parquet::errors::ParquetError),
    /// The bytes are damaged in a way that the `parquet` crate does not survive.
    #[error("the Parquet file is damaged: write it anew")]
    Damaged,
    /// The columns could not be put together.
    #[error("Parquet columns do not fit together: {0}")]
    Columns(#[from] arrow_schema::ArrowError),
    /// A column has a type, or missing values, that no [`ColumnData`] holds.
    #[error(
        "Parquet column `{column}` is {found}: expected Float64, or Int64, Boolean or Utf8 without missing values"
    )]
    Type {
        /// The column.
        column: String,
        /// Its Arrow type.
        found: String,
    },
    /// A category is not among the labels the file lists.
    #[error("Parquet column `{column}` has \"{label}\" in row {row}: not among its labels")]
    Label {
        /// The column.
        column: String,
        /// The row, from 0.
        row: usize,
        /// The text that is no label.
        label: String,
    },
    /// The metadata `table` belongs to the name of the table.
    #[error("the file metadata `{key}` is taken: choose another name")]
    ReservedKey {
        /// The name.
        key: String,
    },
    /// What was read is no table.
    #[error(transparent)]
    Table(#[from] TableError),
}

/// The table as the bytes of a Parquet file.
///
/// # Errors
/// [`ParquetError::ReservedKey`] for metadata called `table` or `ARROW:schema`; the `parquet` crate refuses nothing that a
/// [`Table`] can hold.
pub fn write(table: &Table, metadata: &Metadata) -> Result<Vec<u8>, ParquetError> {
    if let Some(key) = metadata
        .keys()
        .find(|key| *key == TABLE_KEY || *key == ::parquet::arrow::ARROW_SCHEMA_META_KEY)
    {
        return Err(ParquetError::ReservedKey { key: key.clone() });
    }
    let name = KeyValue::new(TABLE_KEY.to_owned(), table.name().to_owned());
    let facts = metadata
        .iter()
        .map(|(key, value)| KeyValue::new(key.clone(), value.clone()));
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_statistics_enabled(EnabledStatistics::None)
        .set_created_by(concat!("armill-formats version ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_key_value_metadata(Some(std::iter::once(name).chain(facts).collect()));
    let properties = table.columns().iter().fold(properties, encoded).build();
    let schema = Arc::new(Schema::new(table.columns().iter().map(field).collect::<Vec<_>>()));
    let writer = ArrowWriter::try_new(Vec::new(), Arc::clone(&schema), Some(properties))?;
    let (mut file, groups) = writer.into_serialized_writer()?;
    for (index, start) in (0..table.row_count()).step_by(ROW_GROUP_ROWS).enumerate() {
        let rows = start..table.row_count().min(start + ROW_GROUP_ROWS);
        let writers = groups.create_column_writers(index)?;
        let chunks = writers
            .into_par_iter()
            .zip(table.columns())
            .zip(schema.fields().par_iter());
        let chunks: Vec<ArrowColumnChunk> = chunks
            .map(|((writer, column), field)| chunk(writer, field, array(column, rows.clone())))
            .collect::<Result<_, _>>()?;
        let mut group = file.next_row_group()?;
        for chunk in chunks {
            chunk.append_to_row_group(&mut group)?;
        }
        group.close()?;
    }
    Ok(file.into_inner()?)
}

/// The values of a column in one row group, encoded.
fn chunk(
    mut writer: ArrowColumnWriter,
    field: &Field,
    values: ArrayRef,
) -> Result<ArrowColumnChunk, ParquetError> {
    for leaf in compute_leaves(field, &values)? {
        writer.write(&leaf)?;
    }
    Ok(writer.close()?)
}

/// How many rows are looked at to tell whether a dictionary of numbers is worth it, and how many may differ.
const LOOKED_AT: usize = 512;
const FEW: usize = 128;

/// The properties with the encoding that suits a column.
fn encoded(properties: WriterPropertiesBuilder, column: &Column) -> WriterPropertiesBuilder {
    let bits = |row: usize| match &column.data {
        ColumnData::Float(values) => Some(values[row].to_bits()),
        ColumnData::OptionalFloat(values) => values[row].map(f64::to_bits),
        _ => None,
    };
    if !matches!(column.data, ColumnData::Float(_) | ColumnData::OptionalFloat(_)) {
        return properties;
    }
    let every = column.data.row_count().div_ceil(LOOKED_AT).max(1);
    let rows = (0..column.data.row_count()).step_by(every);
    let different: BTreeSet<u64> = rows.filter_map(bits).collect();
    if different.len() <= FEW {
        return properties;
    }
    let path = ColumnPath::new(vec![column.name.clone()]);
    properties
        .set_column_dictionary_enabled(path.clone(), false)
        .set_column_encoding(path, Encoding::BYTE_STREAM_SPLIT)
}

/// The table in the bytes of a Parquet file, and the file's metadata.
///
/// # Errors
/// Bytes that are not Parquet, columns of other types than [`write()`] makes, and what [`Table::new`] refuses.
///
/// Not checked: damage that leaves a readable file; Parquet as written here has no checksums.
pub fn read(bytes: &[u8]) -> Result<(Table, Metadata), ParquetError> {
    // The parquet crate (60.1) panics on some damaged pages. Nothing outlives the closure, so nothing is left half done.
    std::panic::catch_unwind(|| read_trusting(bytes)).unwrap_or(Err(ParquetError::Damaged))
}

fn read_trusting(bytes: &[u8]) -> Result<(Table, Metadata), ParquetError> {
    let builder = ParquetRecordBatchReaderBuilder::try_new(Bytes::copy_from_slice(bytes))?;
    let pairs = builder
        .metadata()
        .file_metadata()
        .key_value_metadata()
        .cloned()
        .unwrap_or_default();
    let mut metadata: Metadata = pairs
        .into_iter()
        .map(|pair| (pair.key, pair.value.unwrap_or_default()))
        .collect();
    metadata.remove(::parquet::arrow::ARROW_SCHEMA_META_KEY);
    let name = metadata.remove(TABLE_KEY).unwrap_or_default();
    let schema = Arc::clone(builder.schema());
    let batches = builder.build()?.collect::<Result<Vec<RecordBatch>, _>>()?;
    let column = |(index, field): (usize, &Arc<Field>)| {
        let parts: Vec<&ArrayRef> = batches.iter().map(|batch| batch.column(index)).collect();
        read_column(field, &parts)
    };
    let columns = schema
        .fields()
        .iter()
        .enumerate()
        .map(column)
        .collect::<Result<Vec<_>, _>>()?;
    Ok((Table::new(name, columns)?, metadata))
}

fn field(column: &Column) -> Field {
    let mut metadata = HashMap::from([(DESCRIPTION_KEY.to_owned(), column.description.clone())]);
    metadata.extend(column.unit.clone().map(|unit| (UNIT_KEY.to_owned(), unit)));
    let decimals = column.decimals.map(|decimals| decimals.to_string());
    metadata.extend(decimals.map(|decimals| (DECIMALS_KEY.to_owned(), decimals)));
    let (kind, nullable) = match &column.data {
        ColumnData::Float(_) => (DataType::Float64, false),
        ColumnData::OptionalFloat(_) => (DataType::Float64, true),
        ColumnData::Integer(_) => (DataType::Int64, false),
        ColumnData::Flag(_) => (DataType::Boolean, false),
        ColumnData::Text(_) => (DataType::Utf8, false),
        ColumnData::Category { labels, .. } => {
            metadata.insert(LABELS_KEY.to_owned(), serde_json::json!(labels).to_string());
            (DataType::Utf8, false)
        }
    };
    Field::new(&column.name, kind, nullable).with_metadata(metadata)
}

fn array(column: &Column, rows: Range<usize>) -> ArrayRef {
    let kept = kept(column.decimals);
    match &column.data {
        ColumnData::Float(values) => Arc::new(Float64Array::from_iter_values(
            values[rows].iter().map(|value| kept(*value)),
        )),
        ColumnData::OptionalFloat(values) => Arc::new(
            values[rows]
                .iter()
                .map(|value| value.map(&kept))
                .collect::<Float64Array>(),
        ),
        ColumnData::Integer(values) => Arc::new(Int64Array::from_iter_values(values[rows].iter().copied())),
        ColumnData::Flag(values) => Arc::new(BooleanArray::from(values[rows].to_vec())),
        ColumnData::Text(values) => Arc::new(StringArray::from_iter_values(&values[rows])),
        ColumnData::Category { codes, labels } => Arc::new(StringArray::from_iter_values(
            codes[rows].iter().map(|code| &labels[*code as usize]),
        )),
    }
}

/// What is kept of a number when so many decimals mean something: multiples of the largest power of two that is not
/// above the last decimal.
fn kept(decimals: Option<u8>) -> impl Fn(f64) -> f64 {
    // Adding a number whose last bit is worth the step rounds to it; taking it off again is exact.
    let large = decimals.filter(|decimals| *decimals < 12).map(|decimals| {
        let step = 2_f64.powi(-(f64::from(decimals) * std::f64::consts::LOG2_10).ceil() as i32);
        1.5 * step / f64::EPSILON
    });
    move |value| match large {
        Some(large) if value.abs() < large * 0.25 => (value + large) - large,
        _ => value,
    }
}

fn read_column(field: &Field, parts: &[&ArrayRef]) -> Result<Column, ParquetError> {
    let metadata = field.metadata();
    let missing = parts.iter().any(|part| part.null_count() > 0);
    let data = match (field.data_type(), metadata.get(LABELS_KEY)) {
        (DataType::Float64, _) if field.is_nullable() => {
            let values = parts
                .iter()
                .flat_map(|part| part.as_primitive::<Float64Type>().iter());
            ColumnData::OptionalFloat(values.collect())
        }
        (DataType::Float64, _) => {
            let values = parts
                .iter()
                .flat_map(|part| part.as_primitive::<Float64Type>().values().iter());
            ColumnData::Float(values.copied().collect())
        }
        (DataType::Int64, _) if !missing => {
            let values = parts
                .iter()
                .flat_map(|part| part.as_primitive::<Int64Type>().values().iter());
            ColumnData::Integer(values.copied().collect())
        }
        (DataType::Boolean, _) if !missing => ColumnData::Flag(
            parts
                .iter()
                .flat_map(|part| part.as_boolean().values().iter())
                .collect(),
        ),
        (DataType::Utf8, labels) if !missing => {
            let texts = parts
                .iter()
                .flat_map(|part| part.as_string::<i32>().iter().flatten());
            match labels.and_then(|labels| serde_json::from_str(labels).ok()) {
                Some(labels) => category(field.name(), texts, labels)?,
                None => ColumnData::Text(texts.map(str::to_owned).collect()),
            }
        }
        (kind, _) => {
            let found = if missing {
                format!("{kind} with missing values")
            } else {
                kind.to_string()
            };
            return Err(ParquetError::Type {
                column: field.name().clone(),
                found,
            });
        }
    };
    let description = metadata
        .get(DESCRIPTION_KEY)
        .map(ToString::to_string)
        .unwrap_or_default();
    Ok(Column {
        name: field.name().clone(),
        unit: metadata.get(UNIT_KEY).map(ToString::to_string),
        description,
        decimals: metadata.get(DECIMALS_KEY).and_then(|text| text.parse().ok()),
        data,
    })
}

fn category<'a>(
    column: &str,
    texts: impl Iterator<Item = &'a str>,
    labels: Vec<String>,
) -> Result<ColumnData, ParquetError> {
    let code = |(row, text): (usize, &str)| {
        let code = labels
            .iter()
            .position(|label| label == text)
            .and_then(|code| u32::try_from(code).ok());
        code.ok_or_else(|| ParquetError::Label {
            column: column.to_owned(),
            row,
            label: text.to_owned(),
        })
    };
    let codes = texts.enumerate().map(code).collect::<Result<_, _>>()?;
    Ok(ColumnData::Category { codes, labels })
}

#[cfg(test)]
mod tests {
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
        // Hash maps order their keys anew each time: eight writings would show it.
        let first = write(&sample(), &metadata()).unwrap();
        for _ in 0..8 {
            assert_eq!(write(&sample(), &metadata()).unwrap(), first);
        }
    }

    #[test]
    fn units_and_meanings_are_in_the_field_metadata() {
        let bytes = Bytes::from(write(&sample(), &metadata()).unwrap());
        let builder = ParquetRecordBatchReaderBuilder::try_new(bytes).unwrap();
        let field = builder.schema().field_with_name("in_plane_um").unwrap();
        assert_eq!(
            field.metadata().get("unit").map(ToString::to_string).as_deref(),
            Some("um")
        );
        assert!(
            field
                .metadata()
                .get("description")
                .unwrap()
                .starts_with("what in_plane_um means")
        );
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
        let builder = ParquetRecordBatchReaderBuilder::try_new(Bytes::from(bytes.clone())).unwrap();
        let rows: Vec<i64> = builder
            .metadata()
            .row_groups()
            .iter()
            .map(::parquet::file::metadata::RowGroupMetaData::num_rows)
            .collect();
        assert_eq!(rows, [65_536, 65_536, 18_928]);
        assert_eq!(
            builder.metadata().row_group(0).column(0).compression(),
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

    fn foreign(array: ArrayRef, field: Field) -> Vec<u8> {
        let schema = Arc::new(Schema::new(vec![field]));
        let batch = RecordBatch::try_new(Arc::clone(&schema), vec![array]).unwrap();
        let mut writer = ArrowWriter::try_new(Vec::new(), schema, None).unwrap();
        writer.write(&batch).unwrap();
        writer.into_inner().unwrap()
    }

    #[test]
    fn types_that_no_table_holds_are_refused_by_name() {
        let short = arrow_array::Float32Array::from(vec![1.0]);
        let error = read(&foreign(
            Arc::new(short),
            Field::new("x", DataType::Float32, false),
        ))
        .unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("Parquet column `x` is Float32: expected"),
            "{error}"
        );
        let gaps = Int64Array::from(vec![Some(1), None]);
        let error = read(&foreign(Arc::new(gaps), Field::new("n", DataType::Int64, true))).unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("Parquet column `n` is Int64 with missing values"),
            "{error}"
        );
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused() {
        let strange = Float64Array::from(vec![f64::NAN]);
        let error = read(&foreign(
            Arc::new(strange),
            Field::new("x", DataType::Float64, false),
        ))
        .unwrap_err();
        assert!(
            matches!(error, ParquetError::Table(TableError::NotFinite { .. })),
            "{error}"
        );
    }

    #[test]
    fn a_category_that_is_no_label_is_refused() {
        let labels = HashMap::from([("labels".to_owned(), "[\"a\"]".to_owned())]);
        let field = Field::new("c", DataType::Utf8, false).with_metadata(labels);
        let error = read(&foreign(Arc::new(StringArray::from(vec!["a", "b"])), field)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "Parquet column `c` has \"b\" in row 1: not among its labels"
        );
    }

    #[test]
    fn metadata_of_a_taken_name_is_refused() {
        for key in ["table", "ARROW:schema"] {
            let error = write(&sample(), &Metadata::from([(key.to_owned(), String::new())])).unwrap_err();
            assert!(matches!(error, ParquetError::ReservedKey { .. }), "{error}");
        }
    }
}
