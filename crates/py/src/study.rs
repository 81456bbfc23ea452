//! The classes `Study` and `Result`: a study file, checked and run, and its results.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, TryLockError};
use std::time::Duration;

use armill_core::watch::Watch;
use armill_formats::file::Writer;
use armill_formats::input::Inputs;
use armill_study::finished::FinishedRun;
use armill_study::output::{self, Csv, OutputOptions, Pictures};
use armill_study::run::point_count;
use armill_study::studies::{self, FoundStudy};
use armill_study::{Study as Checked, StudyError};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::{exception, refused};
use crate::placement_evaluations::{self, PlacementEvaluations};
use crate::table::Table;
use crate::threads::{Beats, Effort, ThreadCount, watched, work};

/// A study file: a robot, a load, and the requested analyses.
#[pyclass(frozen, module = "armill")]
pub(crate) struct Study {
    found: FoundStudy,
    /// The files that it was read from; none of them is overwritten.
    inputs: Inputs,
    /// Read at first use.
    checked: OnceLock<Result<Arc<Checked>, StudyError>>,
}

impl Study {
    fn of(found: FoundStudy) -> Study {
        Study {
            found,
            inputs: Inputs::default(),
            checked: OnceLock::new(),
        }
    }

    fn checked(&self, py: Python<'_>) -> Result<Arc<Checked>, &StudyError> {
        // Reading may take long: the program of a study may have any length.
        let read = || self.inputs.during(|| self.found.read().map(Arc::new));
        let checked = py.detach(|| self.checked.get_or_init(read));
        checked.as_ref().map(Arc::clone)
    }
}

/// The parts that a pickle keeps: the name shown in messages, the folder, the bytes.
type Parts<'py> = (String, PathBuf, Bound<'py, PyBytes>);

/// The files to write in addition to `result.json`.
fn output_options(pictures: bool, csv: bool) -> OutputOptions<'static> {
    OutputOptions {
        pictures: if pictures { Pictures::Drawn } else { Pictures::None },
        csv: if csv { Csv::Every } else { Csv::MapsAndPaths },
        opening: None,
    }
}

#[pymethods]
impl Study {
    /// path -> Study: a folder with a study.toml, the file itself, or the name of an example study.
    ///
    /// `problems` and `check` report the problems of its contents.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Study> {
        let inputs = Inputs::naming([&*path]);
        let found = inputs.during(|| studies::find(&path));
        let found = found.map_err(|error| exception(py, &error))?;
        Ok(Study {
            inputs,
            ..Study::of(found)
        })
    }

    /// text, folder -> Study: the text of a study file; paths in it are relative to `folder`.
    #[staticmethod]
    #[pyo3(signature = (text, folder=PathBuf::from(".")))]
    fn from_text(text: String, folder: PathBuf) -> Study {
        Study::of(FoundStudy {
            shown: folder.join("study.toml").display().to_string(),
            folder,
            bytes: text.into_bytes(),
        })
    }

    /// -> list of dict: every problem of the file, with `file`, `line`, `column`, `span`, `message` and `hint`.
    #[getter]
    fn problems<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let problems = match self.checked(py) {
            Ok(_) => "[]".to_owned(),
            Err(error) => armill_cli::problems_json(error),
        };
        py.import("json")?.call_method1("loads", (problems,))
    }

    /// Raises InputError with all problems of the file, if there are any.
    fn check(&self, py: Python<'_>) -> PyResult<()> {
        self.checked(py).map(|_| ()).map_err(|error| exception(py, error))
    }

    /// -> list of str: the names of its analyses.
    #[getter]
    fn analyses(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let study = self.checked(py).map_err(|error| exception(py, error))?;
        Ok(study
            .analyses
            .iter()
            .map(|analysis| analysis.name.clone())
            .collect())
    }

    /// -> int: number of points of all analyses.
    #[getter]
    fn point_count(&self, py: Python<'_>) -> PyResult<usize> {
        let study = self.checked(py).map_err(|error| exception(py, error))?;
        Ok(point_count(&study))
    }

    /// -> str: the text of the file.
    #[getter]
    fn text(&self) -> std::borrow::Cow<'_, str> {
        // `check` reports bytes that are not text.
        String::from_utf8_lossy(&self.found.bytes)
    }

    /// -> path: the folder that paths in the study are relative to.
    #[getter]
    fn folder(&self) -> &Path {
        &self.found.folder
    }

    /// analysis name or None -> (8,) x, y, z, heading, tilt, roll, spin, rail: the placement that the study gives, m and rad.
    ///
    /// (7,), without the rail, for an arm that is not on a rail.
    #[pyo3(signature = (analysis=None))]
    fn nominal_placement<'py>(
        &self,
        py: Python<'py>,
        analysis: Option<String>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let study = self.checked(py).map_err(|error| exception(py, error))?;
        placement_evaluations::nominal(py, &study, analysis)
    }

    /// (n, 6) places -> PlacementEvaluations: the cost of the path for each placement of its part.
    ///
    /// A placement is x, y, z of the centre of the plane (m, in the reference frame of the study), heading, tilt and roll of
    /// the plane (rad); (n, 7) has the spin of the tool relative to the nominal one (rad), (n, 8) the rail (m). Objective,
    /// branches and margin are those of `[place]` of the study. `analysis` is the name of the path if there are several.
    #[pyo3(signature = (places, *, analysis=None, threads=None))]
    fn evaluate_placements(
        &self,
        py: Python<'_>,
        places: &Bound<'_, PyAny>,
        analysis: Option<String>,
        threads: Option<ThreadCount>,
    ) -> PyResult<PlacementEvaluations> {
        let study = self.checked(py).map_err(|error| exception(py, error))?;
        placement_evaluations::evaluate(&study, (places, analysis), threads)
    }

    /// folder or None -> Result: runs all analyses; with a folder `out` it writes the files of `armill run`.
    ///
    /// `progress` is called repeatedly with the number of points finished, of `point_count`.
    /// Files in `out` that armill did not make, or that were changed since, are replaced only with `force=True`.
    #[pyo3(signature = (out=None, *, pictures=true, csv=false, force=false, threads=None, progress=None))]
    fn run(
        &self,
        py: Python<'_>,
        out: Option<PathBuf>,
        pictures: bool,
        csv: bool,
        force: bool,
        threads: Option<ThreadCount>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Outcome> {
        let study = self.checked(py).map_err(|error| exception(py, error))?;
        let writer = self.inputs.during(|| Writer::new("run", force));
        let (cancel, counted) = (AtomicBool::new(false), AtomicUsize::new(0));
        let finished = |points: usize| {
            counted.fetch_add(points, Ordering::Relaxed);
        };
        let watch = Watch {
            finished: &finished,
            cancel: &cancel,
        };
        let beats = Beats {
            cancel: &cancel,
            counted: &counted,
        };
        let report = progress.map(|progress| move |count: usize| progress.call1((count,)).map(|_| ()));
        let report = report
            .as_ref()
            .map(|report| report as &dyn Fn(usize) -> PyResult<()>);
        let found = watched(py, threads, (beats, report), || {
            let options = output_options(pictures, csv);
            let out = out.map(|out| writer.folder(&out)).transpose()?;
            if let Some(out) = &out {
                output::allow(&study, (out, options))?;
            }
            let mut finished = FinishedRun::run(study, watch)?;
            if let Some(out) = &out {
                finished.write(out, options)?;
            }
            let json = output::json(finished.answer())?;
            Ok::<_, StudyError>((finished, json))
        })?;
        let (finished, json) = found.map_err(|error| exception(py, &error))?;
        let answer = finished.answer();
        Ok(Outcome {
            inputs: self.inputs.clone(),
            sentence: answer.answer.clone(),
            warnings: answer.warnings.clone(),
            analyses: finished.analyses().into_iter().map(str::to_owned).collect(),
            finished: Mutex::new(finished),
            json,
        })
    }

    fn __repr__(&self) -> String {
        format!("<armill.Study {}>", self.found.shown)
    }

    /// How to make it again, from the bytes that were read.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Parts<'py>)> {
        let found = &slf.get().found;
        let bytes = PyBytes::new(slf.py(), &found.bytes);
        let again = slf.get_type().getattr("_again")?;
        Ok((again, (found.shown.clone(), found.folder.clone(), bytes)))
    }

    #[staticmethod]
    fn _again(shown: String, folder: PathBuf, bytes: Vec<u8>) -> Study {
        Study::of(FoundStudy { shown, folder, bytes })
    }
}

/// The results of a study.
#[pyclass(frozen, name = "Result", module = "armill")]
pub(crate) struct Outcome {
    /// The input files of the study.
    inputs: Inputs,
    json: String,
    sentence: String,
    warnings: Vec<String>,
    analyses: Vec<String>,
    finished: Mutex<FinishedRun>,
}

impl Outcome {
    /// Runs `job` on the results, on all processors.
    ///
    /// The calling thread locks the results, not the pool: a pool thread that waits for its own work may start another
    /// job, and would wait for itself.
    fn with_finished<T: Send>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut FinishedRun) -> Result<T, StudyError> + Send,
    ) -> PyResult<T> {
        let mut finished = loop {
            match self.finished.try_lock() {
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
}

/// Interval of attempts to lock results that another thread of Python uses.
const WAIT: Duration = Duration::from_millis(2);

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
        Table::of(self.with_finished(py, |finished| finished.table(index))?)
    }

    /// -> dict of str to str: all pictures as SVG, by name.
    #[getter]
    fn pictures(&self, py: Python<'_>) -> PyResult<std::collections::BTreeMap<String, String>> {
        let drawn = self.with_finished(py, |finished| Ok(finished.pictures()))?;
        Ok(drawn
            .into_iter()
            .map(|picture| (picture.name, picture.svg))
            .collect())
    }

    /// folder -> list of paths: writes the files of `armill run`, `result.json` last.
    ///
    /// Files in `folder` that armill did not make, or that were changed since, are replaced only with `force=True`.
    #[pyo3(signature = (folder, *, pictures=true, csv=false, force=false))]
    fn write(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        pictures: bool,
        csv: bool,
        force: bool,
    ) -> PyResult<Vec<PathBuf>> {
        let writer = self.inputs.during(|| Writer::new("run", force));
        self.with_finished(py, |finished| {
            finished.write(&writer.folder(&folder)?, output_options(pictures, csv))
        })
    }

    fn __repr__(&self) -> String {
        format!("<armill.Result: {}>", self.sentence)
    }
}
