//! The class `Table`: columns with units, handed over as Arrow without a copy.
//!
//! Every package with the PyCapsule interface of Arrow reads it: pandas, polars, pyarrow, duckdb. Units and descriptions
//! are in the metadata of the fields (`unit`, `description`).

use std::collections::HashMap;
use std::ffi::CStr;
use std::sync::Arc;

use armill_formats::table::{Column, ColumnData, Table as Values};
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::UInt32Type;
use arrow_array::{
    ArrayRef, BooleanArray, DictionaryArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator,
    RecordBatchReader, StringArray, UInt32Array,
};
use arrow_schema::ffi::FFI_ArrowSchema;
use arrow_schema::{ArrowError, Field, Schema};
use pyo3::prelude::*;
use pyo3::types::PyCapsule;

use crate::errors::Fault;

/// Names of the capsules in the interface of Arrow.
const SCHEMA: &CStr = c"arrow_schema";
const STREAM: &CStr = c"arrow_array_stream";

/// Columns of equal length, each with its unit in its name; read by `pandas.DataFrame.from_arrow`, `polars.DataFrame`,
/// `pyarrow.table`.
#[pyclass(frozen, module = "armill")]
pub(crate) struct Table {
    name: String,
    rows: RecordBatch,
}

impl Table {
    /// The same columns in the layout of Arrow.
    ///
    /// # Errors
    /// Columns that Arrow refuses, which would be a fault of armill.
    pub(crate) fn of(values: Values) -> PyResult<Table> {
        let name = values.name().to_owned();
        let columns = values.into_columns();
        let mut fields = Vec::with_capacity(columns.len());
        let mut arrays: Vec<ArrayRef> = Vec::with_capacity(columns.len());
        for Column {
            name,
            unit,
            description,
            decimals,
            data,
        } in columns
        {
            // Counts, and numbers of load cases and lines.
            let is_integer = unit.is_none() && decimals == Some(0);
            let array = array_of(data, is_integer).map_err(broken)?;
            let given = [("description", Some(description)), ("unit", unit)];
            let given = given
                .into_iter()
                .filter_map(|(key, value)| Some((key.to_owned(), value?)));
            let field = Field::new(name, array.data_type().clone(), array.null_count() > 0);
            fields.push(field.with_metadata(given.collect::<HashMap<_, _>>()));
            arrays.push(array);
        }
        let rows = RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays);
        Ok(Table {
            name,
            rows: rows.map_err(broken)?,
        })
    }
}

fn array_of(data: ColumnData, is_integer: bool) -> Result<ArrayRef, ArrowError> {
    Ok(match data {
        ColumnData::Float(values) if is_integer => {
            let integers: Vec<i64> = values.into_iter().map(|value| value as i64).collect();
            Arc::new(Int64Array::from(integers))
        }
        ColumnData::OptionalFloat(values) if is_integer => {
            let integers = values.into_iter().map(|value| value.map(|value| value as i64));
            Arc::new(Int64Array::from(integers.collect::<Vec<Option<i64>>>()))
        }
        ColumnData::Float(values) => Arc::new(Float64Array::from(values)),
        ColumnData::OptionalFloat(values) => Arc::new(Float64Array::from(values)),
        ColumnData::Integer(values) => Arc::new(Int64Array::from(values)),
        ColumnData::Flag(values) => Arc::new(BooleanArray::from(values)),
        ColumnData::Text(values) => Arc::new(StringArray::from(values)),
        ColumnData::Category { codes, labels } => {
            let labels = Arc::new(StringArray::from(labels));
            Arc::new(DictionaryArray::<UInt32Type>::try_new(
                UInt32Array::from(codes),
                labels,
            )?)
        }
    })
}

fn broken(error: ArrowError) -> PyErr {
    Fault::new_err(format!("a fault of armill, please report it: {error}"))
}

#[pymethods]
impl Table {
    /// -> str: name of the table.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// -> list of str: the names of its columns, each ending in its unit.
    #[getter]
    fn columns(&self) -> Vec<String> {
        let schema = self.rows.schema();
        schema.fields().iter().map(|field| field.name().clone()).collect()
    }

    /// -> int: number of rows.
    fn __len__(&self) -> usize {
        self.rows.num_rows()
    }

    /// -> PyCapsule: the columns and their types, as an Arrow schema.
    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let schema = FFI_ArrowSchema::try_from(self.rows.schema().as_ref()).map_err(broken)?;
        PyCapsule::new_with_value(py, schema, SCHEMA)
    }

    /// -> PyCapsule: the rows, as an Arrow stream; `requested_schema` is ignored, which the interface permits.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let _ = requested_schema;
        let rows = RecordBatchIterator::new([Ok(self.rows.clone())], self.rows.schema());
        let reader: Box<dyn RecordBatchReader + Send> = Box::new(rows);
        PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(reader), STREAM)
    }

    fn __repr__(&self) -> String {
        format!(
            "<armill.Table {}: {} rows, {} columns>",
            self.name,
            self.rows.num_rows(),
            self.rows.num_columns()
        )
    }
}
