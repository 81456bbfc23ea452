//! Deviation over depth and feed, at the points of a program with the smallest permitted values.

use super::point_limits::PointLimits;
use super::varied::{CutLimits, MOST_DEPTH, MOST_FEED, Permitted, Varied, fed};
use crate::load::Cut;
use crate::watch::{Cancelled, Watch};

/// Largest deviation of a path over depth and feed.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthByFeed {
    /// Axial depths, m.
    pub depths: Vec<f64>,
    /// Feeds per tooth, m.
    pub feeds_per_tooth: Vec<f64>,
    /// Largest in-plane deviation of the limiting points, m; one row per depth. Infinite where a tool is pulled
    /// in, or a cut within the tolerance is unstable.
    pub deviations: Vec<f64>,
}

/// Depths and feeds of the sheet.
const SHEET: usize = 24;
/// Number of limiting points: as many with the smallest depth, and as many with the smallest feed.
const DECIDING: usize = 6;
/// The sheet extends to this multiple of the nominal or permitted value, whichever is larger.
const BEYOND: f64 = 1.6;

impl DepthByFeed {
    /// Of the limiting ones of `points`, each with its cut; `None` without a cut.
    ///
    /// # Errors
    /// [`Cancelled`] if the watch cancels.
    pub(super) fn of(
        points: &[PointLimits],
        cut_at: impl FnMut(usize) -> Option<Varied>,
        watch: Watch<'_>,
    ) -> Result<Option<DepthByFeed>, Cancelled> {
        let by = |part: fn(&CutLimits) -> Permitted| {
            let mut found: Vec<(f64, usize)> = points
                .iter()
                .filter_map(|point| point.cut.map(|cut| (part(&cut).value(), point.index)))
                .collect();
            found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            found.truncate(DECIDING);
            found
        };
        let (by_depth, by_feed) = (by(|cut| cut.depth), by(|cut| cut.feed_per_tooth));
        let (Some((least_depth, _)), Some((least_feed, _))) = (by_depth.first(), by_feed.first()) else {
            return Ok(None);
        };
        let mut indices: Vec<usize> = by_depth.iter().chain(&by_feed).map(|(_, index)| *index).collect();
        indices.sort_unstable();
        indices.dedup();
        let mut deciding: Vec<Varied> = indices.into_iter().filter_map(cut_at).collect();
        let drawn = |of: fn(&Cut) -> f64| deciding.iter().map(|here| of(&here.cut)).fold(0.0, f64::max);
        let diameter = 2.0 * deciding.iter().map(|here| here.cutter_radius).fold(0.0, f64::max);
        let reach = |drawn: f64, least: f64, most: f64| (BEYOND * drawn.max(least)).min(most);
        let steps = |most: f64| {
            (1..=SHEET)
                .map(|k| most * k as f64 / SHEET as f64)
                .collect::<Vec<f64>>()
        };
        let depths = steps(reach(drawn(|cut| cut.depth), *least_depth, MOST_DEPTH * diameter));
        let most_feed = reach(
            drawn(|cut| cut.feed.hypot(cut.rise)),
            *least_feed,
            MOST_FEED * diameter,
        );
        let feeds_per_tooth = steps(most_feed);
        let mut deviations = Vec::with_capacity(depths.len() * feeds_per_tooth.len());
        for depth in &depths {
            if watch.is_cancelled() {
                return Err(Cancelled);
            }
            for feed in &feeds_per_tooth {
                let of = |here: &mut Varied| {
                    let cut = Cut {
                        depth: *depth,
                        ..here.cut
                    };
                    let drawn = cut.feed.hypot(cut.rise);
                    here.deviation(&fed(&cut, feed / drawn))
                };
                deviations.push(deciding.iter_mut().map(of).fold(0.0, f64::max));
            }
        }
        Ok(Some(DepthByFeed {
            depths,
            feeds_per_tooth,
            deviations,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{
        CutHere, CutsAlong, Cutter, CuttingLaw, Engagement, GreatestForce, Immersion, LeanInCut, Mechanistic,
        Milling, TipCompliance,
    };
    use crate::map::PermittedForces;
    use crate::map::varied::PointDemand;
    use nalgebra::{Matrix3, Vector3};
    use std::sync::atomic::AtomicBool;

    const MM: f64 = 1e-3;
    const LIMIT: f64 = 10e-6;

    fn law() -> CuttingLaw {
        let shear = Vector3::new(800e6, 300e6, 100e6);
        CuttingLaw::Mechanistic(Mechanistic::new(shear, Vector3::zeros()).unwrap())
    }

    /// A flat cutter of 10 mm, and one of 4 mm.
    fn cutters() -> Vec<Cutter> {
        vec![
            Cutter::flat(10.0 * MM, 2).unwrap(),
            Cutter::flat(4.0 * MM, 2).unwrap(),
        ]
    }

    fn slot(cutter: usize, depth: f64) -> Cut {
        Cut {
            depth,
            engagement: Engagement::of(Immersion::Slot, cutters()[cutter].diameter()).unwrap(),
            feed: 0.05 * MM,
            rise: 0.0,
            lean: LeanInCut::default(),
        }
    }

    fn force(cutter: usize, cut: Cut) -> Vector3<f64> {
        Milling::new(cutters()[cutter], law(), cut).unwrap().mean_force()
    }

    /// Points with these compliances of the tip along the feed (m/N), each with its cutter and depth.
    fn requested(of: &[(f64, usize, f64)]) -> (Vec<PointLimits>, Vec<Option<Varied>>) {
        let mut varied: Vec<Option<Varied>> = of
            .iter()
            .map(|(a, cutter, depth)| {
                let cut = slot(*cutter, *depth);
                let here = CutHere {
                    cutter: *cutter,
                    cut: Some(cut),
                    mean: force(*cutter, cut),
                    greatest: Vector3::zeros(),
                };
                let cuts = CutsAlong {
                    cutters: cutters(),
                    law: law(),
                    greatest: GreatestForce::LeftOut,
                    points: vec![here],
                };
                let tip = TipCompliance {
                    by_force: Matrix3::from_diagonal(&Vector3::new(*a, 0.0, 0.0)),
                    unloaded: Vector3::zeros(),
                };
                let still = PointDemand {
                    tolerance: LIMIT,
                    vibrating: None,
                };
                Varied::of(&cuts, 0, tip, still)
            })
            .collect();
        let forces = PermittedForces {
            along: 1.0,
            across: 1.0,
            normal: 1.0,
            weakest: 1.0,
        };
        let points = varied.iter_mut().enumerate().map(|(index, varied)| PointLimits {
            index,
            forces,
            cut: varied.as_mut().map(Varied::limits),
        });
        (points.collect(), varied)
    }

    fn of(points: &[(f64, usize, f64)]) -> DepthByFeed {
        let (points, mut varied) = requested(points);
        let found = DepthByFeed::of(&points, |index| varied[index].take(), Watch::NONE);
        found.unwrap().unwrap()
    }

    #[test]
    fn deviation_is_proportional_to_depth_times_feed_where_the_force_is() {
        let a = 2e-7;
        let sheet = of(&[(a, 0, MM)]);
        let unit = a * force(0, slot(0, MM)).x.abs() / (MM * 0.05 * MM);
        for (row, depth) in sheet.depths.iter().enumerate() {
            for (column, feed) in sheet.feeds_per_tooth.iter().enumerate() {
                let found = sheet.deviations[row * sheet.feeds_per_tooth.len() + column];
                let expected = unit * depth * feed;
                assert!((found / expected - 1.0).abs() < 1e-12, "{depth} {feed}: {found}");
            }
        }
        assert_eq!(
            sheet.deviations.len(),
            sheet.depths.len() * sheet.feeds_per_tooth.len()
        );
    }

    #[test]
    fn the_sheet_starts_near_zero_and_extends_beyond_nominal_and_permitted_values() {
        for a in [5e-8, 2e-6] {
            let (points, _) = requested(&[(a, 0, MM)]);
            let cut = points[0].cut.unwrap();
            let sheet = of(&[(a, 0, MM)]);
            let reaches = |all: &[f64], drawn: f64, permitted: Permitted, most: f64| {
                let expected = (BEYOND * drawn.max(permitted.value())).min(most);
                let last = all[all.len() - 1];
                let even = all
                    .windows(2)
                    .all(|pair| (pair[1] - pair[0] - all[0]).abs() < 1e-9 * last);
                assert!(even && (last / expected - 1.0).abs() < 1e-9, "{last} {expected}");
            };
            reaches(&sheet.depths, MM, cut.depth, 30.0 * MM);
            reaches(&sheet.feeds_per_tooth, 0.05 * MM, cut.feed_per_tooth, 0.5 * MM);
        }
    }

    #[test]
    fn with_tools_of_two_sizes_the_worst_point_is_used_at_each_depth_and_feed() {
        let (wide, thin) = ((2e-7, 0, MM), (3e-7, 1, 0.5 * MM));
        let (both, of_thin) = (of(&[wide, thin]), of(&[thin]));
        let unit = |(a, cutter, depth): (f64, usize, f64)| {
            a * force(cutter, slot(cutter, depth)).x.abs() / (depth * 0.05 * MM)
        };
        let worst = unit(wide).max(unit(thin));
        for (row, depth) in both.depths.iter().enumerate() {
            let found = both.deviations[row * both.feeds_per_tooth.len()];
            let expected = worst * depth * both.feeds_per_tooth[0];
            // No tool cuts deeper than a hundred diameters; none is that deep here.
            assert!(
                (found / expected - 1.0).abs() < 1e-12,
                "{depth}: {found} {expected}"
            );
        }
        assert!(of_thin.depths.last() <= both.depths.last());
    }

    #[test]
    fn a_point_above_all_limiting_points_changes_nothing() {
        // Six points with the smallest depth are limiting, and as many for the feed: here the same ones.
        let soft: Vec<_> = (0..DECIDING).map(|k| (2e-7 + 1e-9 * k as f64, 0, MM)).collect();
        let with_stiff = [&soft[..], &[(1e-8, 0, MM)]].concat();
        assert_eq!(of(&with_stiff), of(&soft));
    }

    #[test]
    fn without_a_cut_there_is_no_sheet_and_the_computation_can_be_cancelled() {
        assert_eq!(DepthByFeed::of(&[], |_| None, Watch::NONE), Ok(None));
        let (points, mut varied) = requested(&[(2e-7, 0, MM)]);
        let cancel = AtomicBool::new(true);
        let watch = Watch {
            cancel: &cancel,
            ..Watch::NONE
        };
        let stopped = DepthByFeed::of(&points, |index| varied[index].take(), watch);
        assert_eq!(stopped, Err(Cancelled));
    }
}
