//! Which path must be commanded so that the tool goes where it is drawn?
//!
//! ```text
//! x_cmd = x - delta(x_cmd)          fixed point: x_0 = x, x_(n+1) = x - delta(x_n)
//! rho   = max |x_(n+1) - x_n| / max |x_n - x_(n-1)|
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `x`, `x_cmd` | path as drawn and as commanded | m |
//! | `delta` | predicted deviation there, under the forces of the path as drawn: the tool cuts what is drawn | m |
//! | `rho` | contraction; below one each round brings the path nearer | - |
//!
//! The deviation changes with the posture alone, by some percent over a hand's breadth, so `rho` is about the deviation
//! over the reach: two rounds are enough. Only the place of the tip is moved, its axis stays. Of several load cases one
//! path can meet one alone: their mean. What the others leave is the residual, told with the rest.

use nalgebra::Vector3;

use crate::kernel::{Answers, BranchChoice, Question};
use crate::load::{LoadFrame, PathLoad};
use crate::map::{AlongPath, along_postures};
use crate::path::Track;
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// How far the fixed point is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensation {
    /// It rests where no point moves by more than this in a round, m.
    pub rest: f64,
    /// Rounds at most.
    pub rounds: usize,
}

/// A path that makes up for what it will deviate by.
#[derive(Clone, Debug)]
pub struct Compensated {
    /// The path to be commanded; forces and feed frames are those of the drawing.
    pub track: Track,
    /// What the tool deviates by from the commanded path.
    pub along: AlongPath,
    /// What is left: deviation from the drawn path under each load case, m, base; as many a point as there are cases. Zeros
    /// where there is no posture.
    pub residual: Vec<Vector3<f64>>,
    /// Rounds that were done.
    pub rounds: usize,
    /// Largest move of the last round, m; zero of none.
    pub last_move: f64,
    /// The last contraction; `None` of fewer than two rounds.
    pub contraction: Option<f64>,
    /// Points without posture on the way, which stay where they are drawn.
    pub unmoved: usize,
}

impl Compensation {
    /// As finely as programs are written: a tenth of a micrometre, in ten rounds at the most.
    pub const USUAL: Compensation = Compensation {
        rest: 1e-7,
        rounds: 10,
    };

    /// Nothing is made up for: the path is commanded as it is drawn.
    pub const NONE: Compensation = Compensation { rest: 0.0, rounds: 0 };
}

/// The path to be commanded for `track` under `load`, in these branches ([`along_postures`]).
///
/// Of cuts the forces are those of the path as drawn: where the tool is brought back to the drawing, it meets them.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
///
/// # Panics
/// If the load does not [cover](PathLoad::covers) the points of the track.
pub fn compensated(
    question: &Question<'_>,
    (track, load): (&Track, &PathLoad),
    choices: &[(usize, BranchChoice)],
    requested: Compensation,
    watch: Watch<'_>,
) -> Result<Compensated, Cancelled> {
    let load = nominal(load);
    let follow = |track: &Track| along_postures(question, (track, load.clone()), choices.to_vec(), watch);
    let path_from_base = track.placing.base_from_path.rotation.inverse();
    let mut commanded = track.clone();
    let mut along = follow(&commanded)?;
    let (mut rounds, mut last_move, mut contraction) = (0, 0.0, None);
    while rounds < requested.rounds && (rounds == 0 || last_move > requested.rest) {
        let mut moved = 0.0_f64;
        for (index, _) in along.answers.evaluation() {
            let delta = path_from_base * mean(&along.answers, index);
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
        unmoved: track.len() - along.answers.evaluation().count(),
        track: commanded,
        along,
        rounds,
        last_move,
        contraction,
    })
}

/// What is left where another path is commanded in place of the drawn one: along it, and the deviation from the drawn
/// path, as [`Compensated::residual`].
///
/// # Errors
/// [`Cancelled`] if the watch says so.
///
/// # Panics
/// If the two differ in their number of points, or the load does not [cover](PathLoad::covers) them.
pub fn left_by(
    question: &Question<'_>,
    (drawn, commanded): (&Track, &Track),
    (load, choices): (&PathLoad, &[(usize, BranchChoice)]),
    watch: Watch<'_>,
) -> Result<(AlongPath, Vec<Vector3<f64>>), Cancelled> {
    assert_eq!(drawn.len(), commanded.len(), "a command for each point");
    let along = along_postures(question, (commanded, nominal(load)), choices.to_vec(), watch)?;
    let residual = residual(drawn, commanded, &along.answers);
    Ok((along, residual))
}

/// Deviation from the drawn path, m, base: what the tool deviates by, and what the command was moved by.
fn residual(drawn: &Track, commanded: &Track, answers: &Answers) -> Vec<Vector3<f64>> {
    let mut residual = vec![Vector3::zeros(); answers.deviations.len()];
    for (index, _) in answers.evaluation() {
        let moved = commanded.path.points[index].at - drawn.path.points[index].at;
        let moved = drawn.placing.base_from_path.rotation * moved;
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

/// The load with forces that do not give way. Of a cut the mean force alone: the greatest of a revolution is over before
/// the arm has moved.
fn nominal(load: &PathLoad) -> PathLoad {
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
