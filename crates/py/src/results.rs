//! Results as numpy has them: arrays that are kept, arrays of the caller, and words.

use std::fmt::Display;

use numpy::{
    Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyReadwriteArrayDyn, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::array;
use crate::errors::{refused, wrong_type};

/// Results with more numbers than these are allocated by numpy, which raises `MemoryError` where there is no room.
const SMALL: usize = 1 << 16;

/// Where a result is written: into a new array, or into `out` of the caller.
pub(crate) enum Output<'py> {
    /// Numbers that become an array.
    Made(Vec<f64>),
    /// An array that exists.
    Array(Bound<'py, PyArrayDyn<f64>>, PyReadwriteArrayDyn<'py, f64>),
}

impl<'py> Output<'py> {
    /// Room for a result of this shape.
    ///
    /// # Errors
    /// A result that is too large; an `out` of another type or shape, read-only, or with the memory of an input.
    pub(crate) fn of(
        py: Python<'py>,
        out: Option<&Bound<'py, PyAny>>,
        shape: &[usize],
    ) -> PyResult<Output<'py>> {
        let Some(out) = out else {
            let count = shape
                .iter()
                .try_fold(1_usize, |count, length| count.checked_mul(*length));
            let Some(count) = count else {
                let message = format!("a result of shape {shape:?} is too large");
                return Err(refused(py, message, "evaluate it in parts"));
            };
            if count <= SMALL {
                return Ok(Output::Made(vec![0.0; count]));
            }
            let made = py.import("numpy")?.call_method1("zeros", (shape.to_vec(),))?;
            return Output::into_array(made.cast_into::<PyArrayDyn<f64>>()?);
        };
        let lengths: Vec<String> = shape.iter().map(usize::to_string).collect();
        let expected = format!(
            "a contiguous array of float64 with the shape ({})",
            lengths.join(", ")
        );
        let array = out.cast::<PyArrayDyn<f64>>().map_err(|_| {
            let kind = out
                .get_type()
                .name()
                .map_or_else(|_| "?".to_owned(), |name| name.to_string());
            wrong_type(format!("out: expected {expected}, given {kind} of another type"))
        })?;
        if array.shape() != shape || !array.is_c_contiguous() || !array.is_aligned() {
            let message = format!("out: expected {expected}, given the shape {:?}", array.shape());
            return Err(refused(py, message, "make it with `numpy.empty`"));
        }
        Output::into_array(array.clone()).map_err(|error| {
            let message = format!("out: cannot be written: {error}");
            refused(
                py,
                message,
                "give a writable array that shares no memory with an input",
            )
        })
    }

    fn into_array(array: Bound<'py, PyArrayDyn<f64>>) -> PyResult<Output<'py>> {
        let open = array.try_readwrite()?;
        Ok(Output::Array(array, open))
    }

    /// The numbers to write.
    ///
    /// # Errors
    /// None for an array that `of` has checked.
    pub(crate) fn numbers(&mut self) -> PyResult<&mut [f64]> {
        match self {
            Output::Made(numbers) => Ok(numbers),
            Output::Array(_, open) => Ok(open.as_slice_mut()?),
        }
    }

    /// The array.
    ///
    /// # Errors
    /// Numbers that do not fit the shape, which would be a fault of armill.
    pub(crate) fn array(self, py: Python<'py>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        match self {
            Output::Made(numbers) => array(py, shape, numbers),
            Output::Array(array, _) => Ok(array),
        }
    }
}

/// An array that a result keeps; every getter gives a copy.
#[derive(Clone, Debug)]
pub(crate) struct Stored<T> {
    /// The length of each axis.
    pub shape: Vec<usize>,
    /// The values, the last axis fastest.
    pub values: Vec<T>,
}

impl<T: Element + Clone> Stored<T> {
    /// An array of this shape.
    pub(crate) fn new(shape: Vec<usize>, values: Vec<T>) -> Stored<T> {
        Stored { shape, values }
    }

    /// Of an array of numpy.
    pub(crate) fn of(array: &PyReadonlyArrayDyn<'_, T>) -> Stored<T> {
        Stored {
            shape: array.shape().to_vec(),
            values: array.as_array().iter().cloned().collect(),
        }
    }

    /// As an array of numpy.
    pub(crate) fn array<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
        array(py, &self.shape, self.values.clone())
    }
}

/// A word for some of many items: as the core has it, or as a pickle has it.
pub(crate) enum Words<T> {
    /// Of a calculation.
    Found(Vec<Option<T>>),
    /// Of a pickle.
    Read(Vec<Option<String>>),
}

impl<T: Display> Words<T> {
    /// The word of item `i`.
    pub(crate) fn get(&self, i: usize) -> Option<String> {
        match self {
            Words::Found(words) => words.get(i)?.as_ref().map(ToString::to_string),
            Words::Read(words) => words.get(i)?.clone(),
        }
    }

    /// The words of all items; `None` where there is none.
    pub(crate) fn all(&self) -> Vec<Option<String>> {
        match self {
            Words::Found(words) => words
                .iter()
                .map(|word| word.as_ref().map(ToString::to_string))
                .collect(),
            Words::Read(words) => words.clone(),
        }
    }

    /// The words of all items; empty where there is none.
    pub(crate) fn texts(&self) -> Vec<String> {
        self.all().into_iter().map(Option::unwrap_or_default).collect()
    }
}

/// The position of an item along these axes: its index, from the end if negative, or one index for each axis.
///
/// # Errors
/// An item that does not exist; anything but integers.
pub(crate) fn item_of(axes: &[usize], index: &Bound<'_, PyAny>) -> PyResult<usize> {
    let count: usize = axes.iter().product();
    let Ok(indices) = index.cast::<PyTuple>() else {
        return index_of(index.extract()?, count);
    };
    if indices.len() != axes.len() {
        let message = format!("{} indices for {} axes", indices.len(), axes.len());
        return Err(PyIndexError::new_err(message));
    }
    let mut item = 0;
    for (length, index) in axes.iter().zip(indices) {
        item = item * length + index_of(index.extract()?, *length)?;
    }
    Ok(item)
}

fn index_of(index: isize, count: usize) -> PyResult<usize> {
    let from_begin = if index < 0 { index + count as isize } else { index };
    usize::try_from(from_begin)
        .ok()
        .filter(|index| *index < count)
        .ok_or_else(|| PyIndexError::new_err(format!("pose {index} does not exist: there are {count} poses")))
}
