//! Commands as functions: options by name in, the JSON of the command out.

use std::sync::Arc;

use armill_cli::{Call, Listener, OptionValue, Refused};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};

use crate::errors::{exception, usage, wrong_type};
use crate::operands::OperandFiles;
use crate::threads::{Beats, ThreadCount, watched};

/// command name, operands, options -> (json, messages, within_tolerance): the output of the command on stdout with
/// `--json`, the lines on stderr, and whether the tolerance is met if `strict` is given.
///
/// Operands and options may be robots and studies in place of names and paths.
/// `progress` is called repeatedly with the number of points finished.
#[pyfunction]
#[pyo3(signature = (command, operands, options, threads=None, progress=None))]
pub(crate) fn call(
    py: Python<'_>,
    command: String,
    operands: Vec<Bound<'_, PyAny>>,
    options: &Bound<'_, PyDict>,
    threads: Option<ThreadCount>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<(String, Vec<String>, bool)> {
    // Removed when the command has ended.
    let mut files = OperandFiles::default();
    let mut named = Vec::new();
    for (name, value) in options.iter() {
        let name: String = name.extract()?;
        if let Some(value) = option_value(&name, &value, &mut files)? {
            named.push((name, value));
        }
    }
    let operands = operands.iter().map(|operand| files.operand(operand));
    let call = Call {
        command,
        operands: operands.collect::<PyResult<_>>()?,
        options: named,
    };
    let listener = Arc::new(Listener::default());
    let beats = Beats {
        cancel: listener.cancel(),
        counted: listener.counted(),
    };
    let report = progress.map(|progress| move |count: usize| progress.call1((count,)).map(|_| ()));
    let report = report
        .as_ref()
        .map(|report| report as &dyn Fn(usize) -> PyResult<()>);
    let answer = watched(py, threads, beats, report, || armill_cli::call(&call, &listener))?;
    match answer {
        Ok(answer) => Ok((answer.json, answer.messages, answer.within_tolerance)),
        Err(Refused::Usage(text)) => Err(usage(py, text)),
        Err(Refused::Study(error)) => Err(exception(py, &error)),
    }
}

/// The value of an option; nothing where it is None.
fn option_value(
    name: &str,
    value: &Bound<'_, PyAny>,
    files: &mut OperandFiles,
) -> PyResult<Option<OptionValue>> {
    if value.is_none() {
        return Ok(None);
    }
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(Some(OptionValue::Flag(flag.is_true())));
    }
    if value.cast::<PyString>().is_ok() || value.cast::<PyInt>().is_ok() || value.cast::<PyFloat>().is_ok() {
        return Ok(Some(OptionValue::Text(value.str()?.to_string())));
    }
    if let Some(path) = files.object(value)? {
        return Ok(Some(OptionValue::Text(path)));
    }
    // Arrays and numbers of numpy.
    if value.hasattr("tolist")? {
        return option_value(name, &value.call_method0("tolist")?, files);
    }
    if value.hasattr("__fspath__")? {
        return Ok(Some(OptionValue::Text(
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
        all.extend(option_value(name, &item?, files)?);
    }
    Ok(Some(OptionValue::List(all)))
}

/// Name, whether it is an operand, help.
type OptionOf = (String, bool, String);

/// command name -> (help, [(name, is_operand, help)]): the help of a command and of its options.
#[pyfunction]
pub(crate) fn options(py: Python<'_>, name: &str) -> PyResult<(String, Vec<OptionOf>)> {
    let Some((about, options)) = armill_cli::options_of(name) else {
        return Err(usage(py, format!("no command `{name}` has an answer in JSON")));
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
