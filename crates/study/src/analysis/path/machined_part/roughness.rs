//! What the teeth leave on a surface in addition to its deviation: marks of the feed, and vibration.
//!
//! ```text
//! R_f = r - sqrt(r^2 - f^2/4)        on faces along the tool
//! R_v <= 2 a
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `R_f` | height of the marks of the teeth along the feed, each an arc of the tool | m |
//! | `r`, `f` | radius of the cutter, feed per tooth | m |
//! | `R_v`, `a` | height by vibration; largest distance of the tool from its mean position across its axis, under its teeth | m |
//!
//! Every tooth of a stable cut leaves the same surface, so that `2 a` is a bound. The mean of a vibration displaces the wall; it is part of the surface error of `[vibration]` and not of the deviation. Runout, wear and built-up
//! edges are not modelled.
//!
//! Source: \[derived\]: arcs of radius `r` at distances `f`.

use armill_core::load::{CutsAlong, PathLoad};
use armill_core::machined::SurfaceDeviation;

use super::run::MachinedPart;
use crate::analysis::path::run::PathResult;
use crate::analysis::vibration::SeriesVibration;

/// A face is along the tool where its normal is this much across it (cosine).
pub(super) const ALONG_TOOL: f64 = 0.5;

/// Of a set of points; none where it is not known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Roughness {
    /// Largest height of the marks of the feed, m.
    pub feed_marks: Option<f64>,
    /// Largest distance of the tool from its mean position, m.
    pub vibration: Option<f64>,
}

/// What the roughness of the faces of a part is evaluated from.
#[derive(Clone, Copy)]
pub struct ToothMarks<'a> {
    part: &'a MachinedPart,
    cuts: Option<&'a CutsAlong>,
    vibration: Option<&'a SeriesVibration>,
    points: usize,
}

impl<'a> ToothMarks<'a> {
    /// Of a path as it was followed, with its vibration if the study asks for it.
    pub fn of(
        part: &'a MachinedPart,
        found: &'a PathResult,
        vibration: Option<&'a SeriesVibration>,
    ) -> ToothMarks<'a> {
        ToothMarks {
            part,
            cuts: match &found.along.load {
                PathLoad::Cuts(cuts) => Some(cuts),
                _ => None,
            },
            vibration,
            points: found.along.answers.points.len(),
        }
    }

    /// The roughness of these points of the surface.
    pub fn roughness(&self, points: &[SurfaceDeviation]) -> Roughness {
        let largest = |of: &dyn Fn(&SurfaceDeviation, usize) -> Option<f64>| {
            let each = points
                .iter()
                .filter_map(|point| of(point, point.made_by.move_index()? % self.points));
            each.reduce(f64::max)
        };
        Roughness {
            feed_marks: largest(&|point, index| self.feed_marks(point, index)),
            vibration: largest(&|_, index| {
                let here = self.vibration?.points.get(index)?.as_ref()?;
                Some(here.cut?.forced?.amplitude)
            }),
        }
    }

    fn feed_marks(&self, point: &SurfaceDeviation, index: usize) -> Option<f64> {
        let track = &self.part.track;
        let axis = track.placing.path_spindle(&track.path.points[index]);
        let here = self.cuts?.points.get(index)?;
        let feed = here.cut?.feed;
        let radius = self.cuts?.cutters[here.cutter].radius();
        let is_wall = axis.dot(&point.normal).abs() < ALONG_TOOL;
        (is_wall && feed < 2.0 * radius).then(|| height_of_marks(radius, feed))
    }
}

/// Height between arcs of this radius at distances of `feed`, m.
fn height_of_marks(radius: f64, feed: f64) -> f64 {
    let half = 0.5 * feed;
    // Without the cancellation of r - sqrt(r^2 - f^2/4).
    half * half / (radius + (radius * radius - half * half).sqrt())
}

#[cfg(test)]
mod tests {
    use super::height_of_marks;

    #[test]
    fn marks_are_as_high_as_arcs_between_their_crossings() {
        // A triangle with the sides 5, 4, 3: arcs of radius 5 at distances of 6 cross 4 from the centres.
        assert!((height_of_marks(5.0, 6.0) - 1.0).abs() < 1e-15);
        // f^2 / 8 r of a small feed; the next term of the series is f^4 / 128 r^3.
        let [r, f]: [f64; 2] = [5e-3, 5e-5];
        let series = f * f / (8.0 * r) + f.powi(4) / (128.0 * r.powi(3));
        assert!((height_of_marks(r, f) / series - 1.0).abs() < 1e-9);
    }
}
