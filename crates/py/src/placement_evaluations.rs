//! The class `PlacementEvaluations`: the cost of a path for each of many placements of its part.

use armill_core::optimize::Score;
use armill_plan::place::{PlacementParameters, PlacementScores, PlacementSearch};
use armill_study::Study;
use armill_study::file::placement::PlaceTable;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use crate::arrays::{Batch, Given, array, wrong_shape};
use crate::errors::exception;
use crate::threads::{Effort, ThreadCount, work};

/// The cost of a path for each of n placements of its part; `cost` is infinite where a point is unreachable.
#[pyclass(frozen, module = "armill")]
pub(crate) struct PlacementEvaluations {
    scores: PlacementScores,
    single: bool,
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
    (places, analysis): (&Bound<'_, PyAny>, Option<String>),
    threads: Option<ThreadCount>,
) -> PyResult<PlacementEvaluations> {
    let py = places.py();
    let expected = "(n, 6), (n, 7) or (n, 8), or one without the first axis";
    let given = Given::of(places, "places", &expected)?;
    let length = given.shape().last().copied().unwrap_or(0);
    if !NUMBERS.contains(&length) || given.shape().len() > 2 {
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
    Ok(PlacementEvaluations {
        scores: scores.map_err(|error| exception(py, &error))?,
        single: batch.single,
    })
}

fn placing(study: &Study, analysis: Option<String>) -> Result<PlacementSearch<'_>, armill_study::StudyError> {
    let table = PlaceTable {
        analysis,
        ..PlaceTable::default()
    };
    PlacementSearch::new(study, table, 0)
}

impl PlacementEvaluations {
    fn each<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Score) -> T,
    ) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
        let scores = &self.scores.scores;
        let count = [scores.len()];
        let shape = if self.single { &[][..] } else { &count[..] };
        array(py, shape, scores.iter().map(of).collect())
    }
}

#[pymethods]
impl PlacementEvaluations {
    /// -> (n,) bool: whether the best branch reaches every point of the path.
    #[getter]
    fn reachable<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        self.each(py, |score| score.unreachable == 0)
    }

    /// -> (n,) int: points of the path that the best branch does not reach.
    #[getter]
    fn n_unreachable<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        self.each(py, |score| score.unreachable as i64)
    }

    /// -> (n,) value of the objective, m; infinite where a point of the path is unreachable.
    #[getter]
    fn cost<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each(py, |score| match score.unreachable {
            0 => score.cost,
            _ => f64::INFINITY,
        })
    }

    /// -> (n,) value of the objective over the reachable points alone, m; NaN where none is reachable.
    #[getter]
    fn cost_of_reachable<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let points = self.scores.points;
        self.each(py, |score| {
            if score.unreachable < points {
                score.cost
            } else {
                f64::NAN
            }
        })
    }

    /// -> list of n str: the best branch; empty for an arm without named branches, and for holes.
    #[getter]
    fn branch(&self) -> Vec<String> {
        let name = |score: &Score| score.branch.map_or_else(String::new, |branch| branch.to_string());
        self.scores.scores.iter().map(name).collect()
    }

    /// -> int: points of the path.
    #[getter]
    fn point_count(&self) -> usize {
        self.scores.points
    }

    /// -> int: load cases at each point.
    #[getter]
    fn case_count(&self) -> usize {
        self.scores.cases
    }

    fn __len__(&self) -> usize {
        self.scores.scores.len()
    }

    fn __repr__(&self) -> String {
        format!(
            "<armill.PlacementEvaluations: {} placements of {} points>",
            self.scores.scores.len(),
            self.scores.points
        )
    }
}
