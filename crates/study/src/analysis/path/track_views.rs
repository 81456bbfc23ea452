//! From where a tool path is seen: along its z axis, or, if a part is milled from several sides (3+2 axes), along each
//! direction of the tool.

use std::ops::Range;

use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::path::Track;
use armill_core::units::to_mm;

/// Directions that differ by less than about 2 deg are one (sine of the angle).
const SAME: f64 = 0.035;
/// A path with more directions than this is seen along z alone: the tool leans all the time.
const MOST: usize = 4;

/// A view of a path, and what is seen in it.
pub(super) struct TrackView {
    /// Horizontal and vertical axis of the picture, path axes.
    across: [Vector3<f64>; 2],
    /// Labels of the axes, without unit.
    pub labels: [&'static str; 2],
    /// The tool, from the tip towards the spindle, path axes; `None` if it is the only view.
    pub along: Option<Unit<Vector3<f64>>>,
    /// Stretches without rapids.
    pub stretches: Vec<Range<usize>>,
}

impl TrackView {
    /// The views of this path.
    pub fn all(track: &Track) -> Vec<TrackView> {
        let stretches = || track.path.stretches();
        let axis = |index: usize| track.placing.path_spindle(&track.path.points[index]);
        let is_same =
            |a: &Unit<Vector3<f64>>, b: &Unit<Vector3<f64>>| a.dot(b) > 0.0 && a.cross(b).norm() < SAME;
        let mut views: Vec<TrackView> = Vec::new();
        for stretch in stretches() {
            let along = axis(stretch.start);
            if stretch.clone().any(|index| !is_same(&axis(index), &along)) {
                return vec![TrackView::from_above(stretches().collect())];
            }
            let is_known = |view: &&mut TrackView| view.along.is_some_and(|known| is_same(&known, &along));
            match views.iter_mut().find(is_known) {
                Some(view) => view.stretches.push(stretch),
                None => views.push(TrackView::along(along, vec![stretch])),
            }
        }
        match (2..=MOST).contains(&views.len()) {
            true => views,
            false => vec![TrackView::from_above(stretches().collect())],
        }
    }

    fn from_above(stretches: Vec<Range<usize>>) -> TrackView {
        TrackView {
            across: [Vector3::x(), Vector3::y()],
            labels: ["path x", "path y"],
            along: None,
            stretches,
        }
    }

    fn along(along: Unit<Vector3<f64>>, stretches: Vec<Range<usize>>) -> TrackView {
        let level = Vector3::z().cross(&along);
        let is_from_above = level.norm() < SAME;
        let (across, labels) = match is_from_above {
            true => ([Vector3::x(), Vector3::y()], ["path x", "path y"]),
            false => {
                let level = level.normalize();
                (
                    [level, along.cross(&level)],
                    ["across the tool, level", "across the tool, upwards"],
                )
            }
        };
        TrackView {
            across,
            labels,
            along: Some(along),
            stretches,
        }
    }

    /// Where a point of the path is in the picture, mm.
    pub fn at_mm(&self, point: &Point3<f64>) -> [f64; 2] {
        self.across.map(|axis| to_mm(point.coords.dot(&axis)))
    }

    /// Whether a point of the path is seen in this view.
    pub fn shows(&self, index: usize) -> bool {
        self.stretches.iter().any(|stretch| stretch.contains(&index))
    }

    /// Largest extent of what is seen, mm.
    pub fn size_mm(&self, point: impl Fn(usize) -> Point3<f64>) -> f64 {
        let places = || {
            self.stretches
                .iter()
                .cloned()
                .flatten()
                .map(|index| self.at_mm(&point(index)))
        };
        let extent = |axis: usize| {
            let low = places().map(|at| at[axis]).fold(f64::INFINITY, f64::min);
            places().map(|at| at[axis]).fold(f64::NEG_INFINITY, f64::max) - low
        };
        extent(0).max(extent(1)).max(0.0)
    }
}
