//! The class `PlacementEvaluations`: the cost of a path for each of many placements of its part.

use armill_core::optimize::Score;
use armill_core::robot::Branch;
use armill_plan::place::{PlacementParameters, PlacementScores, PlacementSearch};
use armill_study::Study;
use armill_study::file::placement::PlaceTable;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;

use crate::arrays::{Batch, Given, array, wrong_shape};
use crate::containers::containers;
use crate::errors::exception;
use crate::html;
use crate::results::{Stored, Words};
use crate::threads::{Effort, ThreadCount, work};

/// The cost of a path for each of n placements of its part; `cost` is infinite where a point is unreachable.
#[pyclass(frozen, module = "armill")]
pub(crate) struct PlacementEvaluations {
    n_unreachable: Stored<i64>,
    cost: Stored<f64>,
    cost_of_reachable: Stored<f64>,
    branch: Words<Branch>,
    point_count: usize,
    case_count: usize,
}

/// Fewest and most numbers of a placement: without and with the spin of the tool, and the rail.
const NUMBERS: std::ops::RangeInclusive<usize> = 6..=8;

/// The placement that the study gives.
pub(crate) fn nominal<'py>(
    py: Python<'py>,
    study: &Study,
    analysis: Option<String>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let place = placing(study, analysis)
        .map_err(|error| exception(py, &error))?
        .nominal_parameters();
    let numbers = place.part.into_iter().chain([place.spin]).chain(place.rail);
    let numbers: Vec<f64> = numbers.collect();
    array(py, &[numbers.len()], numbers)
}

/// Evaluates placements.
pub(crate) fn evaluate(
    study: &Study,
    places: &Bound<'_, PyAny>,
    analysis: Option<String>,
    threads: Option<ThreadCount>,
) -> PyResult<PlacementEvaluations> {
    let py = places.py();
    let expected = "(..., 6), (..., 7) or (..., 8)";
    let given = Given::of(places, "places", &expected)?;
    let length = given.shape().last().copied().unwrap_or(0);
    if !NUMBERS.contains(&length) {
        return Err(wrong_shape(py, "places", &expected, given.shape()));
    }
    given.finite(py, "places")?;
    let batch = Batch::of(places, "places", &[length])?;
    let place = |numbers: &[f64]| PlacementParameters {
        part: std::array::from_fn(|degree| numbers[degree]),
        spin: numbers.get(6).copied().unwrap_or(0.0),
        rail: numbers.get(7).copied(),
    };
    let places: Vec<PlacementParameters> = given.values().chunks(length).map(place).collect();
    let scores = work(py, threads, Effort::Long, |watch| {
        placing(study, analysis)?.evaluate(&places, watch)
    })?;
    let scores = scores.map_err(|error| exception(py, &error))?;
    Ok(PlacementEvaluations::of(&scores, &batch.axes))
}

fn placing(study: &Study, analysis: Option<String>) -> Result<PlacementSearch<'_>, armill_study::StudyError> {
    let table = PlaceTable {
        analysis,
        ..PlaceTable::default()
    };
    PlacementSearch::new(study, table, 0)
}

impl PlacementEvaluations {
    /// The scores of placements with these axes.
    fn of(found: &PlacementScores, axes: &[usize]) -> PlacementEvaluations {
        let number = |of: &dyn Fn(&Score) -> f64| {
            Stored::new(axes.to_vec(), found.scores.iter().map(of).collect::<Vec<f64>>())
        };
        PlacementEvaluations {
            n_unreachable: Stored::new(
                axes.to_vec(),
                found
                    .scores
                    .iter()
                    .map(|score| score.unreachable as i64)
                    .collect(),
            ),
            cost: number(&|score| match score.unreachable {
                0 => score.cost,
                _ => f64::INFINITY,
            }),
            cost_of_reachable: number(&|score| match score.unreachable < found.points {
                true => score.cost,
                false => f64::NAN,
            }),
            branch: Words::Found(found.scores.iter().map(|score| score.branch).collect()),
            point_count: found.points,
            case_count: found.cases,
        }
    }
}

/// The arrays, the branches, the numbers of points and load cases.
type Parts<'py> = (
    PyReadonlyArrayDyn<'py, i64>,
    [PyReadonlyArrayDyn<'py, f64>; 2],
    Vec<Option<String>>,
    [usize; 2],
);

#[pymethods]
impl PlacementEvaluations {
    /// -> (n,) bool: whether the best branch reaches every point of the path.
    #[getter]
    fn reachable<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        let values = self.n_unreachable.values.iter().map(|count| *count == 0);
        array(py, &self.n_unreachable.shape, values.collect())
    }

    /// -> (n,) int: points of the path that the best branch does not reach.
    #[getter]
    fn n_unreachable<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        self.n_unreachable.array(py)
    }

    /// -> (n,) value of the objective, m; infinite where a point of the path is unreachable.
    #[getter]
    fn cost<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.cost.array(py)
    }

    /// -> (n,) value of the objective over the reachable points alone, m; NaN where none is reachable.
    #[getter]
    fn cost_of_reachable<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.cost_of_reachable.array(py)
    }

    /// -> list of n str: the best branch; empty for an arm without named branches, and for holes.
    #[getter]
    fn branch(&self) -> Vec<String> {
        self.branch.texts()
    }

    /// -> int: points of the path.
    #[getter]
    fn point_count(&self) -> usize {
        self.point_count
    }

    /// -> int: load cases at each point.
    #[getter]
    fn case_count(&self) -> usize {
        self.case_count
    }

    fn __len__(&self) -> usize {
        self.cost.values.len()
    }

    fn __repr__(&self) -> String {
        format!(
            "<armill.PlacementEvaluations: {} placements of {} points>",
            self.__len__(),
            self.point_count
        )
    }

    fn _repr_html_(&self) -> String {
        let known = self.cost.values.iter().filter(|cost| cost.is_finite());
        let (least, greatest) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), cost| {
            (low.min(*cost), high.max(*cost))
        });
        let reachable = self
            .n_unreachable
            .values
            .iter()
            .filter(|count| **count == 0)
            .count();
        let shown = |cost: f64| {
            if cost.is_finite() {
                format!("{cost:.3e}")
            } else {
                String::new()
            }
        };
        let row = vec![reachable.to_string(), shown(least), shown(greatest)];
        html::table(
            &self.__repr__(),
            &["reachable", "least cost, m", "greatest cost, m"],
            [row],
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyAny>,))> {
        let (py, own) = (slf.py(), slf.get());
        let parts = (
            own.n_unreachable.array(py)?,
            [own.cost.array(py)?, own.cost_of_reachable.array(py)?],
            own.branch.all(),
            [own.point_count, own.case_count],
        );
        Ok((
            slf.get_type().getattr("_again")?,
            (parts.into_pyobject(py)?.into_any(),),
        ))
    }

    #[staticmethod]
    fn _again(parts: Parts<'_>) -> PlacementEvaluations {
        let (unreachable, costs, branch, [point_count, case_count]) = parts;
        let [cost, cost_of_reachable] = costs.map(|cost| Stored::of(&cost));
        PlacementEvaluations {
            n_unreachable: Stored::of(&unreachable),
            cost,
            cost_of_reachable,
            branch: Words::Read(branch),
            point_count,
            case_count,
        }
    }
}

containers!(PlacementEvaluations);
