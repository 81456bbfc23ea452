//! The class `Postures`: all postures (inverse kinematics) of an arm at each of many poses.

use std::sync::atomic::{AtomicUsize, Ordering};

use armill_core::frame::Isometry;
use armill_core::kernel::postures_at;
use armill_core::robot::{PostureName, Unreachable};
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyList, PySlice};

use crate::arrays::array;
use crate::containers::containers;
use crate::errors::exception;
use crate::html;
use crate::poses::{Poses, no_pose, one_pose, pose_at};
use crate::results::{Stored, Words, item_of};
use crate::robot::Robot;
use crate::threads::{Effort, ThreadCount, work};

/// All postures of many poses: m postures of n poses, in the order of the poses; `postures[i]` are those of pose i.
///
/// Poses with several leading axes are numbered in the order of numpy; `postures[i, j]` is accepted too.
#[pyclass(frozen, module = "armill")]
pub(crate) struct Postures {
    /// Leading axes of the poses.
    axes: Vec<usize>,
    joints: Stored<f64>,
    pose_index: Stored<i64>,
    /// Index of the first posture of each pose, then the number of postures.
    offsets: Stored<i64>,
    within_limits: Stored<bool>,
    branch: Words<PostureName>,
    reasons: Words<Unreachable>,
}

/// Finds the postures.
pub(crate) fn inverse(
    robot: &Robot,
    poses: &Bound<'_, PyAny>,
    tool: Option<&Bound<'_, PyAny>>,
    home: Option<&Bound<'_, PyAny>>,
    threads: Option<ThreadCount>,
) -> PyResult<Postures> {
    let py = poses.py();
    let poses = Poses::of(poses, "poses")?;
    let tool_from_flange = one_pose(tool, "tool")?.inverse();
    let home = robot.home(home)?;
    let (matrices, count) = (poses.values(), poses.batch.count);
    let wrong = FirstWrong::default();
    let found = work(py, threads, effort(robot, count), |watch| {
        let base_from_flange = |i| wrong.pose(matrices, i) * tool_from_flange;
        postures_at(robot.arm(), count, base_from_flange, home.as_deref(), watch)
    })?;
    wrong.check(py, &poses, "poses")?;
    let found = found.map_err(|cancelled| exception(py, &cancelled.into()))?;
    let (mut offsets, mut pose_index) = (vec![0], Vec::with_capacity(found.names.len()));
    for (i, pose) in found.poses.iter().enumerate() {
        pose_index.extend(std::iter::repeat_n(i as i64, pose.unwrap_or(0)));
        offsets.push(pose_index.len() as i64);
    }
    let count = found.names.len();
    Ok(Postures {
        axes: poses.batch.axes,
        joints: Stored::new(vec![count, robot.dof()], found.joints),
        pose_index: Stored::new(vec![count], pose_index),
        offsets: Stored::new(vec![offsets.len()], offsets),
        within_limits: Stored::new(vec![count], found.within_limits),
        branch: Words::Found(found.names.into_iter().map(Some).collect()),
        reasons: Words::Found(found.poses.into_iter().map(Result::err).collect()),
    })
}

/// Closed forms are fast, searches are not.
pub(crate) fn effort(robot: &Robot, count: usize) -> Effort {
    match robot.arm().inverse().has_branches() {
        true => Effort::Points(count),
        false => Effort::Long,
    }
}

/// Index of the first matrix that is not a pose, shared by all threads.
pub(crate) struct FirstWrong(AtomicUsize);

impl Default for FirstWrong {
    fn default() -> FirstWrong {
        FirstWrong(AtomicUsize::new(usize::MAX))
    }
}

impl FirstWrong {
    /// Pose `index`. A matrix that is not a pose is noted and replaced by the identity; `check` then refuses the call.
    pub(crate) fn pose(&self, matrices: &[f64], index: usize) -> Isometry {
        pose_at(matrices, index).unwrap_or_else(|_| {
            self.0.fetch_min(index, Ordering::Relaxed);
            Isometry::identity()
        })
    }

    /// Refuses matrices that are not poses.
    ///
    /// # Errors
    /// Why the first of them is not a pose.
    pub(crate) fn check(&self, py: Python<'_>, poses: &Poses<'_>, name: &str) -> PyResult<()> {
        let index = self.0.load(Ordering::Relaxed);
        if index == usize::MAX {
            return Ok(());
        }
        match pose_at(poses.values(), index) {
            Ok(_) => Ok(()),
            Err(why) => Err(no_pose(py, name, &poses.batch.axes, index, why)),
        }
    }
}

/// The arrays, then the words: branch, reasons.
type Parts<'py> = (
    Vec<usize>,
    PyReadonlyArrayDyn<'py, f64>,
    [PyReadonlyArrayDyn<'py, i64>; 2],
    PyReadonlyArrayDyn<'py, bool>,
    [Vec<Option<String>>; 2],
);

#[pymethods]
impl Postures {
    /// -> (m, dof) joint positions of every posture, rad (m).
    #[getter]
    fn joints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.joints.array(py)
    }

    /// -> (m,) index of the pose of each posture.
    #[getter]
    fn pose_index<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        self.pose_index.array(py)
    }

    /// -> (n + 1,) index of the first posture of each pose; `offsets[i]:offsets[i + 1]` are those of pose i.
    #[getter]
    fn offsets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        self.offsets.array(py)
    }

    /// -> list of m str: the branch of each posture; without named branches, the side of its mid-position of each joint.
    #[getter]
    fn branch(&self) -> Vec<String> {
        self.branch.texts()
    }

    /// -> (m,) bool: whether every joint is inside its limits.
    #[getter]
    fn within_limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        self.within_limits.array(py)
    }

    /// i -> (k, dof) joint positions of the k postures of pose i; a slice -> list of them.
    fn __getitem__<'py>(&self, i: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let Ok(slice) = i.cast::<PySlice>() else {
            return Ok(self.of_pose(i.py(), item_of(&self.axes, i)?)?.into_any());
        };
        let range = slice.indices(self.__len__() as isize)?;
        let items = (0..range.slicelength as isize).map(|k| (range.start + k * range.step) as usize);
        let items: Vec<_> = items
            .map(|item| self.of_pose(i.py(), item))
            .collect::<PyResult<_>>()?;
        Ok(PyList::new(i.py(), items)?.into_any())
    }

    /// i -> str or None: why pose i is unreachable, and by how much.
    #[pyo3(signature = (i=None))]
    fn reason(&self, i: Option<&Bound<'_, PyAny>>) -> PyResult<Option<String>> {
        let i = i.map_or(Ok(0), |i| item_of(&self.axes, i))?;
        Ok(self.reasons.get(i))
    }

    /// -> int: number of poses.
    fn __len__(&self) -> usize {
        self.offsets.values.len().saturating_sub(1)
    }

    fn __repr__(&self) -> String {
        let (postures, poses) = (self.pose_index.values.len(), self.__len__());
        format!("<armill.Postures: {postures} of {poses} poses>")
    }

    fn _repr_html_(&self) -> String {
        /// Postures that a notebook shows.
        const SHOWN: usize = 10;
        let dof = self.joints.shape.last().copied().unwrap_or(0).max(1);
        let rows = self
            .joints
            .values
            .chunks(dof)
            .take(SHOWN)
            .enumerate()
            .map(|(i, joints)| {
                let joints: Vec<String> = joints.iter().map(|q| format!("{q:.4}")).collect();
                let pose = self.pose_index.values[i].to_string();
                vec![pose, self.branch.get(i).unwrap_or_default(), joints.join(", ")]
            });
        html::table(&self.__repr__(), &["pose", "branch", "joints, rad (m)"], rows)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyAny>,))> {
        let (py, own) = (slf.py(), slf.get());
        let parts = (
            own.axes.clone(),
            own.joints.array(py)?,
            [own.pose_index.array(py)?, own.offsets.array(py)?],
            own.within_limits.array(py)?,
            [own.branch.all(), own.reasons.all()],
        );
        Ok((
            slf.get_type().getattr("_again")?,
            (parts.into_pyobject(py)?.into_any(),),
        ))
    }

    #[staticmethod]
    fn _again(parts: Parts<'_>) -> Postures {
        let (axes, joints, [pose_index, offsets], within_limits, [branch, reasons]) = parts;
        Postures {
            axes,
            joints: Stored::of(&joints),
            pose_index: Stored::of(&pose_index),
            offsets: Stored::of(&offsets),
            within_limits: Stored::of(&within_limits),
            branch: Words::Read(branch),
            reasons: Words::Read(reasons),
        }
    }
}

containers!(Postures);

impl Postures {
    /// The joint positions of one pose.
    fn of_pose<'py>(&self, py: Python<'py>, pose: usize) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let dof = self.joints.shape.last().copied().unwrap_or(0);
        let offset = |i: usize| self.offsets.values.get(i).map_or(0, |offset| *offset as usize);
        let (first, last) = (offset(pose), offset(pose + 1));
        let joints = self
            .joints
            .values
            .get(first * dof..last * dof)
            .unwrap_or_default();
        array(py, &[joints.len() / dof.max(1), dof], joints.to_vec())
    }
}
