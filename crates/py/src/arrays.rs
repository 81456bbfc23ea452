//! Arrays in and out: numbers of numpy as a slice of `f64`, and vectors as arrays of numpy.
//!
//! A contiguous array of `float64` is borrowed. Any other array of real numbers is copied, whatever its strides, order,
//! alignment or type of numbers. Lists of numbers are accepted as arrays. Masked arrays are accepted if no value is
//! masked. Everything else is refused with the expected and the given shape.

use std::fmt::{self, Display};

use numpy::ndarray::{ArrayD, IxDyn};
use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::errors::{Fault, refused, wrong_type};

/// Numbers given by the caller.
pub(crate) struct Given<'py> {
    numbers: PyReadonlyArrayDyn<'py, f64>,
}

impl<'py> Given<'py> {
    /// The numbers of `value`, contiguous. `expected` is the shape, in words.
    pub(crate) fn of(value: &Bound<'py, PyAny>, name: &str, expected: &dyn Display) -> PyResult<Given<'py>> {
        let fits = |array: &Bound<'py, PyArrayDyn<f64>>| array.is_c_contiguous() && array.is_aligned();
        // Subclasses of an array, such as masked arrays, are copied.
        let array = match value.cast_exact::<PyArrayDyn<f64>>() {
            Ok(array) if fits(array) => array.clone(),
            _ => copied(value, name, expected)?,
        };
        Ok(Given {
            numbers: array.try_readonly().map_err(PyErr::from)?,
        })
    }

    /// The length of each axis.
    pub(crate) fn shape(&self) -> &[usize] {
        self.numbers.shape()
    }

    /// The numbers, the last axis fastest.
    pub(crate) fn values(&self) -> &[f64] {
        // `of` makes every array contiguous.
        self.numbers.as_slice().unwrap_or_default()
    }

    /// Refuses numbers that are not finite.
    ///
    /// # Errors
    /// The first number that is not finite, with its index.
    pub(crate) fn finite(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        let Some(at) = self.values().iter().position(|value| !value.is_finite()) else {
            return Ok(());
        };
        let (place, value) = (place_of(self.shape(), at), self.values()[at]);
        Err(refused(
            py,
            format!("{name}{place} is {value}"),
            "numbers must be finite",
        ))
    }
}

/// Item `index` of an array with these axes, in the notation of Python: `[1, 3]`; empty without axes.
pub(crate) fn place_of(axes: &[usize], index: usize) -> String {
    if axes.is_empty() {
        return String::new();
    }
    let (mut rest, mut place) = (index, Vec::new());
    for length in axes.iter().rev() {
        place.insert(0, (rest % length.max(&1)).to_string());
        rest /= length.max(&1);
    }
    format!("[{}]", place.join(", "))
}

/// A contiguous copy as `float64`.
fn copied<'py>(
    value: &Bound<'py, PyAny>,
    name: &str,
    expected: &dyn Display,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let py = value.py();
    let numpy = py.import("numpy")?;
    refuse_masked(&numpy, value, name)?;
    let array = numpy.call_method1("asarray", (value,)).map_err(|error| {
        if !error.is_instance_of::<PyValueError>(py) && !error.is_instance_of::<PyTypeError>(py) {
            // Such as an interrupt, which has nothing to do with the array.
            return error;
        }
        let kind = value
            .get_type()
            .name()
            .map_or_else(|_| "?".to_owned(), |name| name.to_string());
        wrong_type(format!(
            "{name}: expected real numbers of shape {expected}, given a {kind}, which is not an array ({})",
            error.value(py)
        ))
    })?;
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    if !["f", "i", "u"].contains(&kind.as_str()) {
        let shape = array.getattr("shape")?;
        return Err(wrong_type(format!(
            "{name}: expected real numbers of shape {expected}, given {dtype} of shape {shape}"
        )));
    }
    let whole = numpy.call_method1("require", (array, "float64", ["C", "A"]))?;
    Ok(whole.cast_into::<PyArrayDyn<f64>>()?)
}

/// Refuses a masked array of numpy with masked values, whose numbers are not valid.
fn refuse_masked(numpy: &Bound<'_, PyModule>, value: &Bound<'_, PyAny>, name: &str) -> PyResult<()> {
    if !value.hasattr("mask")? {
        return Ok(());
    }
    let masked = numpy.getattr("ma")?;
    if !value.is_instance(&masked.getattr("MaskedArray")?)? {
        return Ok(());
    }
    if masked.call_method1("is_masked", (value,))?.is_truthy()? {
        let message = format!("{name}: the array has masked values");
        return Err(refused(
            value.py(),
            message,
            "select the items without masked values",
        ));
    }
    Ok(())
}

/// Items of one shape along any number of leading axes; a single item has none.
pub(crate) struct Batch<'py> {
    /// The numbers.
    pub given: Given<'py>,
    /// The leading axes. Results have the same.
    pub axes: Vec<usize>,
    /// Number of items.
    pub count: usize,
}

impl<'py> Batch<'py> {
    /// The items of `value`, each of the shape `item`.
    ///
    /// # Errors
    /// Another shape; values that are not numbers.
    pub(crate) fn of(value: &Bound<'py, PyAny>, name: &str, item: &[usize]) -> PyResult<Batch<'py>> {
        let expected = ManyOf(item);
        let given = Given::of(value, name, &expected)?;
        let Some(axes) = given.shape().strip_suffix(item) else {
            return Err(wrong_shape(value.py(), name, &expected, given.shape()));
        };
        let axes = axes.to_vec();
        Ok(Batch {
            count: axes.iter().product(),
            axes,
            given,
        })
    }

    /// The shape of a result with `rest` for each item.
    pub(crate) fn shape(&self, rest: &[usize]) -> Vec<usize> {
        [&self.axes, rest].concat()
    }
}

/// `(..., 4, 4)`: formatted only for a message, since the evaluation of one point takes no longer.
struct ManyOf<'a>(&'a [usize]);

impl Display for ManyOf<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lengths: Vec<String> = self.0.iter().map(usize::to_string).collect();
        write!(f, "(..., {})", lengths.join(", "))
    }
}

/// The exception of a shape that is not the expected one.
pub(crate) fn wrong_shape(py: Python<'_>, name: &str, expected: &dyn Display, given: &[usize]) -> PyErr {
    let lengths: Vec<String> = given.iter().map(usize::to_string).collect();
    let comma = if given.len() == 1 { "," } else { "" };
    let message = format!(
        "{name}: expected shape {expected}, given ({}{comma})",
        lengths.join(", ")
    );
    refused(py, message, "the last axes are those of one item")
}

/// An array of numpy that owns `values`.
pub(crate) fn array<'py, T: Element>(
    py: Python<'py>,
    shape: &[usize],
    values: Vec<T>,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let array = ArrayD::from_shape_vec(IxDyn(shape), values);
    let array = array.map_err(|error| Fault::new_err(format!("a result of another shape: {error}")))?;
    Ok(PyArrayDyn::from_owned_array(py, array))
}
