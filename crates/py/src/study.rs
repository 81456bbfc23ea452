//! The class `Study`: a study file, checked and run.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use armill_core::watch::Watch;
use armill_formats::file::Writer;
use armill_formats::input::Inputs;
use armill_study::finished::FinishedRun;
use armill_study::output;
use armill_study::run::point_count;
use armill_study::studies::{self, FoundStudy};
use armill_study::{Study as Checked, StudyError};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use toml_edit::{DocumentMut, value};

use crate::errors::exception;
use crate::html;
use crate::outcome::{Outcome, output_options};
use crate::placement_evaluations::{self, PlacementEvaluations};
use crate::robot::Robot;
use crate::robot_file::RobotFile;
use crate::threads::{Beats, ThreadCount, watched};

/// A study file: a robot, a load, and the requested analyses.
#[pyclass(frozen, module = "armill")]
pub(crate) struct Study {
    found: FoundStudy,
    /// In place of that of the file.
    robot: Option<GivenRobot>,
    /// The files that it was read from; none of them is overwritten.
    inputs: Inputs,
    /// Read at first use.
    checked: OnceLock<Result<Arc<Checked>, StudyError>>,
}

/// A robot given by the caller, and the file that a study names.
struct GivenRobot {
    robot: Py<Robot>,
    file: RobotFile,
}

impl Study {
    fn of(found: FoundStudy, robot: Option<&Bound<'_, PyAny>>) -> PyResult<Study> {
        let given = |robot: &Bound<'_, PyAny>| {
            let (py, robot) = (robot.py(), Robot::given(robot)?);
            let file = RobotFile::of(py, robot.get())?;
            Ok::<_, PyErr>(GivenRobot { robot, file })
        };
        Ok(Study {
            found,
            robot: robot.map(given).transpose()?,
            inputs: Inputs::default(),
            checked: OnceLock::new(),
        })
    }

    /// Its path, or name as an example, if it is there as it was read and has its own robot.
    pub(crate) fn path(&self) -> Option<String> {
        let is_this = |path: &String| {
            let found = studies::find(Path::new(path));
            found.is_ok_and(|found| found.bytes == self.found.bytes && found.folder == self.found.folder)
        };
        let folder = self.found.folder.to_string_lossy().into_owned();
        let paths = [self.found.shown.clone(), folder];
        paths
            .into_iter()
            .find(|path| self.robot.is_none() && is_this(path))
    }

    /// Its text, which names the file of the given robot, if there is one.
    ///
    /// # Errors
    /// A text that is not TOML.
    pub(crate) fn text_with_robot(&self, py: Python<'_>) -> PyResult<Vec<u8>> {
        let Some(given) = &self.robot else {
            return Ok(self.found.bytes.clone());
        };
        // The reader reports what is wrong with the text.
        self.checked(py).map_err(|error| exception(py, error))?;
        let mut document: DocumentMut = match self.text().parse() {
            Ok(document) => document,
            Err(_) => return Ok(self.found.bytes.clone()),
        };
        document["robot"] = value(given.file.path.as_str());
        Ok(document.to_string().into_bytes())
    }

    fn checked(&self, py: Python<'_>) -> Result<Arc<Checked>, &StudyError> {
        // Reading may take long: the program of a study may have any length.
        let read = || {
            let robot = self.robot.as_ref().map(|given| given.file.path.clone());
            let change = self.inputs.during(|| match robot {
                Some(robot) => self.found.read_changed(|file| file.robot = robot),
                None => self.found.read(),
            });
            change.map(Arc::new)
        };
        let checked = py.detach(|| self.checked.get_or_init(read));
        checked.as_ref().map(Arc::clone)
    }
}

/// The parts that a pickle keeps: the name shown in messages, the folder, the bytes, the given robot.
type Parts<'py> = (String, PathBuf, Bound<'py, PyBytes>, Option<Py<Robot>>);

#[pymethods]
impl Study {
    /// path -> Study: a folder with a study.toml, the file itself, or the name of an example study.
    ///
    /// `robot` replaces the robot of the file: a Robot, a name of the library, or the path of a robot file.
    /// `problems` and `check` report the problems of the contents.
    #[staticmethod]
    #[pyo3(signature = (path, *, robot=None))]
    fn load(py: Python<'_>, path: PathBuf, robot: Option<&Bound<'_, PyAny>>) -> PyResult<Study> {
        let inputs = Inputs::naming([&*path]);
        let found = inputs.during(|| studies::find(&path));
        let found = found.map_err(|error| exception(py, &error))?;
        Ok(Study {
            inputs,
            ..Study::of(found, robot)?
        })
    }

    /// text, folder -> Study: the text of a study file; paths in it are relative to `folder`.
    ///
    /// `robot` replaces the robot of the text, as in `load`.
    #[staticmethod]
    #[pyo3(
        signature = (text, folder=PathBuf::from("."), *, robot=None),
        text_signature = "(text, folder='.', *, robot=None)"
    )]
    fn from_text(text: String, folder: PathBuf, robot: Option<&Bound<'_, PyAny>>) -> PyResult<Study> {
        let found = FoundStudy {
            shown: folder.join("study.toml").display().to_string(),
            folder,
            bytes: text.into_bytes(),
        };
        Study::of(found, robot)
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

    /// -> int: points and moves that progress counts.
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
    pub(crate) fn folder(&self) -> &Path {
        &self.found.folder
    }

    /// -> Robot or None: the robot that was given in place of that of the file.
    #[getter]
    fn robot(&self, py: Python<'_>) -> Option<Py<Robot>> {
        self.robot.as_ref().map(|given| given.robot.clone_ref(py))
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
        placement_evaluations::evaluate(&study, places, analysis, threads)
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
        let found = watched(py, threads, beats, report, || {
            let options = output_options(pictures, csv);
            let out = out.map(|out| writer.folder(&out)).transpose()?;
            if let Some(out) = &out {
                output::allow(&study, out, options)?;
            }
            let mut finished = FinishedRun::run(study, watch)?;
            if let Some(out) = &out {
                finished.write(out, options)?;
            }
            let json = output::json(finished.answer())?;
            Ok::<_, StudyError>((finished, json))
        })?;
        let (finished, json) = found.map_err(|error| exception(py, &error))?;
        Ok(Outcome::of(self.inputs.clone(), finished, json))
    }

    fn __repr__(&self) -> String {
        format!("<armill.Study {}>", self.found.shown)
    }

    /// Whether text, folder and robot are equal.
    fn __eq__(&self, other: &Bound<'_, PyAny>) -> PyResult<bool> {
        let py = other.py();
        let Ok(other) = other.cast::<Study>() else {
            return Ok(false);
        };
        let other = other.get();
        let same = (&self.found.folder, &self.found.bytes) == (&other.found.folder, &other.found.bytes);
        let (own, given) = (
            self.robot(py).into_pyobject(py)?,
            other.robot(py).into_pyobject(py)?,
        );
        Ok(same && own.eq(given)?)
    }

    fn __hash__(&self) -> usize {
        self.found.bytes.len()
    }

    fn _repr_html_(&self, py: Python<'_>) -> String {
        let (header, rows) = match self.checked(py) {
            Ok(study) => (
                "analysis",
                study
                    .analyses
                    .iter()
                    .map(|analysis| analysis.name.clone())
                    .collect(),
            ),
            Err(error) => ("problems", vec![error.to_string()]),
        };
        html::table(
            &self.found.shown,
            &[header],
            rows.into_iter().map(|row: String| vec![row]),
        )
    }

    /// How to make it again, from the bytes that were read.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Parts<'py>)> {
        let (py, own) = (slf.py(), slf.get());
        let bytes = PyBytes::new(py, &own.found.bytes);
        let again = slf.get_type().getattr("_again")?;
        let parts = (
            own.found.shown.clone(),
            own.found.folder.clone(),
            bytes,
            own.robot(py),
        );
        Ok((again, parts))
    }

    #[staticmethod]
    fn _again(
        shown: String,
        folder: PathBuf,
        bytes: Vec<u8>,
        robot: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Study> {
        let found = FoundStudy { shown, folder, bytes };
        Study::of(found, robot)
    }
}
