//! Process limits along a path: force, depth, width and feed that keep the deviation within the tolerance, at single
//! points and on the whole path.
//!
//! ```text
//! |P A f| = e                                  force: along a direction, and in the weakest direction
//! |P (A F(cut) + g)| + d(cut) = e              depth, width or feed of the cut, the others nominal
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `e` | tolerance across the tool | m |
//! | `A`, `g` | compliance of the tip, and its deviation without a cut ([`TipCompliance`]) | m/N, m |
//! | `P` | removes the component along the tool | - |
//! | `d` | vibration across the tool, if modes are given; the cut must then be stable too | m |
//! | `F` | force of the cut at equilibrium ([`crate::load::force_equilibrium`]) | N |
//!
//! A permitted force is computed without other loads: `g` is not included. A permitted cut is computed with `g`
//! (`varied`).
//!
//! Evaluated at points spread over the path, and where the deviation is largest. A limit of the whole path is the
//! smallest of these. If the load changes the arm, no limits are computed.

use nalgebra::Vector3;

use super::along::AlongPath;
use super::depth_by_feed::DepthByFeed;
use super::point_limits::{PermittedForces, PointLimits};
pub use super::varied::{CutLimits, Permitted};
use super::varied::{PointDemand, Varied};
use super::vibrating::Vibrating;
use crate::compliance::{permissible_force, permissible_force_in_worst_direction};
use crate::kernel::Question;
use crate::load::{CutsAlong, PathLoad, TipCompliance};
use crate::path::Track;
use crate::source::ArmState;
use crate::watch::{Cancelled, Watch};

/// Limits along a program.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramLimits {
    /// At each evaluated point, in their order along the path.
    pub points: Vec<PointLimits>,
    /// Depth by feed, all other parameters nominal; `None` without a cut.
    pub depth_by_feed: Option<DepthByFeed>,
}

/// Maximum number of evaluated points, in addition to the worst.
const MAX_POINTS: usize = 300;

/// What the cuts of a program have to meet.
#[derive(Clone, Copy)]
pub struct CutDemand<'a> {
    /// Largest deviation across the tool, m; of a cut with its vibration.
    pub tolerance: f64,
    /// What vibrates at a point, from its index; where it is known, cuts must be stable. `None`: vibration is not considered.
    pub vibrating: Option<&'a dyn Fn(usize) -> Option<Vibrating>>,
}

impl CutDemand<'_> {
    /// Without vibration.
    pub fn of_tolerance(tolerance: f64) -> CutDemand<'static> {
        CutDemand {
            tolerance,
            vibrating: None,
        }
    }

    fn at(&self, index: usize) -> PointDemand {
        PointDemand {
            tolerance: self.tolerance,
            vibrating: self.vibrating.and_then(|at| at(index)),
        }
    }
}

/// The limits of `found`, the answer along `track` to `question`, for this demand; `None` where the load changes
/// the arm.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
pub fn program_limits(
    question: &Question<'_>,
    track: &Track,
    found: &AlongPath,
    demand: CutDemand<'_>,
    watch: Watch<'_>,
) -> Result<Option<ProgramLimits>, Cancelled> {
    if !question.arm.model.is_affine() {
        return Ok(None);
    }
    let cuts = match &found.load {
        PathLoad::Cuts(cuts) => Some(cuts),
        _ => None,
    };
    let mut tips = Tips {
        arm_state: ArmState::new(question.arm),
        track,
        found,
    };
    let mut points = Vec::new();
    for index in requested(found, cuts) {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        let Some(tip) = tips.at(index) else { continue };
        let [along, across, normal, weakest] = forces(&tip, demand.tolerance);
        let here = cuts.map(|cuts| Varied::of(cuts, index, tip, demand.at(index)));
        points.push(PointLimits {
            index,
            forces: PermittedForces {
                along,
                across,
                normal,
                weakest,
            },
            cut: here.flatten().map(|mut here| here.limits()),
        });
    }
    let depth_by_feed = match cuts {
        Some(cuts) => {
            let cut_at = |index| Varied::of(cuts, index, tips.at(index)?, demand.at(index));
            DepthByFeed::of(&points, cut_at, watch)?
        }
        None => None,
    };
    Ok(Some(ProgramLimits {
        points,
        depth_by_feed,
    }))
}

impl ProgramLimits {
    /// The smallest value of `part` over all points; `None` without a cut.
    pub fn least(&self, part: impl Fn(&CutLimits) -> Option<Permitted>) -> Option<(&PointLimits, Permitted)> {
        let of = |point| {
            let point: &PointLimits = point;
            point
                .cut
                .as_ref()
                .and_then(&part)
                .map(|permitted| (point, permitted))
        };
        let all = self.points.iter().filter_map(of);
        all.min_by(|a, b| a.1.value().total_cmp(&b.1.value()))
    }
}

/// Points spread over those that are reached and cut something, and the worst of all.
fn requested(found: &AlongPath, cuts: Option<&CutsAlong>) -> Vec<usize> {
    let cuts_there = |i: usize| cuts.is_none_or(|cuts| cuts.points[i].cut.is_some());
    let open: Vec<usize> = found
        .answers
        .evaluations()
        .map(|(i, _)| i)
        .filter(|i| cuts_there(*i))
        .collect();
    let stride = open.len().div_ceil(MAX_POINTS).max(1);
    let mut requested: Vec<usize> = open.iter().step_by(stride).copied().collect();
    requested.extend(
        found
            .answers
            .worst()
            .map(|(worst, _)| worst)
            .filter(|i| cuts_there(*i)),
    );
    requested.sort_unstable();
    requested.dedup();
    requested
}

/// Compliance of the tip along a program.
struct Tips<'a> {
    arm_state: ArmState<'a>,
    track: &'a Track,
    found: &'a AlongPath,
}

impl Tips<'_> {
    /// Feed frame; `None` where the arm is unstable under its own weight.
    fn at(&mut self, index: usize) -> Option<TipCompliance> {
        self.arm_state.set_joints(self.found.answers.joints_at(index));
        let tip = self.arm_state.tip_compliance().ok()?;
        Some(tip.rotated(&self.track.base_from_feed(index).inverse()))
    }
}

/// Permitted force (N) of a tip along the feed, to its left, along the tool, and in the weakest direction.
fn forces(tip: &TipCompliance, limit: f64) -> [f64; 4] {
    let (a, tool) = (&tip.by_force, Vector3::z_axis());
    let axes = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
    let [forwards, left, along] = axes.map(|axis| permissible_force(a, tool, axis, limit));
    let any = permissible_force_in_worst_direction(a, tool, limit).0;
    [forwards, left, along, any]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::varied::Permitted::{AtLeast, Nothing, UpTo};
    use nalgebra::{Matrix3, Rotation3};

    #[test]
    fn the_weakest_direction_is_that_of_the_largest_singular_value_across_the_tool() {
        let a = Matrix3::new(4.0, 1.0, -0.5, 0.3, 2.0, 1.5, 9.0, -7.0, 8.0) * 1e-7;
        let tip = TipCompliance {
            by_force: a,
            unloaded: Vector3::new(1.0, 2.0, 3.0),
        };
        let limit = 20e-6;
        let [along, across, normal, weakest] = forces(&tip, limit);
        let deviates = |force: Vector3<f64>| (a * force).xy().norm();
        for (axis, permitted) in [along, across, normal].into_iter().enumerate() {
            let deviation = deviates(Vector3::ith(axis, permitted));
            assert!((deviation / limit - 1.0).abs() < 1e-14, "{axis}: {deviation}");
        }
        // Directions half a degree apart about a ball: the error at the weakest direction is the square of that.
        let mut softest = 0.0_f64;
        for turn in 0..360 {
            for rise in 0..=180 {
                let (turn, rise) = (f64::from(turn).to_radians(), f64::from(rise).to_radians());
                let direction = Rotation3::from_euler_angles(0.0, rise, turn) * Vector3::z();
                softest = softest.max(deviates(direction));
            }
        }
        assert!(weakest * softest <= limit * (1.0 + 1e-12));
        assert!(weakest * softest > limit * (1.0 - 1e-3));
    }

    #[test]
    fn a_tip_compliant_only_along_the_tool_permits_any_force() {
        let tip = TipCompliance {
            by_force: Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 1e-6)),
            unloaded: Vector3::zeros(),
        };
        assert_eq!(forces(&tip, 1e-5), [f64::INFINITY; 4]);
    }

    #[test]
    fn the_limit_of_a_program_is_the_smallest_of_its_points_and_none_is_below_all() {
        let forces = PermittedForces {
            along: 1.0,
            across: 1.0,
            normal: 1.0,
            weakest: 1.0,
        };
        let point = |(index, depth): (usize, Option<Permitted>)| PointLimits {
            index,
            forces,
            cut: depth.map(|depth| CutLimits {
                depth,
                width: None,
                feed_per_tooth: AtLeast(1.0),
            }),
        };
        let of = |depths: &[Option<Permitted>]| ProgramLimits {
            points: depths.iter().copied().enumerate().map(point).collect(),
            depth_by_feed: None,
        };
        let least = |limits: &ProgramLimits| {
            let found = limits.least(|cut| Some(cut.depth));
            found.map(|(point, permitted)| (point.index, permitted))
        };
        let some = of(&[Some(AtLeast(3.0)), None, Some(UpTo(0.5)), Some(UpTo(0.4))]);
        assert_eq!(least(&some), Some((3, UpTo(0.4))));
        // No slot has a permitted width.
        assert!(some.least(|cut| cut.width).is_none());
        let with_none = of(&[Some(UpTo(0.4)), Some(Nothing)]);
        assert_eq!(least(&with_none), Some((1, Nothing)));
        assert_eq!(least(&of(&[None, None])), None);
    }
}
