//! A table as a Parquet file, and back: snappy, row groups of 65536 rows, missing is null.
//!
//! | column | Parquet type |
//! |---|---|
//! | float, optional float | DOUBLE, optional if values may be missing |
//! | integer, flag | INT64, BOOLEAN |
//! | text, category | BYTE_ARRAY of UTF-8 text; of a category its labels |
//!
//! Numbers of a column with a given number of significant decimals are rounded to a power of two below the last decimal
//! (1/1024 for three decimals): the bytes that are then zero take no room. Numbers are split into streams of bytes
//! (`BYTE_STREAM_SPLIT`), except where few differ: there a dictionary is shorter.
//!
//! The file's metadata has `table`, what the caller adds, and `columns`: a JSON list with the `name`, `unit`,
//! `description` and `decimals` of each, and of a category all `labels` in order. Same table, same bytes, for one
//! version of the `parquet` crate.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use ::parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as PhysicalType};
use ::parquet::column::reader::ColumnReader;
use ::parquet::column::writer::{ColumnCloseResult, ColumnWriter, get_column_writer};
use ::parquet::data_type::ByteArray;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::{
    EnabledStatistics, WriterProperties, WriterPropertiesBuilder, WriterPropertiesPtr,
};
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::file::writer::{SerializedFileWriter, SerializedPageWriter, TrackedWrite};
use ::parquet::schema::types::{ColumnDescPtr, ColumnPath, Type, TypePtr};
use bytes::Bytes;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{Column, ColumnData, Table, TableError};

/// Rows that a reader must keep in memory at once: a few megabytes for a wide table.
const ROW_GROUP_ROWS: usize = 65_536;

/// Metadata: the name of the table.
const TABLE_KEY: &str = "table";
/// Metadata: what is known of the columns, as JSON.
const COLUMNS_KEY: &str = "columns";

/// Facts about a whole file, such as the version that made it and the hash of its study.
pub type Metadata = BTreeMap<String, String>;

/// What a file says of a column apart from its values.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
struct Facts {
    name: String,
    unit: Option<String>,
    description: String,
    decimals: Option<u8>,
    /// Of a category all names, those that no row has included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    labels: Option<Vec<String>>,
}

/// Why a Parquet file was not written or read.
#[derive(Debug, thiserror::Error)]
pub enum ParquetError {
    /// The bytes are not Parquet, or they are damaged.
    #[error("not a readable Parquet file: {0}")]
    Format(#[from] ::parquet::errors::ParquetError),
    /// The bytes are damaged in a way that the `parquet` crate does not survive.
    #[error("the Parquet file is damaged: write it again")]
    Damaged,
    /// What the file says of its columns is not what [`write()`] says.
    #[error("the metadata `columns` of the Parquet file is not a list of columns: {0}")]
    Facts(#[from] serde_json::Error),
    /// A column has a type, or missing values, that no [`ColumnData`] can represent.
    #[error(
        "Parquet column `{column}` is {found}: expected DOUBLE, or INT64, BOOLEAN or text without missing values"
    )]
    Type {
        /// The column.
        column: String,
        /// Its type.
        found: String,
    },
    /// A category is not among the labels the file lists.
    #[error("Parquet column `{column}` has \"{label}\" in row {row}: not among its labels")]
    Label {
        /// The column.
        column: String,
        /// The row, from 0.
        row: usize,
        /// The text that is not a label.
        label: String,
    },
    /// The metadata `table` and `columns` belong to the table.
    #[error("the file metadata `{key}` is taken: choose another name")]
    ReservedKey {
        /// The name.
        key: String,
    },
    /// What was read is not a table.
    #[error(transparent)]
    Table(#[from] TableError),
}

/// The table as the bytes of a Parquet file.
///
/// Columns of a row group are encoded in parallel and put together in their order, so that the bytes do not depend on
/// the number of threads. Numbers lose the digits below their last significant decimal.
///
/// # Errors
/// [`ParquetError::ReservedKey`] for metadata called `table` or `columns`; the `parquet` crate refuses nothing that a
/// [`Table`] can contain.
pub fn write(table: &Table, metadata: &Metadata) -> Result<Vec<u8>, ParquetError> {
    if let Some(key) = metadata
        .keys()
        .find(|key| [TABLE_KEY, COLUMNS_KEY].contains(&key.as_str()))
    {
        return Err(ParquetError::ReservedKey { key: key.clone() });
    }
    let facts: Vec<Facts> = table.columns().iter().map(facts).collect();
    let own = [
        KeyValue::new(TABLE_KEY.to_owned(), table.name().to_owned()),
        KeyValue::new(COLUMNS_KEY.to_owned(), serde_json::to_string(&facts)?),
    ];
    let given = metadata
        .iter()
        .map(|(key, value)| KeyValue::new(key.clone(), value.clone()));
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_statistics_enabled(EnabledStatistics::None)
        .set_created_by(concat!("armill-formats version ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_key_value_metadata(Some(own.into_iter().chain(given).collect()));
    let properties = Arc::new(table.columns().iter().fold(properties, encoded).build());
    let fields = table.columns().iter().map(field).collect::<Result<_, _>>()?;
    let schema = Type::group_type_builder("table").with_fields(fields).build()?;
    let mut file = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::clone(&properties))?;
    for start in (0..table.row_count()).step_by(ROW_GROUP_ROWS) {
        let rows = start..table.row_count().min(start + ROW_GROUP_ROWS);
        let columns = table.columns().par_iter().zip(file.schema_descr().columns());
        let chunks: Vec<(Vec<u8>, ColumnCloseResult)> = columns
            .map(|(column, described)| chunk(column, rows.clone(), described, &properties))
            .collect::<Result<_, _>>()?;
        let mut group = file.next_row_group()?;
        for (bytes, closed) in chunks {
            group.append_column(&Bytes::from(bytes), closed)?;
        }
        group.close()?;
    }
    Ok(file.into_inner()?)
}

/// The values of a column in one row group, encoded.
fn chunk(
    column: &Column,
    rows: Range<usize>,
    described: &ColumnDescPtr,
    properties: &WriterPropertiesPtr,
) -> Result<(Vec<u8>, ColumnCloseResult), ParquetError> {
    let mut sink = TrackedWrite::new(Vec::new());
    let pages = Box::new(SerializedPageWriter::new(&mut sink));
    let mut writer = get_column_writer(Arc::clone(described), Arc::clone(properties), pages);
    write_values(&mut writer, column, rows)?;
    let closed = writer.close()?;
    Ok((sink.into_inner()?, closed))
}

/// Gives the writer of a column the values of these rows; missing ones are marked by a level of 0 in place of a
/// value.
fn write_values(
    writer: &mut ColumnWriter<'_>,
    column: &Column,
    rows: Range<usize>,
) -> Result<(), ParquetError> {
    let kept = kept(column.decimals);
    match (writer, &column.data) {
        (ColumnWriter::DoubleColumnWriter(writer), ColumnData::Float(values)) => {
            let values: Vec<f64> = values[rows].iter().map(|value| kept(*value)).collect();
            writer.write_batch(&values, None, None)?;
        }
        (ColumnWriter::DoubleColumnWriter(writer), ColumnData::OptionalFloat(values)) => {
            let known = values[rows.clone()].iter().flatten();
            let known: Vec<f64> = known.map(|value| kept(*value)).collect();
            writer.write_batch(&known, Some(&levels(&values[rows])), None)?;
        }
        (ColumnWriter::Int64ColumnWriter(writer), ColumnData::Integer(values)) => {
            writer.write_batch(&values[rows], None, None)?;
        }
        (ColumnWriter::Int64ColumnWriter(writer), ColumnData::OptionalInteger(values)) => {
            let known: Vec<i64> = values[rows.clone()].iter().flatten().copied().collect();
            writer.write_batch(&known, Some(&levels(&values[rows])), None)?;
        }
        (ColumnWriter::BoolColumnWriter(writer), ColumnData::Flag(values)) => {
            writer.write_batch(&values[rows], None, None)?;
        }
        (ColumnWriter::ByteArrayColumnWriter(writer), ColumnData::Text(values)) => {
            let texts: Vec<ByteArray> = values[rows].iter().map(|text| bytes_of(text)).collect();
            writer.write_batch(&texts, None, None)?;
        }
        (ColumnWriter::ByteArrayColumnWriter(writer), ColumnData::Category { codes, labels }) => {
            let labels: Vec<ByteArray> = labels.iter().map(|label| bytes_of(label)).collect();
            let texts: Vec<ByteArray> = codes[rows]
                .iter()
                .map(|code| labels[*code as usize].clone())
                .collect();
            writer.write_batch(&texts, None, None)?;
        }
        // The schema is made of the same columns.
        (_, data) => unreachable!("a writer for {data:?}"),
    }
    Ok(())
}

/// The level of each value: 0 where it is missing.
fn levels<T>(values: &[Option<T>]) -> Vec<i16> {
    values.iter().map(|value| i16::from(value.is_some())).collect()
}

/// A text as the crate takes it.
fn bytes_of(text: &str) -> ByteArray {
    ByteArray::from(Bytes::copy_from_slice(text.as_bytes()))
}

/// How many rows are examined to decide whether a dictionary of numbers saves space, and how many may differ.
const LOOKED_AT: usize = 512;
/// So many different numbers, or fewer, are written by a dictionary.
const FEW: usize = 128;

/// The properties with the encoding that suits a column.
///
/// Decided over the whole column, not the row group, by looking at rows that are equally far apart. Other kinds keep
/// the dictionary that the crate makes.
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

/// What the metadata says of a column.
fn facts(column: &Column) -> Facts {
    Facts {
        name: column.name.clone(),
        unit: column.unit.clone(),
        description: column.description.clone(),
        decimals: column.decimals,
        labels: match &column.data {
            ColumnData::Category { labels, .. } => Some(labels.clone()),
            _ => None,
        },
    }
}

/// The column of the schema.
fn field(column: &Column) -> Result<TypePtr, ParquetError> {
    let (kind, repetition) = match &column.data {
        ColumnData::Float(_) => (PhysicalType::DOUBLE, Repetition::REQUIRED),
        ColumnData::OptionalFloat(_) => (PhysicalType::DOUBLE, Repetition::OPTIONAL),
        ColumnData::Integer(_) => (PhysicalType::INT64, Repetition::REQUIRED),
        ColumnData::OptionalInteger(_) => (PhysicalType::INT64, Repetition::OPTIONAL),
        ColumnData::Flag(_) => (PhysicalType::BOOLEAN, Repetition::REQUIRED),
        ColumnData::Text(_) | ColumnData::Category { .. } => (PhysicalType::BYTE_ARRAY, Repetition::REQUIRED),
    };
    let text = (kind == PhysicalType::BYTE_ARRAY).then_some(LogicalType::String);
    let field = Type::primitive_type_builder(&column.name, kind)
        .with_repetition(repetition)
        .with_logical_type(text);
    Ok(Arc::new(field.build()?))
}

/// Rounds a number with this number of significant decimals: to multiples of the largest power of two that is not
/// above the last decimal.
///
/// A number is off by half a step at most. Not rounded are numbers of columns that do not specify decimals, or specify
/// 12 or more, and numbers so large that hardly any of their digits is below the step.
fn kept(decimals: Option<u8>) -> impl Fn(f64) -> f64 {
    // Adding a number whose last bit equals the step rounds to it; subtracting it again is exact.
    let large = decimals.filter(|decimals| *decimals < 12).map(|decimals| {
        let step = 2_f64.powi(-(f64::from(decimals) * std::f64::consts::LOG2_10).ceil() as i32);
        1.5 * step / f64::EPSILON
    });
    move |value| match large {
        Some(large) if value.abs() < large * 0.25 => (value + large) - large,
        _ => value,
    }
}

/// The table in the bytes of a Parquet file, and the file's metadata.
///
/// # Errors
/// Bytes that are not Parquet, columns of other types than [`write()`] makes, and what [`Table::new`] refuses.
///
/// Not checked: damage that leaves a readable file; Parquet as written here has no checksums. A panic inside the
/// `parquet` crate is caught and reported as [`ParquetError::Damaged`], but the panic hook of the program is called.
pub fn read(bytes: &[u8]) -> Result<(Table, Metadata), ParquetError> {
    // The parquet crate (60.1) panics on some damaged pages. Nothing outlives the closure, so nothing is left half
    // done.
    std::panic::catch_unwind(|| read_trusting(bytes)).unwrap_or(Err(ParquetError::Damaged))
}

/// The content of the file, if the crate does not panic; a column without metadata has no unit.
fn read_trusting(bytes: &[u8]) -> Result<(Table, Metadata), ParquetError> {
    let file = SerializedFileReader::new(Bytes::copy_from_slice(bytes))?;
    let described = file.metadata().file_metadata();
    let pairs = described.key_value_metadata().cloned().unwrap_or_default();
    let mut metadata: Metadata = pairs
        .into_iter()
        .map(|pair| (pair.key, pair.value.unwrap_or_default()))
        .collect();
    let name = metadata.remove(TABLE_KEY).unwrap_or_default();
    let facts: Vec<Facts> = match metadata.remove(COLUMNS_KEY) {
        Some(text) => serde_json::from_str(&text)?,
        None => Vec::new(),
    };
    let column = |(index, described): (usize, &ColumnDescPtr)| {
        let known = facts.iter().find(|known| known.name == described.name());
        read_column(&file, index, described, known.cloned().unwrap_or_default())
    };
    let columns = described.schema_descr().columns();
    let columns = columns.iter().enumerate().map(column).collect::<Result<_, _>>()?;
    Ok((Table::new(name, columns)?, metadata))
}

/// Column `index` in all row groups.
///
/// # Errors
/// Another type than [`write()`] makes, values that are missing where none may be, texts that are not labels.
fn read_column(
    file: &SerializedFileReader<Bytes>,
    index: usize,
    described: &ColumnDescPtr,
    facts: Facts,
) -> Result<Column, ParquetError> {
    let is_text = described.logical_type_ref() == Some(&LogicalType::String);
    let mut values = match described.physical_type() {
        PhysicalType::DOUBLE => Values::Float(Vec::new()),
        PhysicalType::INT64 => Values::Integer(Vec::new()),
        PhysicalType::BOOLEAN => Values::Flag(Vec::new()),
        PhysicalType::BYTE_ARRAY if is_text => Values::Text(Vec::new()),
        other => return Err(unfit(described, other.to_string())),
    };
    let mut levels: Vec<i16> = Vec::new();
    for group in 0..file.num_row_groups() {
        let group = file.get_row_group(group)?;
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        values.read(group.get_column_reader(index)?, rows, &mut levels)?;
    }
    let optional = described.max_def_level() > 0;
    let missing = optional && levels.contains(&0);
    let data = match values {
        Values::Float(values) if optional => ColumnData::OptionalFloat(at_levels(values, &levels)),
        Values::Float(values) => ColumnData::Float(values),
        Values::Integer(values) if optional => ColumnData::OptionalInteger(at_levels(values, &levels)),
        _ if missing => {
            let kind = described.physical_type();
            return Err(unfit(described, format!("{kind} with missing values")));
        }
        Values::Integer(values) => ColumnData::Integer(values),
        Values::Flag(values) => ColumnData::Flag(values),
        Values::Text(texts) => {
            let text = |bytes: &ByteArray| Ok(bytes.as_utf8()?.to_owned());
            let texts = texts
                .iter()
                .map(text)
                .collect::<Result<Vec<String>, ParquetError>>()?;
            match facts.labels {
                Some(labels) => category(described.name(), &texts, labels)?,
                None => ColumnData::Text(texts),
            }
        }
    };
    Ok(Column {
        name: described.name().to_owned(),
        unit: facts.unit,
        description: facts.description,
        decimals: facts.decimals,
        data,
    })
}

/// The values with those that are missing; `levels` has one for each.
fn at_levels<T>(values: Vec<T>, levels: &[i16]) -> Vec<Option<T>> {
    let mut known = values.into_iter();
    let value = |level: &i16| (*level > 0).then(|| known.next()).flatten();
    levels.iter().map(value).collect()
}

/// A column of another type than expected.
fn unfit(described: &ColumnDescPtr, found: String) -> ParquetError {
    ParquetError::Type {
        column: described.name().to_owned(),
        found,
    }
}

/// Values of a column that are there.
enum Values {
    Float(Vec<f64>),
    Integer(Vec<i64>),
    Flag(Vec<bool>),
    Text(Vec<ByteArray>),
}

impl Values {
    /// Adds those of a row group of so many rows; `levels` says which rows have one.
    fn read(&mut self, reader: ColumnReader, rows: usize, levels: &mut Vec<i16>) -> Result<(), ParquetError> {
        let levels = Some(levels);
        let (records, ..) = match (self, reader) {
            (Values::Float(values), ColumnReader::DoubleColumnReader(mut reader)) => {
                reader.read_records(rows, levels, None, values)?
            }
            (Values::Integer(values), ColumnReader::Int64ColumnReader(mut reader)) => {
                reader.read_records(rows, levels, None, values)?
            }
            (Values::Flag(values), ColumnReader::BoolColumnReader(mut reader)) => {
                reader.read_records(rows, levels, None, values)?
            }
            (Values::Text(values), ColumnReader::ByteArrayColumnReader(mut reader)) => {
                reader.read_records(rows, levels, None, values)?
            }
            _ => return Err(ParquetError::Damaged),
        };
        if records == rows {
            Ok(())
        } else {
            Err(ParquetError::Damaged)
        }
    }
}

/// The texts of a column by their index among its labels.
///
/// # Errors
/// The first text that is none of them.
fn category(column: &str, texts: &[String], labels: Vec<String>) -> Result<ColumnData, ParquetError> {
    let code = |(row, text): (usize, &String)| {
        let code = labels
            .iter()
            .position(|label| label == text)
            .and_then(|code| u32::try_from(code).ok());
        code.ok_or_else(|| ParquetError::Label {
            column: column.to_owned(),
            row,
            label: text.clone(),
        })
    };
    let codes = texts.iter().enumerate().map(code).collect::<Result<_, _>>()?;
    Ok(ColumnData::Category { codes, labels })
}

#[cfg(test)]
mod tests;
