//! The classes `Study` and `Result`: a study file, checked and run, and what came out.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, TryLockError};
use std::time::Duration;

use armill_core::watch::Watch;
use armill_formats::file::Writer;
use armill_formats::input::Inputs;
use armill_study::finished::Finished;
use armill_study::output::{self, Csv, Pictures, Wanted};
use armill_study::run::point_count;
use armill_study::studies::{self, FoundStudy};
use armill_study::{Study as Checked, StudyError};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::{exception, refused};
use crate::judged::{self, Judged};
use crate::table::Table;
use crate::threads::{Beats, Effort, watched, work};

/// A study file: what is asked of a robot.
#[pyclass(frozen, module = "armill")]
pub(crate) struct Study {
    found: FoundStudy,
    /// The files that it was read from: none of them is written over.
    inputs: Inputs,
    /// Read when it is first asked for.
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
        // Reading may take long: a study may follow a program of any length.
        let read = || self.inputs.during(|| self.found.read().map(Arc::new));
        let checked = py.detach(|| self.checked.get_or_init(read));
        checked.as_ref().map(Arc::clone)
    }
}

/// What a study is made of again: what errors call it, its folder, its bytes.
type Parts<'py> = (String, PathBuf, Bound<'py, PyBytes>);

/// What is written beside `result.json`.
fn expected(pictures: bool, csv: bool) -> Wanted<'static> {
    Wanted {
        pictures: if pictures { Pictures::Drawn } else { Pictures::None },
        csv: if csv { Csv::Every } else { Csv::MapsAndPaths },
        opening: None,
    }
}

#[pymethods]
impl Study {
    /// path -> Study: a folder with a study.toml, the file itself, or the name of an example study.
    ///
    /// What is wrong inside is told by `problems` and `check`.
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

    /// text, folder -> Study: the text of a study file; files that it names are looked for in `folder`.
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

    /// Raises InputError with every problem of the file, if there is one.
    fn check(&self, py: Python<'_>) -> PyResult<()> {
        self.checked(py).map(|_| ()).map_err(|error| exception(py, error))
    }

    /// -> list of str: the names of its asks.
    #[getter]
    fn analyses(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let study = self.checked(py).map_err(|error| exception(py, error))?;
        Ok(study.analyses.iter().map(|analysis| analysis.name.clone()).collect())
    }

    /// -> int: how many points it asks for.
    #[getter]
    fn point_count(&self, py: Python<'_>) -> PyResult<usize> {
        let study = self.checked(py).map_err(|error| exception(py, error))?;
        Ok(point_count(&study))
    }

    /// -> str: the text of the file.
    #[getter]
    fn text(&self) -> std::borrow::Cow<'_, str> {
        // Bytes that are no text are told by `check`.
        String::from_utf8_lossy(&self.found.bytes)
    }

    /// -> path: where files are looked for that it names.
    #[getter]
    fn folder(&self) -> &Path {
        &self.found.folder
    }

    /// ask name or None -> (8,) x, y, z, heading, tilt, roll, spin, rail: where the study has the part of a path, m and rad.
    ///
    /// Without the rail, (7,), where the arm stands on none.
    #[pyo3(signature = (analysis=None))]
    fn drawn_place<'py>(
        &self,
        py: Python<'py>,
        analysis: Option<String>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let study = self.checked(py).map_err(|error| exception(py, error))?;
        judged::drawn(py, &study, analysis)
    }

    /// (n, 6) places -> Judged: what the path costs wherever its part lies.
    ///
    /// A place is x, y, z of the plane's centre (m, in the frame that the study counts from), heading, tilt and roll of the
    /// plane (rad); (n, 7) has the turn of the tool beside the one it has (rad), (n, 8) the rail (m). Goal, branches and margin
    /// are those of the study's `[place]`. `analysis` names the path where there are several.
    #[pyo3(signature = (places, *, analysis=None, threads=None))]
    fn judge(
        &self,
        py: Python<'_>,
        places: &Bound<'_, PyAny>,
        analysis: Option<String>,
        threads: Option<usize>,
    ) -> PyResult<Judged> {
        let study = self.checked(py).map_err(|error| exception(py, error))?;
        judged::judge(&study, (places, analysis), threads)
    }

    /// folder or None -> Result: runs every ask, and writes what `armill run` writes where a folder `out` is given.
    ///
    /// `progress` is called now and then with the number of points finished, of `point_count`.
    /// Files in `out` that armill did not make, or that were changed since, are replaced with `force=True` alone.
    #[pyo3(signature = (out=None, *, pictures=true, csv=false, force=false, threads=None, progress=None))]
    fn run(
        &self,
        py: Python<'_>,
        out: Option<PathBuf>,
        pictures: bool,
        csv: bool,
        force: bool,
        threads: Option<usize>,
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
        let tell = progress.map(|progress| move |count: usize| progress.call1((count,)).map(|_| ()));
        let tell = tell.as_ref().map(|tell| tell as &dyn Fn(usize) -> PyResult<()>);
        let found = watched(py, threads, (beats, tell), || {
            let expected = expected(pictures, csv);
            let out = out.map(|out| writer.folder(&out)).transpose()?;
            if let Some(out) = &out {
                output::allow(&study, (out, expected))?;
            }
            let mut finished = Finished::run(study, watch)?;
            if let Some(out) = &out {
                finished.write(out, expected)?;
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

    /// How it is made again, from the very bytes that were read.
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

/// What came out of a study.
#[pyclass(frozen, name = "Result", module = "armill")]
pub(crate) struct Outcome {
    /// Those of the study.
    inputs: Inputs,
    json: String,
    sentence: String,
    warnings: Vec<String>,
    analyses: Vec<String>,
    finished: Mutex<Finished>,
}

impl Outcome {
    /// What `job` makes of it on all processors.
    ///
    /// The thread that asks holds what came out, not the pool: a thread of the pool that waits for its own work may take up
    /// that of another question, and would wait for itself.
    fn requested<T: Send>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut Finished) -> Result<T, StudyError> + Send,
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

/// How long to wait until asking again for what another thread of Python uses.
const WAIT: Duration = Duration::from_millis(2);

#[pymethods]
impl Outcome {
    /// -> str: the very bytes of `result.json`, the last line end included.
    #[getter]
    fn json(&self) -> &str {
        &self.json
    }

    /// -> dict: `result.json` as values.
    #[getter]
    fn answer<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("json")?.call_method1("loads", (&self.json,))
    }

    /// -> str: the answer in one sentence.
    #[getter]
    fn sentence(&self) -> &str {
        &self.sentence
    }

    /// -> list of str: what to know before trusting it.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// -> list of str: the names of the asks.
    #[getter]
    fn analyses(&self) -> Vec<String> {
        self.analyses.clone()
    }

    /// ask name or None -> Table: a row a point, the columns of its Parquet file; of the first ask where none is named.
    #[pyo3(signature = (analysis=None))]
    fn table(&self, py: Python<'_>, analysis: Option<&str>) -> PyResult<Table> {
        let index = match analysis {
            None => 0,
            Some(name) => self.analyses.iter().position(|analysis| analysis == name).ok_or_else(|| {
                let message = format!("no ask is called `{name}`");
                refused(py, message, format!("there are: {}", self.analyses.join(", ")))
            })?,
        };
        Table::of(self.requested(py, |finished| finished.table(index))?)
    }

    /// -> dict of str to str: every picture as SVG, by its name.
    #[getter]
    fn pictures(&self, py: Python<'_>) -> PyResult<std::collections::BTreeMap<String, String>> {
        let drawn = self.requested(py, |finished| Ok(finished.pictures()))?;
        Ok(drawn
            .into_iter()
            .map(|picture| (picture.name, picture.svg))
            .collect())
    }

    /// folder -> list of paths: writes what `armill run` writes, `result.json` last.
    ///
    /// Files in `folder` that armill did not make, or that were changed since, are replaced with `force=True` alone.
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
        self.requested(py, |finished| {
            finished.write(&writer.folder(&folder)?, expected(pictures, csv))
        })
    }

    fn __repr__(&self) -> String {
        format!("<armill.Result: {}>", self.sentence)
    }
}
