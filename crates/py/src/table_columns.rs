//! Columns of a table: from results to Arrow, from Arrow to numpy and lists, and the parts that a pickle keeps.

use std::sync::Arc;

use armill_formats::table::ColumnData;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type, UInt32Type};
use arrow_array::{
    Array, ArrayRef, BooleanArray, DictionaryArray, Float64Array, Int64Array, StringArray, UInt32Array,
};
use arrow_schema::{ArrowError, DataType};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::errors::Fault;

/// A column as Arrow has it.
///
/// # Errors
/// Categories that Arrow refuses.
pub(crate) fn array_of(data: ColumnData) -> Result<ArrayRef, ArrowError> {
    Ok(match data {
        ColumnData::Float(values) => Arc::new(Float64Array::from(values)),
        ColumnData::OptionalFloat(values) => Arc::new(Float64Array::from(values)),
        ColumnData::Integer(values) => Arc::new(Int64Array::from(values)),
        ColumnData::OptionalInteger(values) => Arc::new(Int64Array::from(values)),
        ColumnData::Flag(values) => Arc::new(BooleanArray::from(values)),
        ColumnData::Text(values) => Arc::new(StringArray::from(values)),
        ColumnData::Category { codes, labels } => {
            let labels = Arc::new(StringArray::from(labels));
            let codes = UInt32Array::from(codes);
            Arc::new(DictionaryArray::<UInt32Type>::try_new(codes, labels)?)
        }
    })
}

/// The exception of a column that Arrow refuses.
pub(crate) fn broken(error: ArrowError) -> PyErr {
    Fault::new_err(format!("a fault of armill, please report it: {error}"))
}

/// The exception of a column of a kind that no table has.
fn unknown(column: &ArrayRef) -> PyErr {
    Fault::new_err(format!(
        "a fault of armill, please report it: a column of {}",
        column.data_type()
    ))
}

/// Numbers with missing ones.
fn floats(column: &ArrayRef) -> Option<Vec<Option<f64>>> {
    Some(column.as_primitive_opt::<Float64Type>()?.iter().collect())
}

/// Integers with missing ones.
fn integers(column: &ArrayRef) -> Option<Vec<Option<i64>>> {
    Some(column.as_primitive_opt::<Int64Type>()?.iter().collect())
}

/// Flags.
fn flags(column: &ArrayRef) -> Option<Vec<bool>> {
    let flags = column.as_boolean_opt()?;
    Some(flags.iter().map(Option::unwrap_or_default).collect())
}

/// Texts, of categories too.
fn texts(column: &ArrayRef) -> Option<Vec<String>> {
    let owned = |text: Option<&str>| text.unwrap_or_default().to_owned();
    if let Some(texts) = column.as_string_opt::<i32>() {
        return Some(texts.iter().map(owned).collect());
    }
    let categories = column.as_dictionary_opt::<UInt32Type>()?;
    let labels = categories.values().as_string_opt::<i32>()?;
    let label = |code: Option<u32>| {
        let code = code.map(|code| code as usize).filter(|code| *code < labels.len());
        owned(code.map(|code| labels.value(code)))
    };
    Some(categories.keys().iter().map(label).collect())
}

/// A column as an array of numpy: NaN for missing floats, a masked array for missing integers.
///
/// # Errors
/// A column of a kind that no table has.
pub(crate) fn as_numpy<'py>(py: Python<'py>, column: &ArrayRef) -> PyResult<Bound<'py, PyAny>> {
    if let Some(values) = floats(column) {
        let values = values.into_iter().map(|value| value.unwrap_or(f64::NAN));
        return Ok(PyArray1::from_iter(py, values).into_any());
    }
    if let Some(values) = integers(column) {
        let numbers = values.iter().map(|value| value.unwrap_or_default());
        let numbers = PyArray1::from_iter(py, numbers).into_any();
        if column.null_count() == 0 {
            return Ok(numbers);
        }
        let options = PyDict::new(py);
        let mask = values.iter().map(Option::is_none);
        options.set_item("mask", PyArray1::from_iter(py, mask))?;
        let masked = py.import("numpy")?.getattr("ma")?;
        return masked.call_method("masked_array", (numbers,), Some(&options));
    }
    if let Some(values) = flags(column) {
        return Ok(PyArray1::from_vec(py, values).into_any());
    }
    let texts = texts(column).ok_or_else(|| unknown(column))?;
    py.import("numpy")?.call_method1("array", (texts, "str"))
}

/// A column as a list; None where a value is missing.
///
/// # Errors
/// A column of a kind that no table has.
pub(crate) fn as_list<'py>(py: Python<'py>, column: &ArrayRef) -> PyResult<Bound<'py, PyList>> {
    if let Some(values) = floats(column) {
        return PyList::new(py, values);
    }
    if let Some(values) = integers(column) {
        return PyList::new(py, values);
    }
    if let Some(values) = flags(column) {
        return PyList::new(py, values);
    }
    PyList::new(py, texts(column).ok_or_else(|| unknown(column))?)
}

/// A column in a pickle: its kind, its values (the codes of categories), the labels of categories.
pub(crate) type StoredColumn<'py> = (String, Bound<'py, PyList>, Vec<String>);

/// The parts of a column that a pickle keeps.
///
/// # Errors
/// A column of a kind that no table has.
pub(crate) fn stored<'py>(py: Python<'py>, column: &ArrayRef) -> PyResult<StoredColumn<'py>> {
    let kind = match column.data_type() {
        DataType::Float64 => "float",
        DataType::Int64 => "integer",
        DataType::Boolean => "flag",
        DataType::Utf8 => "text",
        _ => {
            let categories = column.as_dictionary_opt::<UInt32Type>();
            let categories = categories.ok_or_else(|| unknown(column))?;
            let labels = texts(categories.values()).ok_or_else(|| unknown(column))?;
            let codes = PyList::new(py, categories.keys().values().to_vec())?;
            return Ok(("category".to_owned(), codes, labels));
        }
    };
    Ok((kind.to_owned(), as_list(py, column)?, Vec::new()))
}

/// The column of these parts.
///
/// # Errors
/// Parts of another version.
pub(crate) fn read(column: StoredColumn<'_>) -> PyResult<ArrayRef> {
    let (kind, values, labels) = column;
    let data = match &*kind {
        "float" => ColumnData::OptionalFloat(values.extract()?),
        "integer" => ColumnData::OptionalInteger(values.extract()?),
        "flag" => ColumnData::Flag(values.extract()?),
        "text" => ColumnData::Text(values.extract()?),
        _ => ColumnData::Category {
            codes: values.extract()?,
            labels,
        },
    };
    array_of(data).map_err(broken)
}
