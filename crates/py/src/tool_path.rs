//! The class `ToolPath`: the moves of a tool path program, as arrays.

use std::io::Read;
use std::path::PathBuf;

use armill_core::nalgebra::{Unit, Vector3};
use armill_core::path::{Course, Move, Operation, Pace, Step};
use armill_formats::input::{self, Inputs};
use armill_formats::toolpath::apt::Dialect;
use armill_formats::toolpath::format::{ToolpathReadOptions, read};
use armill_formats::toolpath::{LengthUnit, Summary};
use numpy::{Element, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::array;
use crate::containers::containers;
use crate::errors::{exception, refused};
use crate::html;
use crate::threads::{Effort, ThreadCount, work};

/// The n moves of a program, m and m/s in the frame of the program; a move is given by its end point.
#[pyclass(frozen, module = "armill")]
pub(crate) struct ToolPath {
    moves: Vec<Move>,
    /// Index of the operation of each move; -1 before the first.
    operation: Vec<i64>,
    operations: Vec<Operation>,
    summary: Summary,
    source: ProgramSource,
}

/// The file of a program, and the options of the call: what a pickle keeps.
#[derive(Clone, Debug)]
struct ProgramSource {
    path: PathBuf,
    bytes: Vec<u8>,
    unit: Option<String>,
    dialect: Option<String>,
}

/// file -> ToolPath: the moves of G-code, cutter locations (APT-CL, CLSF) or a CSV of points.
///
/// `unit` (`mm` or `inch`) is the unit of lengths if the file does not state it; `dialect` (`nx` or `solidworks`) is the
/// dialect of the cutter locations if the file does not show it.
#[pyfunction]
#[pyo3(signature = (file, *, unit=None, dialect=None))]
pub(crate) fn read_path(
    py: Python<'_>,
    file: PathBuf,
    unit: Option<String>,
    dialect: Option<String>,
) -> PyResult<ToolPath> {
    let shown = file.display().to_string();
    let bytes = py.detach(|| {
        Inputs::naming([&*file]).during(|| {
            let mut bytes = Vec::new();
            input::open(&file)?.read_to_end(&mut bytes).map(|_| bytes)
        })
    });
    let bytes =
        bytes.map_err(|error| refused(py, format!("cannot read {shown}: {error}"), "check the path"))?;
    parsed(
        py,
        ProgramSource {
            path: file,
            bytes,
            unit,
            dialect,
        },
    )
}

/// The moves of a program that was read.
///
/// # Errors
/// Unknown options; the problems of the program.
fn parsed(py: Python<'_>, source: ProgramSource) -> PyResult<ToolPath> {
    let unit = match source.unit.as_deref() {
        None => None,
        Some("mm") => Some(LengthUnit::Millimetre),
        Some("inch") => Some(LengthUnit::Inch),
        Some(other) => {
            return Err(refused(
                py,
                format!("unit: `{other}` is not a unit"),
                "`mm` or `inch`",
            ));
        }
    };
    let dialect = match source.dialect.as_deref() {
        None => None,
        Some("nx") => Some(Dialect::Nx),
        Some("solidworks") => Some(Dialect::SolidWorks),
        Some(other) => {
            let message = format!("dialect: `{other}` is not a dialect");
            return Err(refused(py, message, "`nx` or `solidworks`"));
        }
    };
    let shown = source.path.display().to_string();
    let found = work(py, Some(ThreadCount::ONE), Effort::Long, |_| {
        let (mut moves, mut operation, mut operations) = (Vec::new(), Vec::new(), Vec::new());
        let requested = ToolpathReadOptions {
            unit,
            dialect,
            ..ToolpathReadOptions::default()
        };
        let summary = read(&shown, &*source.bytes, &requested, &mut |step| match step {
            Step::Operation(begun) => operations.push(begun),
            Step::Command(_) => {}
            Step::Move(given) => {
                moves.push(given);
                operation.push(operations.len() as i64 - 1);
            }
        })?;
        Ok(ToolPath {
            moves,
            operation,
            operations,
            summary,
            source,
        })
    })?;
    found.map_err(|problems: armill_formats::document::Problems| exception(py, &problems.into()))
}

impl ToolPath {
    /// A number for each move.
    fn each<'py, T: Element>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Move) -> T,
    ) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
        array(py, &[self.moves.len()], self.moves.iter().map(of).collect())
    }

    /// A vector for each move.
    fn vectors<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Move) -> Vector3<f64>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let values = self.moves.iter().flat_map(|given| of(given).data.0[0]);
        array(py, &[self.moves.len(), 3], values.collect())
    }
}

#[pymethods]
impl ToolPath {
    /// -> (n, 3) end point of each move, m.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.vectors(py, |given| given.end.coords)
    }

    /// -> (n, 3) tool axes at the end points, from the tip towards the spindle; zeros where the program gives none.
    #[getter]
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.vectors(py, |given| {
            given.axis.map_or_else(Vector3::zeros, Unit::into_inner)
        })
    }

    /// -> (n,) bool: whether the tool cuts during the move.
    #[getter]
    fn cuts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        self.each(py, |given| given.pace.cuts())
    }

    /// -> (n,) feed rate of each move, m/s; 0 for rapids, and where the program gives none.
    #[getter]
    fn feed<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each(py, |given| match given.pace {
            Pace::Feed(speed) => speed,
            Pace::Rapid | Pace::Unknown => 0.0,
        })
    }

    /// -> (n,) angle of each arc, rad, full turns included; 0 for straight moves.
    #[getter]
    fn sweep<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each(py, |given| match given.course {
            Course::Arc(arc) => arc.sweep,
            Course::Line => 0.0,
        })
    }

    /// -> (n, 3) a point on the axis of each arc, m; zeros for straight moves.
    #[getter]
    fn arc_centre<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.vectors(py, |given| match given.course {
            Course::Arc(arc) => arc.centre.coords,
            Course::Line => Vector3::zeros(),
        })
    }

    /// -> (n, 3) axis of rotation of each arc, by the right-hand rule; zeros for straight moves.
    #[getter]
    fn arc_axis<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.vectors(py, |given| match given.course {
            Course::Arc(arc) => arc.axis.into_inner(),
            Course::Line => Vector3::zeros(),
        })
    }

    /// -> (n,) line of each move in the program, from 1.
    #[getter]
    fn line<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        self.each(py, |given| i64::from(given.line))
    }

    /// -> (n,) index of each move's operation in `operations`; -1 before the first.
    #[getter]
    fn operation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        array(py, &[self.operation.len()], self.operation.clone())
    }

    /// -> list of dict: `name`, `tool`, `diameter` (m), `corner_radius` (m), `spindle` (rad/s), `line`; None if not given.
    #[getter]
    fn operations<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let given = |operation: &Operation| {
            let dict = PyDict::new(py);
            dict.set_item("name", operation.name.as_deref())?;
            dict.set_item("tool", operation.tool)?;
            dict.set_item("diameter", operation.diameter)?;
            dict.set_item("corner_radius", operation.corner_radius)?;
            dict.set_item("spindle", operation.spindle)?;
            dict.set_item("line", operation.line)?;
            Ok(dict)
        };
        self.operations.iter().map(given).collect()
    }

    /// -> str: the format of the file: `gcode`, `apt` or `csv`.
    #[getter]
    fn format(&self) -> &'static str {
        self.summary.format.name()
    }

    /// -> list of str: words of the program that were ignored, and assumptions.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.summary.notes.clone()
    }

    /// -> int: number of moves.
    fn __len__(&self) -> usize {
        self.moves.len()
    }

    fn __repr__(&self) -> String {
        format!(
            "<armill.ToolPath {}: {} moves, {} of them arcs>",
            self.format(),
            self.moves.len(),
            self.summary.arcs
        )
    }

    fn _repr_html_(&self) -> String {
        let rows = self.operations.iter().map(|operation| {
            let diameter = operation
                .diameter
                .map_or_else(String::new, |diameter| format!("{diameter:.4}"));
            let name = operation.name.clone().unwrap_or_default();
            vec![operation.line.to_string(), name, diameter]
        });
        html::table(&self.__repr__(), &["line", "operation", "diameter, m"], rows)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, SourceParts<'py>)> {
        let source = slf.get().source.clone();
        let bytes = PyBytes::new(slf.py(), &source.bytes);
        let again = slf.get_type().getattr("_again")?;
        Ok((again, (source.path, bytes, source.unit, source.dialect)))
    }

    #[staticmethod]
    fn _again(
        py: Python<'_>,
        path: PathBuf,
        bytes: Vec<u8>,
        unit: Option<String>,
        dialect: Option<String>,
    ) -> PyResult<ToolPath> {
        parsed(
            py,
            ProgramSource {
                path,
                bytes,
                unit,
                dialect,
            },
        )
    }
}

containers!(ToolPath);

/// The parts that a pickle keeps.
type SourceParts<'py> = (PathBuf, Bound<'py, PyBytes>, Option<String>, Option<String>);
