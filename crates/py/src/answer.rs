//! Commands as functions: options by name in, the JSON of the command out.

use std::path::PathBuf;
use std::sync::Arc;

use armill_cli::{Call, Listener, Refused, Told};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};

use crate::errors::{exception, usage, wrong_type};
use crate::threads::{Beats, watched};

/// command name, operands, options -> (json, talk, holds): what the command prints on stdout with `--json`, what it says on
/// stderr, and whether the tolerance is held where `strict` was asked.
///
/// `progress` is called now and then with the number of points finished.
#[pyfunction]
#[pyo3(signature = (command, operands, options, threads=None, progress=None))]
pub(crate) fn analysis(
    py: Python<'_>,
    command: String,
    operands: Vec<PathBuf>,
    options: &Bound<'_, PyDict>,
    threads: Option<usize>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<(String, Vec<String>, bool)> {
    let mut named = Vec::new();
    for (name, value) in options.iter() {
        let name: String = name.extract()?;
        if let Some(reported) = reported(&name, &value)? {
            named.push((name, reported));
        }
    }
    let shown = |path: &PathBuf| path.to_string_lossy().into_owned();
    let call = Call {
        command,
        operands: operands.iter().map(shown).collect(),
        options: named,
    };
    let listener = Arc::new(Listener::default());
    let beats = Beats {
        cancel: listener.cancel(),
        counted: listener.counted(),
    };
    let tell = progress.map(|progress| move |count: usize| progress.call1((count,)).map(|_| ()));
    let tell = tell.as_ref().map(|tell| tell as &dyn Fn(usize) -> PyResult<()>);
    let answer = watched(py, threads, (beats, tell), || armill_cli::analysis(&call, &listener))?;
    match answer {
        Ok(answer) => Ok((answer.json, answer.talk, answer.holds)),
        Err(Refused::Usage(text)) => Err(usage(py, text)),
        Err(Refused::Study(error)) => Err(exception(py, &error)),
    }
}

/// What is told of an option; nothing where it is None.
fn reported(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<Told>> {
    if value.is_none() {
        return Ok(None);
    }
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(Some(Told::Flag(flag.is_true())));
    }
    if value.cast::<PyString>().is_ok() || value.cast::<PyInt>().is_ok() || value.cast::<PyFloat>().is_ok() {
        return Ok(Some(Told::Text(value.str()?.to_string())));
    }
    // Arrays and numbers of numpy.
    if value.hasattr("tolist")? {
        return reported(name, &value.call_method0("tolist")?);
    }
    if value.hasattr("__fspath__")? {
        return Ok(Some(Told::Text(
            value.call_method0("__fspath__")?.str()?.to_string(),
        )));
    }
    let Ok(items) = value.try_iter() else {
        let kind = value.get_type().name()?;
        return Err(wrong_type(format!(
            "{name}: expected a text, a number, True or False, or a list of them, given {kind}"
        )));
    };
    let mut all = Vec::new();
    for item in items {
        all.extend(reported(name, &item?)?);
    }
    Ok(Some(Told::List(all)))
}

/// Name, whether it is an operand, help.
type OptionOf = (String, bool, String);

/// command name -> (help, [(name, is_operand, help)]): what a command says of itself and of its options.
#[pyfunction]
pub(crate) fn options(py: Python<'_>, name: &str) -> PyResult<(String, Vec<OptionOf>)> {
    let Some((about, options)) = armill_cli::options_of(name) else {
        return Err(usage(py, format!("no command `{name}` answers in JSON")));
    };
    let options = options.into_iter();
    Ok((
        about,
        options
            .map(|option| (option.name, option.is_operand, option.help))
            .collect(),
    ))
}

/// words -> exit code: the command `armill` on the terminal.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, words: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| armill_cli::command(words))
}
