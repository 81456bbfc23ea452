//! What all results have: their arrays as a dict, a data frame or a data set, and equality.

/// Methods of a class whose arrays `armill._labelled` names.
macro_rules! containers {
    ($class:ident) => {
        #[pyo3::pymethods]
        impl $class {
            /// -> dict: every array and list by name.
            fn to_dict<'py>(slf: &pyo3::Bound<'py, Self>) -> pyo3::PyResult<pyo3::Bound<'py, pyo3::PyAny>> {
                $crate::containers::helper(slf.as_any(), "to_dict", None)
            }

            /// -> pandas.DataFrame: a row per item, a column per number, with the unit in `attrs`. Needs pandas.
            fn to_pandas<'py>(slf: &pyo3::Bound<'py, Self>) -> pyo3::PyResult<pyo3::Bound<'py, pyo3::PyAny>> {
                $crate::containers::helper(slf.as_any(), "to_pandas", None)
            }

            /// -> xarray.Dataset: every array by name, with `units` and `long_name`. Needs xarray.
            ///
            /// `dims` are names of the leading axes, such as those of samples or of a grid of poses.
            #[pyo3(signature = (dims=None))]
            fn to_xarray<'py>(
                slf: &pyo3::Bound<'py, Self>,
                dims: Option<Vec<String>>,
            ) -> pyo3::PyResult<pyo3::Bound<'py, pyo3::PyAny>> {
                $crate::containers::helper(slf.as_any(), "to_xarray", dims)
            }

            /// Whether all arrays are equal, NaN where NaN.
            fn __eq__(
                slf: &pyo3::Bound<'_, Self>,
                other: &pyo3::Bound<'_, pyo3::PyAny>,
            ) -> pyo3::PyResult<bool> {
                use pyo3::prelude::PyAnyMethods;
                if !other.is_instance_of::<Self>() {
                    return Ok(false);
                }
                let helpers = pyo3::prelude::PyModule::import(slf.py(), "armill._labelled")?;
                helpers.call_method1("equal", (slf, other))?.extract()
            }

            fn __hash__(&self) -> usize {
                self.__len__()
            }
        }
    };
}

pub(crate) use containers;
use pyo3::prelude::*;

/// The result of a function of `armill._labelled`.
pub(crate) fn helper<'py>(
    of: &Bound<'py, PyAny>,
    name: &str,
    dims: Option<Vec<String>>,
) -> PyResult<Bound<'py, PyAny>> {
    let helpers = of.py().import("armill._labelled")?;
    match dims {
        Some(dims) => helpers.call_method1(name, (of, dims)),
        None => helpers.call_method1(name, (of,)),
    }
}
