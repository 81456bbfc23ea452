//! The class `Table`: columns with units, as Arrow without a copy, as arrays of numpy, or row by row.
//!
//! Every package with the PyCapsule interface of Arrow reads it: pandas, polars, pyarrow, duckdb. Units and descriptions
//! are in the metadata of the fields (`unit`, `description`).

use std::collections::HashMap;
use std::ffi::CStr;
use std::sync::Arc;

use armill_formats::table::Table as Values;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{Array, ArrayRef, RecordBatch, RecordBatchIterator, RecordBatchReader};
use arrow_schema::ffi::FFI_ArrowSchema;
use arrow_schema::{DataType, Field, Schema};
use pyo3::exceptions::{PyKeyError, PyModuleNotFoundError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyIterator, PyList};

use crate::containers::helper;
use crate::html;
use crate::table_columns::{self, StoredColumn, array_of, broken};

/// Names of the capsules in the interface of Arrow.
const SCHEMA: &CStr = c"arrow_schema";
const STREAM: &CStr = c"arrow_array_stream";

/// Columns of equal length, each with its unit in its name; read by `pandas.DataFrame`, `polars.DataFrame`, `pyarrow.table`.
///
/// `table["x_mm"]` is a column, `table.to_pandas()` a data frame; iteration gives each row as a dict.
#[pyclass(frozen, module = "armill")]
#[derive(Clone)]
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
        for column in columns {
            let array = array_of(column.data).map_err(broken)?;
            let metadata = [("description", Some(column.description)), ("unit", column.unit)];
            let metadata = metadata
                .into_iter()
                .filter_map(|(key, value)| Some((key.to_owned(), value?)));
            fields.push(field_of(column.name, &array, metadata.collect()));
            arrays.push(array);
        }
        Table::of_arrays(name, fields, arrays)
    }

    /// Columns with their fields.
    fn of_arrays(name: String, fields: Vec<Field>, arrays: Vec<ArrayRef>) -> PyResult<Table> {
        let rows = RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays);
        Ok(Table {
            name,
            rows: rows.map_err(broken)?,
        })
    }
}

/// The field of a column.
fn field_of(name: String, array: &ArrayRef, metadata: HashMap<String, String>) -> Field {
    Field::new(name, array.data_type().clone(), array.null_count() > 0).with_metadata(metadata)
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

    /// -> dict of str to str: the unit of each column that has one, such as `um`.
    #[getter]
    fn units(&self) -> HashMap<String, String> {
        self.metadata("unit")
    }

    /// -> dict of str to str: the meaning of each column.
    #[getter]
    fn descriptions(&self) -> HashMap<String, String> {
        self.metadata("description")
    }

    /// -> dict: every column by name, as an array.
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        helper(slf.as_any(), "to_dict", None)
    }

    /// -> xarray.Dataset: every column over `row`, with `units` and `long_name`. Needs xarray.
    ///
    /// `dims` is another name of the axis.
    #[pyo3(signature = (dims=None))]
    fn to_xarray<'py>(slf: &Bound<'py, Self>, dims: Option<Vec<String>>) -> PyResult<Bound<'py, PyAny>> {
        helper(slf.as_any(), "to_xarray", dims)
    }

    /// Whether name, columns and rows are equal.
    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let other = other.cast::<Table>();
        other.is_ok_and(|other| other.get().name == self.name && other.get().rows == self.rows)
    }

    fn __hash__(&self) -> usize {
        self.rows.num_rows()
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

    /// column name -> (rows,) array: floats with NaN where a value is missing, integers masked there, bool, or str.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let Some(column) = self.rows.column_by_name(name) else {
            let message = format!(
                "the table has no column `{name}`: it has {}",
                self.columns().join(", ")
            );
            return Err(PyKeyError::new_err(message));
        };
        table_columns::as_numpy(py, column)
    }

    /// -> iterator of dict: each row by column name; None where a value is missing.
    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        let names = self.columns();
        let columns = self.rows.columns().iter();
        let columns: Vec<_> = columns
            .map(|column| table_columns::as_list(py, column))
            .collect::<PyResult<_>>()?;
        let rows = PyList::empty(py);
        for row in 0..self.rows.num_rows() {
            let values = PyDict::new(py);
            for (name, column) in names.iter().zip(&columns) {
                values.set_item(name, column.get_item(row)?)?;
            }
            rows.append(values)?;
        }
        rows.try_iter()
    }

    /// -> pandas.DataFrame: the columns; integers with missing values as `Int64`. Needs pandas and pyarrow.
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let missing = |error: PyErr| {
            let message = format!("{}: pip install pandas pyarrow", error.value(py));
            PyModuleNotFoundError::new_err(message)
        };
        let pandas = py.import("pandas").map_err(missing)?;
        let arrow = py.import("pyarrow").map_err(missing)?;
        let frame = arrow.call_method1("table", (slf,))?.call_method0("to_pandas")?;
        let own = slf.get();
        for (name, column) in own.columns().iter().zip(own.rows.columns()) {
            if *column.data_type() == DataType::Int64 && column.null_count() > 0 {
                let values = table_columns::as_list(py, column)?;
                let options = PyDict::new(py);
                options.set_item("dtype", "Int64")?;
                frame.set_item(name, pandas.call_method("array", (values,), Some(&options))?)?;
            }
        }
        Ok(frame)
    }

    fn __repr__(&self) -> String {
        format!(
            "<armill.Table {}: {} rows, {} columns>",
            self.name,
            self.rows.num_rows(),
            self.rows.num_columns()
        )
    }

    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        let rows = self.rows.slice(0, self.rows.num_rows().min(SHOWN));
        let columns = rows.columns().iter();
        let columns: Vec<_> = columns
            .map(|column| table_columns::as_list(py, column))
            .collect::<PyResult<_>>()?;
        let cell = |column: &Bound<'_, PyList>, row| -> PyResult<String> {
            let value = column.get_item(row)?;
            Ok(if value.is_none() {
                String::new()
            } else {
                value.str()?.to_string()
            })
        };
        let shown = (0..rows.num_rows())
            .map(|row| columns.iter().map(|column| cell(column, row)).collect())
            .collect::<PyResult<Vec<Vec<String>>>>()?;
        let caption = format!("{}: {} rows", self.name, self.rows.num_rows());
        Ok(html::table(&caption, &self.columns(), shown))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, TableParts<'py>)> {
        let (py, own) = (slf.py(), slf.get());
        let schema = own.rows.schema();
        let columns = schema.fields().iter().zip(own.rows.columns());
        let columns = columns.map(|(field, column)| {
            let stored = table_columns::stored(py, column)?;
            let metadata = field.metadata().iter();
            let metadata = metadata.map(|(key, value)| (key.clone(), value.clone()));
            Ok((field.name().clone(), metadata.collect(), stored))
        });
        let columns = columns.collect::<PyResult<Vec<_>>>()?;
        Ok((slf.get_type().getattr("_again")?, (own.name.clone(), columns)))
    }

    #[staticmethod]
    fn _again(name: String, columns: Vec<ColumnParts<'_>>) -> PyResult<Table> {
        let (mut fields, mut arrays) = (Vec::new(), Vec::new());
        for (name, metadata, stored) in columns {
            let array = table_columns::read(stored)?;
            fields.push(field_of(name, &array, metadata));
            arrays.push(array);
        }
        Table::of_arrays(name, fields, arrays)
    }
}

impl Table {
    /// What the fields say of this key.
    fn metadata(&self, key: &str) -> HashMap<String, String> {
        let schema = self.rows.schema();
        let fields = schema.fields().iter();
        fields
            .filter_map(|field| Some((field.name().clone(), field.metadata().get(key)?.clone())))
            .collect()
    }
}

/// Rows that a notebook shows.
const SHOWN: usize = 10;

/// Name, description and unit, values of a column in a pickle.
type ColumnParts<'py> = (String, HashMap<String, String>, StoredColumn<'py>);
/// Name and columns of a table in a pickle.
type TableParts<'py> = (String, Vec<ColumnParts<'py>>);
