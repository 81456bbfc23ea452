//! Downsampling of a path for a chart: groups of consecutive points, each drawn as its largest value.

use armill_core::path::PathPoint;
use armill_core::units::to_mm;

/// Points that a chart shows at most: of a longer path each represents the largest value of a group.
const MOST_POINTS: usize = 1200;

/// The points of a path in groups, each of one point if they are few.
#[derive(Clone, Copy, Debug)]
pub struct PointGroups {
    points: usize,
    each: usize,
}

impl PointGroups {
    /// For so many points.
    pub fn of(points: usize) -> PointGroups {
        let each = points.div_ceil(MOST_POINTS).max(1);
        PointGroups { points, each }
    }

    /// Whether each group is one point, whose value is shown with its sign.
    pub fn are_points(self) -> bool {
        self.each == 1
    }

    /// Distance along the path of the first of each, mm.
    pub fn positions_mm(self, points: &[PathPoint]) -> Vec<f64> {
        let first = points.iter().step_by(self.each);
        first.map(|point| to_mm(point.along)).collect()
    }

    /// The largest absolute value in each group; of single points the value itself. NaN if none is a number.
    pub fn largest(self, of: impl Fn(usize) -> f64) -> Vec<f64> {
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
