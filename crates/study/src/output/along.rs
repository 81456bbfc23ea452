//! A path too long for a chart: handfuls of points that follow on each other, each drawn as its largest value.

use armill_core::path::PathPoint;

/// Points that a chart shows at most: of a longer path each stands for the largest of those around it.
const MOST_POINTS: usize = 1200;

/// The points of a path in handfuls, each of one point where they are few.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Handfuls {
    points: usize,
    each: usize,
}

impl Handfuls {
    /// Of so many points.
    pub(crate) fn of(points: usize) -> Handfuls {
        let each = points.div_ceil(MOST_POINTS).max(1);
        Handfuls { points, each }
    }

    /// Whether each is one point, whose value is shown with its sign.
    pub(crate) fn are_points(self) -> bool {
        self.each == 1
    }

    /// Distance along the path of the first of each, mm.
    pub(crate) fn positions_mm(self, points: &[PathPoint]) -> Vec<f64> {
        let first = points.iter().step_by(self.each);
        first.map(|point| point.along * 1e3).collect()
    }

    /// The largest size in each; of single points the value itself. NaN where none is a number.
    pub(crate) fn largest(self, of: impl Fn(usize) -> f64) -> Vec<f64> {
        let firsts = (0..self.points).step_by(self.each);
        let of_handful = |first: usize| {
            let points = first..(first + self.each).min(self.points);
            match self.are_points() {
                true => of(first),
                false => points.map(|i| of(i).abs()).fold(f64::NAN, f64::max),
            }
        };
        firsts.map(of_handful).collect()
    }
}
