//! Compensation: the path to be commanded so that the tool follows the nominal path.
//!
//! ```text
//! x_cmd = x - delta(x_cmd)          fixed point: x_0 = x, x_(n+1) = x - delta(x_n)
//! rho   = max |x_(n+1) - x_n| / max |x_n - x_(n-1)|
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `x`, `x_cmd` | nominal and commanded path | m |
//! | `delta` | predicted deviation there, under the forces of the nominal path: the tool removes the nominal material | m |
//! | `rho` | contraction; below one every iteration reduces the error | - |
//!
//! The deviation depends only on the posture. It changes by a few percent over 100 mm, so `rho` is about the deviation
//! divided by the reach: two iterations are enough. Only the position of the tip is changed, not its axis. One path can
//! compensate only one of several load cases: the mean of all is used. The remaining deviation of each load case is the
//! residual.
//!
//! Where only the surface counts, `x_cmd = x - P delta(x_cmd)` with a projector `P` at each point ([`surface_directions`](crate::machined::surface_directions)).

use nalgebra::{Matrix3, Vector3};

use crate::kernel::{Answers, BranchChoice, Question};
use crate::load::{LoadFrame, PathLoad};
use crate::map::{AlongPath, along_postures};
use crate::path::{LoadedTrack, Track};
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// Settings of the fixed-point iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensation {
    /// Converged if no point moves by more than this in an iteration, m.
    pub rest: f64,
    /// Maximum number of iterations.
    pub rounds: usize,
}

/// A path that compensates the predicted deviation.
#[derive(Clone, Debug)]
pub struct Compensated {
    /// The commanded path; forces and feed frames are those of the nominal path.
    pub track: Track,
    /// Deviations of the tool from the commanded path.
    pub along: AlongPath,
    /// Residual: deviation from the nominal path under each load case, m, base; one value per case and point. Zeros
    /// where there is no posture.
    pub residual: Vec<Vector3<f64>>,
    /// Number of iterations.
    pub rounds: usize,
    /// Largest change in the last iteration, m; zero without iterations.
    pub last_move: f64,
    /// Contraction of the last iteration; `None` for fewer than two iterations.
    pub contraction: Option<f64>,
    /// Points without a posture on the way; they keep their nominal position.
    pub unmoved: usize,
}

impl Compensation {
    /// The resolution of programs: a tenth of a micrometre, in at most ten iterations.
    pub const USUAL: Compensation = Compensation {
        rest: 1e-7,
        rounds: 10,
    };

    /// No compensation: the nominal path is commanded.
    pub const NONE: Compensation = Compensation { rest: 0.0, rounds: 0 };
}

/// The path to be commanded for `path`, in these branches ([`along_postures`]).
///
/// The forces of cuts are those of the nominal path: with compensation, the tool removes the nominal material.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the load does not [cover](PathLoad::covers) the points of the track.
pub fn compensated(
    question: &Question<'_>,
    path: LoadedTrack<'_>,
    choices: &[(usize, BranchChoice)],
    requested: Compensation,
    watch: Watch<'_>,
) -> Result<Compensated, Cancelled> {
    compensated_along(question, path, choices, (requested, None), watch)
}

/// [`compensated`] in these directions alone: a projector for each point, path axes.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the load does not [cover](PathLoad::covers) the points of the track, or there are fewer projectors than points.
pub fn compensated_along(
    question: &Question<'_>,
    path: LoadedTrack<'_>,
    choices: &[(usize, BranchChoice)],
    (requested, directions): (Compensation, Option<&[Matrix3<f64>]>),
    watch: Watch<'_>,
) -> Result<Compensated, Cancelled> {
    let (track, load) = (path.track, nominal_load(path.load));
    let follow = |track: &Track| along_postures(question, track, load.clone(), choices.to_vec(), watch);
    let path_from_base = track.placing.base_from_path.rotation.inverse();
    let mut commanded = track.clone();
    let mut along = follow(&commanded)?;
    let (mut rounds, mut last_move, mut contraction) = (0, 0.0, None);
    while rounds < requested.rounds && (rounds == 0 || last_move > requested.rest) {
        let mut moved = 0.0_f64;
        for (index, _) in along.answers.evaluations() {
            let delta = path_from_base * mean(&along.answers, index);
            let delta = directions.map_or(delta, |directions| directions[index] * delta);
            let to = track.path.points[index].at - delta;
            let at = &mut commanded.path.points[index].at;
            moved = moved.max((to - *at).norm());
            *at = to;
        }
        contraction = (rounds > 0).then_some(moved / last_move);
        rounds += 1;
        last_move = moved;
        along = follow(&commanded)?;
    }
    Ok(Compensated {
        residual: residual(track, &commanded, &along.answers),
        unmoved: track.len() - along.answers.evaluations().count(),
        track: commanded,
        along,
        rounds,
        last_move,
        contraction,
    })
}

/// Residual where another path is commanded instead of the nominal one: the answers along it, and the deviation from
/// the nominal path as in [`Compensated::residual`].
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the two differ in their number of points, or the load does not [cover](PathLoad::covers) them.
pub fn residual_of(
    question: &Question<'_>,
    nominal: LoadedTrack<'_>,
    commanded: &Track,
    choices: &[(usize, BranchChoice)],
    watch: Watch<'_>,
) -> Result<(AlongPath, Vec<Vector3<f64>>), Cancelled> {
    let LoadedTrack { track, load } = nominal;
    assert_eq!(track.len(), commanded.len(), "a command for each point");
    let along = along_postures(question, commanded, nominal_load(load), choices.to_vec(), watch)?;
    let residual = residual(track, commanded, &along.answers);
    Ok((along, residual))
}

/// Deviation from the nominal path, m, base: the deviation of the tool plus the offset of the command.
fn residual(nominal: &Track, commanded: &Track, answers: &Answers) -> Vec<Vector3<f64>> {
    let mut residual = vec![Vector3::zeros(); answers.deviations.len()];
    for (index, _) in answers.evaluations() {
        let moved = commanded.path.points[index].at - nominal.path.points[index].at;
        let moved = nominal.placing.base_from_path.rotation * moved;
        let of_point = index * answers.case_count..(index + 1) * answers.case_count;
        for (left, deviation) in residual[of_point].iter_mut().zip(answers.deviations_at(index)) {
            *left = moved + deviation;
        }
    }
    residual
}

/// Mean deviation of the load cases at a point; of a cut that of its mean force.
fn mean(answers: &Answers, index: usize) -> Vector3<f64> {
    let deviations = answers.deviations_at(index);
    deviations.iter().sum::<Vector3<f64>>() / deviations.len() as f64
}

/// The load without force-deflection coupling. Of a cut only the mean force: the peak of a revolution is too short for
/// the arm to follow.
fn nominal_load(load: &PathLoad) -> PathLoad {
    match load {
        PathLoad::Cuts(cuts) => PathLoad::OfEach {
            cases: 1,
            frame: LoadFrame::Feed,
            wrenches: cuts
                .points
                .iter()
                .map(|here| Wrench::from_force(here.mean))
                .collect(),
        },
        given => given.clone(),
    }
}

#[cfg(test)]
mod tests;
