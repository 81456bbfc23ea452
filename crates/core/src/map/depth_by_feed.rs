//! How far a tool deviates over depth and feed, at the points of a program that permit least.

use super::limits::PointLimits;
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
    /// Largest in-plane deviation of the points that decide, m; one row a depth. Infinite where a tool is drawn in.
    pub deviations: Vec<f64>,
}

/// Depths and feeds of the sheet.
const SHEET: usize = 24;
/// Points that decide on the sheet: as many that permit the least depth, and as many that permit the least feed.
const DECIDING: usize = 6;
/// The sheet reaches to this many times what is drawn or permitted, whichever is more.
const BEYOND: f64 = 1.6;

impl DepthByFeed {
    /// Of those `points` that permit least, each with its cut; `None` without a cut.
    ///
    /// # Errors
    /// [`Cancelled`] if the watch says so.
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
