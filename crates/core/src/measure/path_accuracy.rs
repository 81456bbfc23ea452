//! Accuracy and repeatability of paths.
//!
//! The path is commanded by points `c_i`, straight between them, with the tangent `t_i`. Each of `n` runs is a trace of
//! measured points with any sampling; at point `i` it is evaluated where it passes the plane through `c_i` across
//! `t_i`:
//!
//! ```text
//! x_ij   run j where (x - c_i) . t_i = 0, nearest to the current position of the run
//! m_i    mean of x_ij over j
//! AT   = max over i of |m_i - c_i|
//! l_ij = |x_ij - m_i|
//! RT   = max over i of (mean over j of l_ij + 3 S_i)        S_i: standard deviation of l_ij, with n - 1
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | AT, RT | accuracy, repeatability of the path | m |
//! | `n` | runs (cycles) | |
//!
//! The first and the last point are not evaluated where a run begins after its plane or ends before it.
//! A run is followed forwards, so that a path may cross or touch itself. Orientation is not evaluated.
//!
//! Source: ISO 9283:1998, 8.2, from memory: read the standard before claiming conformity; `docs/theory/calibration.md`.

use nalgebra::Vector3;

/// Number of cycles required by the standard.
pub const CYCLES: usize = 10;

/// Result of the runs at one commanded point.
#[derive(Clone, Debug, PartialEq)]
pub struct PointAccuracy {
    /// Index of the point, from 0.
    pub index: usize,
    /// Its commanded position, m.
    pub commanded: Vector3<f64>,
    /// Barycentre of the runs less it, m.
    pub offset: Vector3<f64>,
    /// Mean distance of the runs from their barycentre and three standard deviations, m; `None` of one run.
    pub repeatability: Option<f64>,
}

/// Result of the runs of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct PathAccuracy {
    /// Runs.
    pub cycles: usize,
    /// Points that all runs passed.
    pub points: Vec<PointAccuracy>,
    /// Number of points that at least one run did not pass.
    pub not_passed: usize,
}

impl PathAccuracy {
    /// AT, and the index of its point among those evaluated, m; `None` without points.
    pub fn accuracy(&self) -> Option<(usize, f64)> {
        largest(self.points.iter().map(|point| Some(point.offset.norm())))
    }

    /// RT, in the same form; `None` of one run.
    pub fn repeatability(&self) -> Option<(usize, f64)> {
        largest(self.points.iter().map(|point| point.repeatability))
    }
}

/// Why traces cannot be evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PathRefusal {
    /// A path needs at least two points, no two in a row equal.
    #[error("the commanded path has {0} different points in a row: at least 2 are needed")]
    Short(usize),
    /// No run.
    #[error("no run is given")]
    NoRun,
    /// A run of fewer than two points.
    #[error("run number {} has {points} points: at least 2 are needed", .run + 1)]
    ShortRun {
        /// From 0.
        run: usize,
        /// Its points.
        points: usize,
    },
    /// No commanded point that all runs passed.
    #[error("no point of the commanded path is passed by all runs")]
    Elsewhere,
}

/// Accuracy and repeatability of `runs` of the path through `commanded`, both in the same axes, m.
///
/// # Errors
/// See [`PathRefusal`].
pub fn path_accuracy(
    commanded: &[Vector3<f64>],
    runs: &[Vec<Vector3<f64>>],
) -> Result<PathAccuracy, PathRefusal> {
    // A point that is given twice in a row has no tangent.
    let is_new = |index: &usize| *index == 0 || commanded[*index] != commanded[*index - 1];
    let given: Vec<usize> = (0..commanded.len()).filter(is_new).collect();
    let path: Vec<Vector3<f64>> = given.iter().map(|index| commanded[*index]).collect();
    if path.len() < 2 {
        return Err(PathRefusal::Short(path.len()));
    }
    if runs.is_empty() {
        return Err(PathRefusal::NoRun);
    }
    if let Some((run, trace)) = runs.iter().enumerate().find(|(_, trace)| trace.len() < 2) {
        let points = trace.len();
        return Err(PathRefusal::ShortRun { run, points });
    }
    let tangents = tangents(&path);
    let passed: Vec<Vec<Option<Vector3<f64>>>> =
        runs.iter().map(|trace| passes(&path, &tangents, trace)).collect();
    let mut points = Vec::new();
    for (index, at) in path.iter().enumerate() {
        let here: Option<Vec<Vector3<f64>>> = passed.iter().map(|run| run[index]).collect();
        points.extend(here.map(|here| of_point(given[index], at, &here)));
    }
    if points.is_empty() {
        return Err(PathRefusal::Elsewhere);
    }
    Ok(PathAccuracy {
        cycles: runs.len(),
        not_passed: path.len() - points.len(),
        points,
    })
}

fn of_point(index: usize, commanded: &Vector3<f64>, here: &[Vector3<f64>]) -> PointAccuracy {
    let count = here.len() as f64;
    let barycentre = here.iter().sum::<Vector3<f64>>() / count;
    let distances: Vec<f64> = here.iter().map(|x| (x - barycentre).norm()).collect();
    let mean = distances.iter().sum::<f64>() / count;
    let squares: f64 = distances.iter().map(|l| (l - mean).powi(2)).sum();
    PointAccuracy {
        index,
        commanded: *commanded,
        offset: barycentre - commanded,
        repeatability: (here.len() > 1).then(|| mean + 3.0 * (squares / (count - 1.0)).sqrt()),
    }
}

/// Unit tangents: half-way between the straight pieces before and after a point; at a corner that turns back, that
/// after.
fn tangents(path: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let pieces: Vec<Vector3<f64>> = path
        .windows(2)
        .map(|ends| (ends[1] - ends[0]).normalize())
        .collect();
    let last = pieces.len() - 1;
    let at = |index: usize| {
        let [before, behind] = [pieces[index.saturating_sub(1)], pieces[index.min(last)]];
        (before + behind).try_normalize(1e-6).unwrap_or(behind)
    };
    (0..path.len()).map(at).collect()
}

/// Where a trace passes the plane of each point; `None` where it does not.
///
/// A trace may begin before the first plane and end after the last. Of its pieces that cross a plane forwards the one
/// nearest to the point is used, as long as the trace since the point before is no longer than `AHEAD` times the path
/// there: a later lap is another pass. At first the earliest pass of equally near ones is used.
fn passes(
    path: &[Vector3<f64>],
    tangents: &[Vector3<f64>],
    trace: &[Vector3<f64>],
) -> Vec<Option<Vector3<f64>>> {
    let crossing = |k: usize, at: &Vector3<f64>, tangent: &Vector3<f64>| {
        let [before, behind] = [trace[k], trace[k + 1]].map(|x| (x - at).dot(tangent));
        let forwards = before <= 0.0 && behind >= 0.0 && behind > before;
        forwards.then(|| trace[k] + (trace[k + 1] - trace[k]) * (before / (before - behind)))
    };
    // The piece of the last pass, and the length of the path since.
    let mut from: Option<usize> = None;
    let mut since = 0.0;
    let mut found = Vec::with_capacity(path.len());
    for (index, (at, tangent)) in path.iter().zip(tangents).enumerate() {
        let piece = (at - path[index.saturating_sub(1)]).norm();
        since += piece;
        let near = |k: &usize| match from {
            None => true,
            Some(from) => {
                let step = (trace[from + 1] - trace[from]).norm();
                (trace[*k] - trace[from]).norm() <= AHEAD * since + step
            }
        };
        let ahead = (from.unwrap_or(0)..trace.len() - 1).take_while(near);
        let crossings: Vec<(usize, Vector3<f64>)> = ahead
            .filter_map(|k| Some((k, crossing(k, at, tangent)?)))
            .collect();
        let away = |(_, x): &(usize, Vector3<f64>)| (x - at).norm();
        let least = crossings.iter().map(away).fold(f64::MAX, f64::min);
        let pass = match from {
            Some(_) => crossings.iter().find(|one| away(one) <= least),
            None => {
                let as_near = (2.0 * least).max((path[1] - path[0]).norm());
                crossings.iter().find(|one| away(one) <= as_near)
            }
        };
        if let Some((k, _)) = pass {
            (from, since) = (Some(*k), 0.0);
        }
        found.push(pass.map(|(_, x)| *x));
    }
    found
}

/// Permitted length of a run since the point before, relative to the path: overshoot and corners.
const AHEAD: f64 = 3.0;

/// Distances that differ by less than this, relative, differ only by rounding.
const SAME: f64 = 1e-9;

/// The largest of those that are reported, and its index; of equal ones the first, on every machine.
fn largest(values: impl Iterator<Item = Option<f64>>) -> Option<(usize, f64)> {
    let given = values
        .enumerate()
        .filter_map(|(place, value)| Some((place, value?)));
    given.reduce(|most, here| {
        if here.1 > most.1 * (1.0 + SAME) {
            here
        } else {
            most
        }
    })
}

#[cfg(test)]
mod tests;
