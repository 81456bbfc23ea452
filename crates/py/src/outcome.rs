//! The class `Result`: the results of a study, with its tables and pictures.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Mutex, TryLockError};
use std::time::Duration;

use armill_formats::file::Writer;
use armill_formats::input::Inputs;
use armill_study::StudyError;
use armill_study::finished::FinishedRun;
use armill_study::output::{Csv, OutputOptions, Pictures};
use pyo3::prelude::*;

use crate::errors::{exception, refused};
use crate::html;
use crate::table::Table;
use crate::threads::{Effort, work};

/// The results of a study.
#[pyclass(frozen, name = "Result", module = "armill")]
pub(crate) struct Outcome {
    /// The input files of the study.
    inputs: Inputs,
    json: String,
    sentence: String,
    warnings: Vec<String>,
    analyses: Vec<String>,
    data: OutcomeData,
}

/// What tables and pictures are made of.
enum OutcomeData {
    /// The results themselves.
    Finished(Box<Mutex<FinishedRun>>),
    /// What a pickle keeps of them: a table for each analysis, and the pictures.
    Read {
        tables: Vec<Table>,
        pictures: BTreeMap<String, String>,
    },
}

impl Outcome {
    /// The results of a study that was read from these inputs, with the text of `result.json`.
    pub(crate) fn of(inputs: Inputs, finished: FinishedRun, json: String) -> Outcome {
        let answer = finished.answer();
        Outcome {
            inputs,
            json,
            sentence: answer.answer.clone(),
            warnings: answer.warnings.clone(),
            analyses: finished.analyses().into_iter().map(str::to_owned).collect(),
            data: OutcomeData::Finished(Box::new(Mutex::new(finished))),
        }
    }

    /// The table of an analysis.
    fn table_of(&self, py: Python<'_>, index: usize) -> PyResult<Table> {
        match &self.data {
            OutcomeData::Finished(finished) => {
                Table::of(with_finished(py, finished, |finished| finished.table(index))?)
            }
            OutcomeData::Read { tables, .. } => tables.get(index).cloned().ok_or_else(|| {
                let message = format!("the pickle has no table of analysis {index}");
                refused(py, message, "run the study again")
            }),
        }
    }
}

/// Runs `job` on results, on all processors.
///
/// The calling thread locks the results, not the pool: a pool thread that waits for its own work may start another job,
/// and would wait for itself.
fn with_finished<T: Send>(
    py: Python<'_>,
    finished: &Mutex<FinishedRun>,
    job: impl FnOnce(&mut FinishedRun) -> Result<T, StudyError> + Send,
) -> PyResult<T> {
    let mut finished = loop {
        match finished.try_lock() {
            Ok(finished) => break finished,
            Err(TryLockError::Poisoned(left)) => break left.into_inner(),
            Err(TryLockError::WouldBlock) => {
                py.detach(|| std::thread::sleep(WAIT));
                py.check_signals()?;
            }
        }
    };
    let finished = &mut *finished;
    let found = work(py, None, Effort::Long, |_| job(finished))?;
    found.map_err(|error| exception(py, &error))
}

/// Interval of attempts to lock results that another thread of Python uses.
const WAIT: Duration = Duration::from_millis(2);

/// JSON and sentence, warnings and analyses, tables, pictures.
type Parts = (
    [String; 2],
    [Vec<String>; 2],
    Vec<Py<Table>>,
    BTreeMap<String, String>,
);

#[pymethods]
impl Outcome {
    /// -> str: the text of `result.json`, final newline included.
    #[getter]
    fn json(&self) -> &str {
        &self.json
    }

    /// -> dict: `result.json` as values.
    #[getter]
    fn answer<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("json")?.call_method1("loads", (&self.json,))
    }

    /// -> str: the result in one sentence.
    #[getter]
    fn sentence(&self) -> &str {
        &self.sentence
    }

    /// -> list of str: limitations of the result.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// -> list of str: the names of the analyses.
    #[getter]
    fn analyses(&self) -> Vec<String> {
        self.analyses.clone()
    }

    /// analysis name or None -> Table: one row per point, the columns of its Parquet file; by default of the first analysis.
    #[pyo3(signature = (analysis=None))]
    fn table(&self, py: Python<'_>, analysis: Option<&str>) -> PyResult<Table> {
        let index = match analysis {
            None => 0,
            Some(name) => self
                .analyses
                .iter()
                .position(|analysis| analysis == name)
                .ok_or_else(|| {
                    let message = format!("the study has no analysis `{name}`");
                    refused(py, message, format!("it has: {}", self.analyses.join(", ")))
                })?,
        };
        self.table_of(py, index)
    }

    /// analysis name or None -> pandas.DataFrame: the rows of `table`. Needs pandas and pyarrow.
    #[pyo3(signature = (analysis=None))]
    fn to_pandas<'py>(&self, py: Python<'py>, analysis: Option<&str>) -> PyResult<Bound<'py, PyAny>> {
        Bound::new(py, self.table(py, analysis)?)?.call_method0("to_pandas")
    }

    /// analysis name or None -> xarray.Dataset: the columns of `table`, with `units` and `long_name`. Needs xarray.
    ///
    /// A map is over `z` and `y` of its plane, sections with a further dimension, a volume over `z`, `y` and `x`; any other
    /// analysis over `point`.
    #[pyo3(signature = (analysis=None))]
    fn to_xarray<'py>(slf: &Bound<'py, Self>, analysis: Option<String>) -> PyResult<Bound<'py, PyAny>> {
        let helpers = slf.py().import("armill._labelled")?;
        helpers.call_method1("result_dataset", (slf, analysis))
    }

    /// key -> the value in `answer`.
    fn __getitem__<'py>(slf: &Bound<'py, Self>, key: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        slf.getattr("answer")?.get_item(key)
    }

    /// Whether the JSON is equal.
    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let other = other.cast::<Outcome>();
        other.is_ok_and(|other| other.get().json == self.json)
    }

    fn __hash__(&self) -> usize {
        self.json.len()
    }

    /// -> dict of str to str: all pictures as SVG, by name.
    #[getter]
    fn pictures(&self, py: Python<'_>) -> PyResult<BTreeMap<String, String>> {
        match &self.data {
            OutcomeData::Finished(finished) => {
                let drawn = with_finished(py, finished, |finished| Ok(finished.pictures()))?;
                let drawn = drawn.into_iter();
                Ok(drawn.map(|picture| (picture.name, picture.svg)).collect())
            }
            OutcomeData::Read { pictures, .. } => Ok(pictures.clone()),
        }
    }

    /// folder -> list of paths: writes the files of `armill run`, `result.json` last.
    ///
    /// Files in `folder` that armill did not make, or that were changed since, are replaced only with `force=True`.
    /// A result that was pickled has its JSON, tables and pictures, but cannot be written.
    #[pyo3(signature = (folder, *, pictures=true, csv=false, force=false))]
    fn write(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        pictures: bool,
        csv: bool,
        force: bool,
    ) -> PyResult<Vec<PathBuf>> {
        let OutcomeData::Finished(finished) = &self.data else {
            let message = "a result that was pickled cannot be written";
            return Err(refused(py, message, "run the study again, or write its `json`"));
        };
        let writer = self.inputs.during(|| Writer::new("run", force));
        with_finished(py, finished, |finished| {
            finished.write(&writer.folder(&folder)?, output_options(pictures, csv))
        })
    }

    fn __repr__(&self) -> String {
        format!("<armill.Result: {}>", self.sentence)
    }

    fn _repr_html_(&self) -> String {
        let warnings: String = self
            .warnings
            .iter()
            .map(|warning| format!("<li>{}</li>", html::escaped(warning)))
            .collect();
        let sentence = html::escaped(&self.sentence);
        format!("<p><b>{sentence}</b></p><ul>{warnings}</ul>")
    }

    /// The JSON, the tables and the pictures, which are drawn for it.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyAny>,))> {
        let (py, own) = (slf.py(), slf.get());
        let tables = (0..own.analyses.len()).map(|index| Py::new(py, own.table_of(py, index)?));
        let parts = (
            [own.json.clone(), own.sentence.clone()],
            [own.warnings.clone(), own.analyses.clone()],
            tables.collect::<PyResult<Vec<Py<Table>>>>()?,
            own.pictures(py)?,
        );
        Ok((
            slf.get_type().getattr("_again")?,
            (parts.into_pyobject(py)?.into_any(),),
        ))
    }

    #[staticmethod]
    fn _again(parts: Parts) -> Outcome {
        let ([json, sentence], [warnings, analyses], tables, pictures) = parts;
        Outcome {
            inputs: Inputs::default(),
            json,
            sentence,
            warnings,
            analyses,
            data: OutcomeData::Read {
                tables: tables.iter().map(|table| table.get().clone()).collect(),
                pictures,
            },
        }
    }
}

/// The files to write in addition to `result.json`.
pub(crate) fn output_options(pictures: bool, csv: bool) -> OutputOptions<'static> {
    OutputOptions {
        pictures: if pictures { Pictures::Drawn } else { Pictures::None },
        csv: if csv { Csv::Every } else { Csv::MapsAndPaths },
        opening: None,
    }
}
