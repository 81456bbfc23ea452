//! The vibration at every point: lowest mode of the arm, stable depth of the cut, and the vibration under its teeth.
//!
//! ```text
//! lowest mode      least frequency of the arm in the posture of the point
//! stable depth     limit of the depth at the spindle speed, of mean directional factors, with the modes of arm and tool
//! vibration        max |u - mean u| across the tool in a period of the teeth; error of the wall, without its mean
//! ```
//!
//! Units: m, rad/s. Theory: `docs/theory/modes.md`, `docs/theory/stability.md`.

use std::ops::Range;

use armill_core::dynamics::Mode;
use armill_core::kernel::Answers;
use armill_core::load::{Cut, Cutter};
use armill_core::robot::Robot;
use armill_core::source::ArmState;
use armill_core::stability::named_mode::modes;
use armill_core::stability::{Boundary, CutOfAnyDepth, Forced, StabilityLobes, ToothForces, WallSide};
use rayon::prelude::*;

use super::arm_modes::{at_tip, has_modes};
use super::worst::WorstCut;
use crate::input::setting::Setting;
use crate::input::vibration::CutAtPoint;

/// Gives the cut at a point, if there is one.
pub type CutAt<'a> = dyn Fn(usize) -> Option<CutAtPoint> + Send + Sync + 'a;

/// The cuts of a series of points.
pub struct Cuts<'a> {
    /// The cut at each point.
    pub at: Box<CutAt<'a>>,
    /// Whether the vibration under the teeth is evaluated in addition to the stability.
    pub are_followed: bool,
}

/// The vibration at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointVibration {
    /// Lowest mode of the arm, rad/s; none without modes of the arm.
    pub lowest: Option<f64>,
    /// That of the cut; none where nothing is cut.
    pub cut: Option<CutVibration>,
}

/// Stability of a cut at a point, and its vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutVibration {
    /// Programmed depth, m.
    pub depth: f64,
    /// Limit of the depth; none if it is deeper than `deepest`.
    pub limit: Option<Boundary>,
    /// Deepest limit that was sought, m.
    pub deepest: f64,
    /// The vibration under the teeth, if it is evaluated.
    pub forced: Option<ForcedVibration>,
}

/// Vibration under the teeth at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForcedVibration {
    /// Largest distance across the tool of the tip from its mean position, m.
    pub amplitude: f64,
    /// Error of the wall by it, the largest over the depth by size, positive where the wall is deeper in the part, m; none without a wall.
    pub wall: Option<f64>,
}

/// The vibration at the points of a series.
#[derive(Clone, Debug, Default)]
pub struct SeriesVibration {
    /// At each point; none without a posture.
    pub points: Vec<Option<PointVibration>>,
    /// The point whose cut is nearest to its limit; none without a cut.
    pub worst: Option<WorstCut>,
}

impl CutVibration {
    /// The stable depth, at most the deepest that was sought, m.
    pub fn stable_depth(&self) -> f64 {
        self.limit.map_or(self.deepest, |limit| limit.depth)
    }

    /// Whether the programmed depth is below its limit.
    pub fn is_stable(&self) -> bool {
        self.limit.is_none_or(|limit| limit.depth > self.depth)
    }

    /// Programmed depth over stable depth.
    pub fn utilisation(&self) -> f64 {
        self.depth / self.stable_depth()
    }
}

impl SeriesVibration {
    /// At the points of these answers; none if the study does not ask for the vibration. `cuts`: none without a cut.
    pub fn of(
        robot: &Robot,
        setting: &Setting,
        answers: &Answers,
        cuts: Option<&Cuts<'_>>,
    ) -> Option<SeriesVibration> {
        let points = SeriesVibration::points(robot, setting, answers, cuts)?;
        let worst = nearest_to_its_limit(&points).zip(cuts).and_then(|(index, cuts)| {
            let cut = (cuts.at)(index)?;
            WorstCut::of(robot, setting, answers.joints_at(index), index, cut)
        });
        Some(SeriesVibration { points, worst })
    }

    /// The points alone.
    fn points(
        robot: &Robot,
        setting: &Setting,
        answers: &Answers,
        cuts: Option<&Cuts<'_>>,
    ) -> Option<Vec<Option<PointVibration>>> {
        let vibration = setting.vibration.as_ref()?;
        let of_tool = modes(&vibration.tool_modes);
        let of_point = |arm: &[Mode], last: &mut LastCut, index: usize| PointVibration {
            lowest: arm.first().map(|mode| mode.angular_frequency),
            cut: cuts.and_then(|cuts| {
                let cut = (cuts.at)(index)?;
                let all = at_tip(arm, &of_tool, &cut.base_from_feed);
                cut_vibration(&all, &cut, last.forces(&cut, cuts.are_followed))
            }),
        };
        Some(of_modes(
            robot,
            setting,
            answers,
            0..answers.points.len(),
            &of_point,
        ))
    }

    /// The cuts that are not stable.
    pub fn unstable(&self) -> usize {
        self.cuts().filter(|(_, cut)| !cut.is_stable()).count()
    }

    /// The points with a cut.
    pub fn cuts(&self) -> impl Iterator<Item = (usize, CutVibration)> {
        let points = self.points.iter().enumerate();
        points.filter_map(|(index, point)| Some((index, point.as_ref()?.cut?)))
    }
}

/// Stability of the cuts of a series, without the vibration under the teeth and without uncertainty.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CutStability {
    /// Points whose cut is not stable.
    pub unstable: usize,
    /// The cut that is nearest to its limit.
    pub worst: Option<CutVibration>,
}

impl CutStability {
    /// Of these cuts at the points of these answers; none if the study does not ask for the vibration.
    pub fn of(robot: &Robot, setting: &Setting, answers: &Answers, cuts: &Cuts<'_>) -> Option<CutStability> {
        let points = SeriesVibration::points(robot, setting, answers, Some(cuts))?;
        let of_cuts = points.iter().flatten().filter_map(|point| point.cut);
        Some(CutStability {
            unstable: of_cuts.filter(|cut| !cut.is_stable()).count(),
            worst: nearest_to_its_limit(&points).and_then(|index| points[index]?.cut),
        })
    }
}

/// The point with the largest programmed depth over its stable depth; the first of equal ones.
fn nearest_to_its_limit(points: &[Option<PointVibration>]) -> Option<usize> {
    let of_cut =
        |(index, point): (usize, &Option<PointVibration>)| Some((index, point.as_ref()?.cut?.utilisation()));
    let with_cut = points.iter().enumerate().filter_map(of_cut);
    let most = with_cut.reduce(|most, other| if other.1 > most.1 { other } else { most });
    most.map(|(index, _)| index)
}

/// Forces of the teeth of the last cut: consecutive points mostly have the same cut.
#[derive(Default)]
struct LastCut {
    last: Option<((Cutter, Cut), Option<ToothForces>)>,
}

impl LastCut {
    fn forces(&mut self, cut: &CutAtPoint, are_followed: bool) -> Option<&ToothForces> {
        if !are_followed {
            return None;
        }
        let key = (*cut.milling.cutter(), *cut.milling.cut());
        if self.last.as_ref().is_none_or(|(known, _)| *known != key) {
            self.last = Some((key, ToothForces::new(&cut.milling).ok()));
        }
        self.last.as_ref().and_then(|(_, forces)| forces.as_ref())
    }
}

/// Stability and vibration of a cut with these modes; `None` without modes, or where the cut is not possible.
fn cut_vibration(all: &[Mode], cut: &CutAtPoint, forces: Option<&ToothForces>) -> Option<CutVibration> {
    if all.is_empty() {
        return None;
    }
    let deepest = cut.deepest_sought();
    let lobes = StabilityLobes::new(all, &CutOfAnyDepth::new(&cut.milling), deepest).ok()?;
    let forced = forces.map(|forces| {
        let forced = Forced::under(forces, all, cut.spindle).without_mean();
        let walls = WallSide::of(&cut.milling).map(|side| forced.surface_error(side).largest());
        ForcedVibration {
            amplitude: forced.largest_in_plane(),
            wall: walls.reduce(|a, b| if b.abs() > a.abs() { b } else { a }),
        }
    });
    Some(CutVibration {
        depth: cut.milling.cut().depth,
        limit: lobes.at_speed(cut.spindle).filter(|limit| limit.depth <= deepest),
        deepest,
        forced,
    })
}

/// What `value` gives for the modes of the arm (shapes at the tool, axes of base) at each of these points with a posture; `S` is kept from point to point of
/// a thread.
pub(in crate::analysis) fn of_modes<S: Default, T: Send>(
    robot: &Robot,
    setting: &Setting,
    answers: &Answers,
    points: Range<usize>,
    value: &(dyn Fn(&[Mode], &mut S, usize) -> T + Sync),
) -> Vec<Option<T>> {
    let moves = has_modes(robot, setting);
    let at = |(state, kept): &mut (ArmState<'_>, S), index: usize| {
        answers.points[index].as_ref().ok()?;
        let mut arm: Vec<Mode> = Vec::new();
        if moves {
            state.set_joints(answers.joints_at(index));
            let found = state.modes().ok()?;
            arm.extend(found.modes.iter().map(|mode| mode.at_tool));
        }
        Some(value(&arm, kept, index))
    };
    let state = || (ArmState::new(setting.arm(robot)), S::default());
    points.into_par_iter().map_init(state, at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_takes_no_more_memory_than_is_estimated() {
        // Of 152 bytes in `input/memory.rs`.
        assert!(
            size_of::<Option<PointVibration>>() <= 152,
            "{}",
            size_of::<Option<PointVibration>>()
        );
    }
}
