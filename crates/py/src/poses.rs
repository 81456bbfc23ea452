//! Poses and loads from arrays: homogeneous matrices and the types of other packages; forces and wrenches.

use armill_core::frame::{Isometry, PoseMatrixError, from_matrix};
use armill_core::nalgebra::{Matrix4, Vector3};
use armill_core::spatial::Wrench;
use numpy::PyUntypedArray;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{Batch, Given, array, place_of, wrong_shape};
use crate::errors::refused;

/// Numbers of a homogeneous matrix.
const ENTRIES: usize = 16;

/// Poses along any number of leading axes.
pub(crate) struct Poses<'py> {
    /// The matrices.
    pub batch: Batch<'py>,
}

impl<'py> Poses<'py> {
    /// The poses of `value`: (..., 4, 4); spatialmath's `SE3`; a transform of scipy; a pair of a rotation of scipy
    /// and translations.
    pub(crate) fn of(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Poses<'py>> {
        Poses::of_shape(value, name, None)
    }

    /// As [`Poses::of`]; `expected` is the shape that messages name in place of (..., 4, 4).
    fn of_shape(value: &Bound<'py, PyAny>, name: &str, expected: Option<&str>) -> PyResult<Poses<'py>> {
        let py = value.py();
        if let Ok(pair) = value.cast::<PyTuple>()
            && pair.len() == 2
            && pair.get_item(0)?.hasattr("as_matrix")?
        {
            let turns = pair.get_item(0)?.call_method0("as_matrix")?;
            return composed(py, name, &turns, &pair.get_item(1)?);
        }
        let matrices = if value.cast::<PyUntypedArray>().is_ok() {
            value.clone()
        } else if value.hasattr("A")? {
            value.getattr("A")?
        } else if value.hasattr("as_matrix")? {
            value.call_method0("as_matrix")?
        } else {
            value.clone()
        };
        if let Some(expected) = expected {
            let given = Given::of(&matrices, name, &expected)?;
            if !matches!(given.shape(), [4, 4] | [1, 4, 4]) {
                return Err(wrong_shape(py, name, &expected, given.shape()));
            }
        }
        Ok(Poses {
            batch: Batch::of(&matrices, name, &[4, 4])?,
        })
    }

    /// The matrices of all poses, row by row.
    pub(crate) fn values(&self) -> &[f64] {
        self.batch.given.values()
    }
}

/// Pose `index` of consecutive matrices.
///
/// # Errors
/// A matrix that is not a pose.
pub(crate) fn pose_at(values: &[f64], index: usize) -> Result<Isometry, PoseMatrixError> {
    from_matrix(&Matrix4::from_row_slice(&values[index * ENTRIES..][..ENTRIES]))
}

/// The exception of a matrix that is not a pose.
pub(crate) fn no_pose(
    py: Python<'_>,
    name: &str,
    axes: &[usize],
    index: usize,
    why: PoseMatrixError,
) -> PyErr {
    let which = format!("{name}{}", place_of(axes, index));
    let hint = "a pose is a rotation R and a translation t in m, [[R, t], [0, 1]]";
    refused(py, format!("{which} is not a valid pose: {why}"), hint)
}

/// One pose, such as that of the tool on the flange; the identity for `None`.
pub(crate) fn one_pose(value: Option<&Bound<'_, PyAny>>, name: &str) -> PyResult<Isometry> {
    let Some(value) = value else {
        return Ok(Isometry::identity());
    };
    let poses = Poses::of_shape(value, name, Some("(4, 4)"))?;
    if poses.batch.count != 1 {
        return Err(wrong_shape(
            value.py(),
            name,
            &"(4, 4)",
            poses.batch.given.shape(),
        ));
    }
    pose_at(poses.values(), 0).map_err(|why| no_pose(value.py(), name, &[], 0, why))
}

/// Matrices from rotations (n, 3, 3) and translations (n, 3).
fn composed<'py>(
    py: Python<'py>,
    name: &str,
    turns: &Bound<'py, PyAny>,
    translations: &Bound<'py, PyAny>,
) -> PyResult<Poses<'py>> {
    let turns = Batch::of(turns, name, &[3, 3])?;
    let translations = Batch::of(translations, name, &[3])?;
    if turns.count != translations.count {
        let message = format!(
            "{name}: {} rotations and {} translations",
            turns.count, translations.count
        );
        return Err(refused(py, message, "give the same number of both"));
    }
    let mut matrices = Vec::with_capacity(turns.count * ENTRIES);
    let both = turns.given.values().chunks(9);
    for (turn, translation) in both.zip(translations.given.values().chunks(3)) {
        for (row, along) in turn.chunks(3).zip(translation) {
            matrices.extend_from_slice(row);
            matrices.push(*along);
        }
        matrices.extend([0.0, 0.0, 0.0, 1.0]);
    }
    let matrices = array(py, &turns.shape(&[4, 4]), matrices)?;
    Ok(Poses {
        batch: Batch::of(matrices.as_any(), name, &[4, 4])?,
    })
}

/// Load cases on the tool at the TCP, base axes.
pub(crate) struct Forces {
    /// The load cases.
    pub cases: Vec<Wrench>,
    /// Their axes; a single case has none.
    pub axes: Vec<usize>,
    /// Whether each item has a load case of its own, instead of every item having all of them.
    pub paired: bool,
}

impl Forces {
    /// Forces (..., 3) or wrenches (..., 6): force N, then moment N m. Paired, they have the axes `items`.
    ///
    /// # Errors
    /// Another shape; no load case; numbers that are not finite.
    pub(crate) fn of(value: &Bound<'_, PyAny>, paired: Option<&[usize]>) -> PyResult<Forces> {
        const EXPECTED: &str = "(..., 3) or (..., 6)";
        let py = value.py();
        let given = Given::of(value, "forces", &EXPECTED)?;
        let Some((width @ (3 | 6), axes)) = given.shape().split_last() else {
            return Err(wrong_shape(py, "forces", &EXPECTED, given.shape()));
        };
        if let Some(items) = paired
            && items != axes
        {
            let message = format!("forces have the leading axes {axes:?}, the items {items:?}");
            return Err(refused(py, message, "with `paired` give one force for each item"));
        }
        if paired.is_none() && given.values().is_empty() {
            return Err(wrong_shape(py, "forces", &EXPECTED, given.shape()));
        }
        given.finite(py, "forces")?;
        let cases = given.values().chunks(*width).map(|case| Wrench {
            force: Vector3::from_column_slice(&case[..3]),
            moment: case
                .get(3..6)
                .map_or_else(Vector3::zeros, Vector3::from_column_slice),
        });
        Ok(Forces {
            cases: cases.collect(),
            axes: axes.to_vec(),
            paired: paired.is_some(),
        })
    }

    /// The axes of load cases in the shape of a result.
    pub(crate) fn result_axes(&self) -> &[usize] {
        if self.paired { &[] } else { &self.axes }
    }
}
