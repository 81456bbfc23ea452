//! The class `Postures`: all postures (inverse kinematics) of an arm at each of many poses.

use std::sync::atomic::{AtomicUsize, Ordering};

use armill_core::frame::Isometry;
use armill_core::kernel::{PosturesAt, postures_at};
use armill_core::robot::Unreachable;
use numpy::PyArrayDyn;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::arrays::{array, array_of};
use crate::errors::exception;
use crate::poses::{Poses, no_pose, one_pose, pose_at};
use crate::robot::Robot;
use crate::threads::{Effort, ThreadCount, work};

/// All postures of many poses: m postures of n poses, in the order of the poses; `postures[i]` are those of pose i.
#[pyclass(frozen, module = "armill")]
pub(crate) struct Postures {
    found: PosturesAt,
    dof: usize,
    /// Index of the first posture of each pose, then the number of postures.
    offsets: Vec<i64>,
}

/// Finds the postures.
pub(crate) fn inverse(
    robot: &Robot,
    (poses, tool): (&Bound<'_, PyAny>, Option<&Bound<'_, PyAny>>),
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
    let mut offsets = vec![0];
    for pose in &found.poses {
        let before = offsets.last().copied().unwrap_or(0);
        offsets.push(before + pose.map_or(0, |count| count as i64));
    }
    Ok(Postures {
        found,
        dof: robot.dof(),
        offsets,
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
            Err(why) => Err(no_pose(py, (name, poses.batch.single), index, why)),
        }
    }
}

/// The index in the sense of Python: from the end if negative.
pub(crate) fn index_of(index: isize, count: usize) -> PyResult<usize> {
    let from_begin = if index < 0 { index + count as isize } else { index };
    usize::try_from(from_begin)
        .ok()
        .filter(|index| *index < count)
        .ok_or_else(|| PyIndexError::new_err(format!("pose {index} does not exist: there are {count} poses")))
}

/// Why a pose is unreachable, in words.
pub(crate) fn reason_of<T>(pose: &Result<T, Unreachable>) -> Option<String> {
    pose.as_ref().err().map(ToString::to_string)
}

#[pymethods]
impl Postures {
    /// -> (m, dof) joint positions of every posture, rad (m).
    #[getter]
    fn joints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        array_of(py, &[self.found.names.len(), self.dof], &self.found.joints)
    }

    /// -> (m,) index of the pose of each posture.
    #[getter]
    fn pose_index<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        let poses = self.found.poses.iter().enumerate();
        let indices = poses.flat_map(|(i, pose)| std::iter::repeat_n(i as i64, pose.unwrap_or(0)));
        array(py, &[self.found.names.len()], indices.collect())
    }

    /// -> (n + 1,) index of the first posture of each pose; `offsets[i]:offsets[i + 1]` are those of pose i.
    #[getter]
    fn offsets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        array_of(py, &[self.offsets.len()], &self.offsets)
    }

    /// -> list of m str: the branch of each posture; without named branches, the side of its mid-position of each joint.
    #[getter]
    fn branch(&self) -> Vec<String> {
        self.found.names.iter().map(ToString::to_string).collect()
    }

    /// -> (m,) bool: whether every joint is inside its limits.
    #[getter]
    fn within_limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        array_of(py, &[self.found.names.len()], &self.found.within_limits)
    }

    /// i -> (k, dof) joint positions of the k postures of pose i.
    fn __getitem__<'py>(&self, py: Python<'py>, i: isize) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let i = index_of(i, self.found.poses.len())?;
        let [first, last] = [self.offsets[i], self.offsets[i + 1]].map(|offset| offset as usize);
        let joints = &self.found.joints[first * self.dof..last * self.dof];
        array_of(py, &[last - first, self.dof], joints)
    }

    /// i -> str or None: why pose i is unreachable, and by how much.
    fn reason(&self, i: isize) -> PyResult<Option<String>> {
        let i = index_of(i, self.found.poses.len())?;
        Ok(reason_of(&self.found.poses[i]))
    }

    /// -> int: number of poses.
    fn __len__(&self) -> usize {
        self.found.poses.len()
    }

    fn __repr__(&self) -> String {
        let (postures, poses) = (self.found.names.len(), self.found.poses.len());
        format!("<armill.Postures: {postures} of {poses} poses>")
    }
}
