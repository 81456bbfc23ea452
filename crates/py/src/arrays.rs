//! Arrays in and out: numbers of numpy as a slice of `f64`, and vectors as arrays of numpy.
//!
//! An array of `float64` that lies in one piece is borrowed; any other array of real numbers is copied, whatever its
//! strides, order, alignment or size of numbers. Lists of numbers are arrays too. Everything else is refused with the
//! shape that is wanted and the one that was given.

use std::fmt::{self, Display};

use numpy::ndarray::{ArrayD, IxDyn};
use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::errors::{Fault, refused, wrong_type};

/// Numbers that were given.
pub(crate) struct Given<'py> {
    numbers: PyReadonlyArrayDyn<'py, f64>,
}

impl<'py> Given<'py> {
    /// The numbers of `value`, in one piece. `wanted` tells the shape, in words.
    pub(crate) fn of(value: &Bound<'py, PyAny>, name: &str, requested: &dyn Display) -> PyResult<Given<'py>> {
        let fits = |array: &Bound<'py, PyArrayDyn<f64>>| array.is_c_contiguous() && array.is_aligned();
        let array = match value.cast::<PyArrayDyn<f64>>() {
            Ok(array) if fits(array) => array.clone(),
            _ => copied(value, name, requested)?,
        };
        Ok(Given {
            numbers: array.try_readonly().map_err(PyErr::from)?,
        })
    }

    /// How many there are along each axis.
    pub(crate) fn shape(&self) -> &[usize] {
        self.numbers.shape()
    }

    /// The numbers, the last axis fastest.
    pub(crate) fn values(&self) -> &[f64] {
        // `of` took nothing that is not in one piece.
        self.numbers.as_slice().unwrap_or_default()
    }

    /// Refuses numbers that are not finite.
    ///
    /// # Errors
    /// The first of them, with its index.
    pub(crate) fn finite(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        let Some(at) = self.values().iter().position(|value| !value.is_finite()) else {
            return Ok(());
        };
        let (mut rest, mut index) = (at, Vec::new());
        for length in self.shape().iter().rev() {
            index.insert(0, (rest % length).to_string());
            rest /= length;
        }
        let value = self.values()[at];
        Err(refused(
            py,
            format!("{name}[{}] is {value}", index.join(", ")),
            "numbers must be finite",
        ))
    }
}

/// A copy as `float64` in one piece.
fn copied<'py>(
    value: &Bound<'py, PyAny>,
    name: &str,
    requested: &dyn Display,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let py = value.py();
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (value,)).map_err(|error| {
        if !error.is_instance_of::<PyValueError>(py) && !error.is_instance_of::<PyTypeError>(py) {
            // Such as an interrupt, which says nothing of the array.
            return error;
        }
        let kind = value
            .get_type()
            .name()
            .map_or_else(|_| "?".to_owned(), |name| name.to_string());
        wrong_type(format!(
            "{name}: expected real numbers of shape {requested}, given a {kind} that is no array ({})",
            error.value(py)
        ))
    })?;
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    if !["f", "i", "u"].contains(&kind.as_str()) {
        let shape = array.getattr("shape")?;
        return Err(wrong_type(format!(
            "{name}: expected real numbers of shape {requested}, given {dtype} of shape {shape}"
        )));
    }
    let whole = numpy.call_method1("require", (array, "float64", ["C", "A"]))?;
    Ok(whole.cast_into::<PyArrayDyn<f64>>()?)
}

/// Many items of one shape, or a single one without the first axis.
pub(crate) struct Batch<'py> {
    /// The numbers.
    pub given: Given<'py>,
    /// How many items.
    pub count: usize,
    /// Whether it is one item without the first axis: so is its answer.
    pub single: bool,
}

impl<'py> Batch<'py> {
    /// The items of `value`, each of the shape `item`.
    ///
    /// # Errors
    /// Another shape; no numbers.
    pub(crate) fn of(value: &Bound<'py, PyAny>, name: &str, item: &[usize]) -> PyResult<Batch<'py>> {
        let requested = ManyOf(item);
        let given = Given::of(value, name, &requested)?;
        let (count, single) = match given.shape() {
            shape if shape == item => (1, true),
            [count, rest @ ..] if rest == item => (*count, false),
            _ => return Err(wrong_shape(value.py(), name, &requested, given.shape())),
        };
        Ok(Batch { given, count, single })
    }

    /// The shape of an answer that has `rest` for each item.
    pub(crate) fn shape(&self, rest: &[usize]) -> Vec<usize> {
        let first = (!self.single).then_some(self.count);
        first.into_iter().chain(rest.iter().copied()).collect()
    }
}

/// `(n, 4, 4) or (4, 4)`: written only where it is told, since one point takes no longer than a few words.
struct ManyOf<'a>(&'a [usize]);

impl Display for ManyOf<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lengths: Vec<String> = self.0.iter().map(usize::to_string).collect();
        let (all, comma) = (lengths.join(", "), if lengths.len() == 1 { "," } else { "" });
        write!(f, "(n, {all}) or ({all}{comma})")
    }
}

/// A shape that is not the one wanted.
pub(crate) fn wrong_shape(py: Python<'_>, name: &str, requested: &dyn Display, given: &[usize]) -> PyErr {
    let lengths: Vec<String> = given.iter().map(usize::to_string).collect();
    let comma = if given.len() == 1 { "," } else { "" };
    let message = format!(
        "{name}: expected shape {requested}, given ({}{comma})",
        lengths.join(", ")
    );
    refused(py, message, "the last axis runs over the numbers of one item")
}

/// An array of numpy that owns `values`.
pub(crate) fn array<'py, T: Element>(
    py: Python<'py>,
    shape: &[usize],
    values: Vec<T>,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let array = ArrayD::from_shape_vec(IxDyn(shape), values);
    let array = array.map_err(|error| Fault::new_err(format!("an answer of another shape: {error}")))?;
    Ok(PyArrayDyn::from_owned_array(py, array))
}

/// A copy of `values`, which stay.
pub(crate) fn array_of<'py, T: Element + Clone>(
    py: Python<'py>,
    shape: &[usize],
    values: &[T],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    array(py, shape, values.to_vec())
}
