//! The class `Judged`: what a path costs wherever its part lies.

use armill_core::optimize::Score;
use armill_study::Study;
use armill_study::file::placement::PlaceTable;
use armill_study::place::{PartPlace, Placing, Worth};
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use crate::arrays::{Batch, Given, array, wrong_shape};
use crate::errors::exception;
use crate::threads::{Effort, work};

/// What each of n places is worth: feasibility first, then the cost.
#[pyclass(frozen, module = "armill")]
pub(crate) struct Judged {
    worth: Worth,
    single: bool,
}

/// Numbers of a place, at least and at most: without and with the turn of the tool, and the rail.
const NUMBERS: std::ops::RangeInclusive<usize> = 6..=8;

/// Where the study has the part.
pub(crate) fn drawn<'py>(
    py: Python<'py>,
    study: &Study,
    analysis: Option<String>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let place = placing(study, analysis)
        .map_err(|error| exception(py, &error))?
        .drawn();
    let numbers = place.part.into_iter().chain([place.spin]).chain(place.rail);
    let numbers: Vec<f64> = numbers.collect();
    array(py, &[numbers.len()], numbers)
}

/// Judges places.
pub(crate) fn judge(
    study: &Study,
    (places, analysis): (&Bound<'_, PyAny>, Option<String>),
    threads: Option<usize>,
) -> PyResult<Judged> {
    let py = places.py();
    let requested = "(n, 6), (n, 7) or (n, 8), or one without the first axis";
    let given = Given::of(places, "places", &requested)?;
    let length = given.shape().last().copied().unwrap_or(0);
    if !NUMBERS.contains(&length) || given.shape().len() > 2 {
        return Err(wrong_shape(py, "places", &requested, given.shape()));
    }
    given.finite(py, "places")?;
    let batch = Batch::of(places, "places", &[length])?;
    let place = |numbers: &[f64]| PartPlace {
        part: std::array::from_fn(|degree| numbers[degree]),
        spin: numbers.get(6).copied().unwrap_or(0.0),
        rail: numbers.get(7).copied(),
    };
    let places: Vec<PartPlace> = given.values().chunks(length).map(place).collect();
    let worth = work(py, threads, Effort::Long, |watch| {
        placing(study, analysis)?.judge(&places, watch)
    })?;
    Ok(Judged {
        worth: worth.map_err(|error| exception(py, &error))?,
        single: batch.single,
    })
}

fn placing(study: &Study, analysis: Option<String>) -> Result<Placing<'_>, armill_study::StudyError> {
    let requested = PlaceTable {
        analysis,
        ..PlaceTable::default()
    };
    Placing::new(study, requested, 0)
}

impl Judged {
    fn each<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Score) -> T,
    ) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
        let scores = &self.worth.scores;
        let count = [scores.len()];
        let shape = if self.single { &[][..] } else { &count[..] };
        array(py, shape, scores.iter().map(of).collect())
    }
}

#[pymethods]
impl Judged {
    /// -> (n,) int: points of the path that the best branch does not hold.
    #[getter]
    fn lost<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        self.each(py, |score| score.lost as i64)
    }

    /// -> (n,) cost of the points that it holds, as the goal has it, m; 0 where it holds none.
    #[getter]
    fn cost<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each(py, |score| score.cost)
    }

    /// -> list of n str: that branch; empty of an arm whose branches have no names, and of holes.
    #[getter]
    fn branch(&self) -> Vec<String> {
        let name = |score: &Score| score.branch.map_or_else(String::new, |branch| branch.to_string());
        self.worth.scores.iter().map(name).collect()
    }

    /// -> int: points of the path.
    #[getter]
    fn point_count(&self) -> usize {
        self.worth.points
    }

    /// -> int: load cases at each point.
    #[getter]
    fn case_count(&self) -> usize {
        self.worth.cases
    }

    fn __len__(&self) -> usize {
        self.worth.scores.len()
    }

    fn __repr__(&self) -> String {
        format!(
            "<armill.Judged: {} places of {} points>",
            self.worth.scores.len(),
            self.worth.points
        )
    }
}
