//! A table as a Parquet file, and back: snappy, row groups of 65536 rows, missing is null.
//!
//! | column | Arrow type |
//! |---|---|
//! | float, optional float | Float64, nullable if values may be missing |
//! | integer, flag, text | Int64, Boolean, Utf8 |
//! | category | Utf8 of labels; all labels, in order, are a JSON list in the field's metadata `labels` |
//!
//! Each field's metadata has its `unit` and `description`; the file's has `table` and what the caller adds. Same table,
//! same bytes, for one version of the `parquet` crate.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use ::parquet::arrow::ArrowWriter;
use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use ::parquet::basic::Compression;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema};
use bytes::Bytes;

use super::{Column, ColumnData, Table, TableError};

/// Rows that a reader must hold at once: a few megabytes for a wide table.
const ROW_GROUP_ROWS: usize = 65_536;

const TABLE_KEY: &str = "table";
const UNIT_KEY: &str = "unit";
const DESCRIPTION_KEY: &str = "description";
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
        .set_max_row_group_row_count(Some(ROW_GROUP_ROWS))
        .set_created_by(concat!("armill-formats version ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_key_value_metadata(Some(std::iter::once(name).chain(facts).collect()))
        .build();
    let schema = Arc::new(Schema::new(table.columns().iter().map(field).collect::<Vec<_>>()));
    let arrays = table.columns().iter().map(|column| array(&column.data)).collect();
    let batch = RecordBatch::try_new(Arc::clone(&schema), arrays)?;
    let mut writer = ArrowWriter::try_new(Vec::new(), schema, Some(properties))?;
    writer.write(&batch)?;
    Ok(writer.into_inner()?)
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

fn array(data: &ColumnData) -> ArrayRef {
    match data {
        ColumnData::Float(values) => Arc::new(Float64Array::from(values.clone())),
        ColumnData::OptionalFloat(values) => Arc::new(Float64Array::from(values.clone())),
        ColumnData::Integer(values) => Arc::new(Int64Array::from(values.clone())),
        ColumnData::Flag(values) => Arc::new(BooleanArray::from(values.clone())),
        ColumnData::Text(values) => Arc::new(StringArray::from_iter_values(values)),
        ColumnData::Category { codes, labels } => Arc::new(StringArray::from_iter_values(
            codes.iter().map(|code| &labels[*code as usize]),
        )),
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
