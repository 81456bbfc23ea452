//! Errors as exceptions: the kind of an error decides which.
//!
//! | kind | exception | text |
//! |---|---|---|
//! | bad input | `InputError`, a `ValueError` | as the command prints it, without the word `error:` |
//! | another type of array | `TypeError` | the same |
//! | cancelled | `Cancelled`, a `KeyboardInterrupt` | the same |
//! | a fault of armill | `Fault`, a `RuntimeError` | the same |

use armill_study::{ErrorKind, StudyError};
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;

pyo3::create_exception!(
    armill,
    InputError,
    PyValueError,
    "Bad input: the text of all problems, as the command prints them; `.problems` has each as a dict \
     (`file`, `line`, `column`, `span`, `message`, `hint` for a file; otherwise `message` and optionally `hint`)."
);
pyo3::create_exception!(
    armill,
    Cancelled,
    PyKeyboardInterrupt,
    "The call was interrupted; no result was written."
);
pyo3::create_exception!(armill, Fault, PyRuntimeError, "A fault of armill itself.");

/// The exception of an error.
pub(crate) fn exception(py: Python<'_>, error: &StudyError) -> PyErr {
    let text = error.to_string();
    match error.kind() {
        ErrorKind::InvalidInput => with_problems(py, text, &armill_cli::problems_json(error)),
        ErrorKind::Cancelled => Cancelled::new_err(text),
        ErrorKind::Internal => Fault::new_err(text),
    }
}

/// The exception of an invalid value, with a hint.
pub(crate) fn refused(py: Python<'_>, message: impl Into<String>, hint: impl Into<String>) -> PyErr {
    exception(py, &StudyError::value(message, hint))
}

/// The exception of options that the command does not have.
pub(crate) fn usage(py: Python<'_>, text: String) -> PyErr {
    let given = StudyError::value(text.as_str(), "see `armill.command_help`");
    with_problems(py, text, &armill_cli::problems_json(&given))
}

/// The exception of a value of the wrong type.
pub(crate) fn wrong_type(message: impl Into<String>) -> PyErr {
    PyTypeError::new_err(message.into())
}

fn with_problems(py: Python<'_>, text: String, problems: &str) -> PyErr {
    let error = InputError::new_err(text);
    let list = py
        .import("json")
        .and_then(|json| json.call_method1("loads", (problems,)));
    match list.and_then(|list| error.value(py).setattr("problems", list)) {
        Ok(()) => error,
        Err(other) => other,
    }
}
