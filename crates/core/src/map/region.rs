//! The region of a plane map within a tolerance: its size, its position, and inscribed shapes.
//!
//! Area and boundary follow the tolerance between points, linearly; cells with an unreachable corner are not included.
//! Rectangle and circle consist of grid points within. m, m^2.

use nalgebra::Point2;

pub use super::inscribed::{Disc, Rectangle};
use super::inscribed::{largest_disc, largest_rectangle};
use crate::marching_squares::{ScalarField, enclosed_area};
use crate::workpiece::Grid;

/// The part of a plane where the deviation is within the tolerance.
#[derive(Clone, Debug)]
pub struct Region {
    /// Area, m^2.
    pub area: f64,
    /// Closed polylines in part x and y (m), the region to their left; each repeats its first point.
    pub boundary: Vec<Vec<Point2<f64>>>,
    /// Largest axis-parallel rectangle inside.
    pub rectangle: Option<Rectangle>,
    /// Largest circle inside.
    pub disc: Option<Disc>,
}

/// The region of `grid` where `values` (by grid index, `None` where unreachable) are at most `limit`, the tolerance.
pub fn region_within(grid: &Grid, values: &[Option<f64>], limit: f64) -> Region {
    let within: Vec<bool> = values.iter().map(|v| v.is_some_and(|v| v <= limit)).collect();
    let axis = |count: usize| -> Vec<f64> { (0..count).map(|k| grid.coordinate(k, count)).collect() };
    let field = ScalarField {
        x: &axis(grid.columns),
        y: &axis(grid.rows),
        values,
    };
    let boundary = field.area_up_to(limit);
    Region {
        area: enclosed_area(&boundary),
        boundary: boundary
            .into_iter()
            .map(|ring| ring.into_iter().map(Point2::from).collect())
            .collect(),
        rectangle: largest_rectangle(grid, &within),
        disc: largest_disc(grid, &within),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn inscribed_shapes_are_inside_the_region_and_never_larger() {
        let grid = Grid::within([0.5, 0.4], 0.01);
        let field = |p: Point2<f64>| (p.x * 1.1 - 0.1).hypot(p.y) + 0.1 * (7.0 * p.x).sin();
        let values: Vec<_> = (0..grid.len()).map(|i| Some(field(grid.point(i)))).collect();
        let region = region_within(&grid, &values, 0.3);
        let (rectangle, disc) = (region.rectangle.unwrap(), region.disc.unwrap());
        assert!(rectangle.area() < region.area && PI * disc.radius.powi(2) < region.area);
        assert!(rectangle.area() > 0.5 * region.area);
        for k in 0..100 {
            let (sin, cos) = (f64::from(k) * PI / 50.0).sin_cos();
            let rim = disc.centre + nalgebra::Vector2::new(cos, sin) * disc.radius;
            assert!(field(rim) <= 0.3, "{rim}");
            let part = f64::from(k) / 99.0;
            for corner in [
                Point2::new(rectangle.lower.x, rectangle.lower.y),
                Point2::new(rectangle.upper.x, rectangle.lower.y),
                Point2::new(rectangle.lower.x, rectangle.upper.y),
                Point2::new(rectangle.upper.x, rectangle.upper.y),
            ] {
                let at = disc.centre + (corner - disc.centre) * part;
                assert!(field(corner) <= 0.3, "{at}");
            }
        }
    }

    #[test]
    fn a_larger_tolerance_never_shrinks_the_region_and_an_unreachable_point_never_enlarges_it() {
        let grid = Grid::within([0.3, 0.3], 0.05);
        let values: Vec<_> = (0..grid.len()).map(|i| Some(((i * 7919) % 101) as f64)).collect();
        let mut before = region_within(&grid, &values, -1.0);
        assert_eq!((before.area, before.rectangle, before.disc), (0.0, None, None));
        for limit in [10.0, 40.0, 70.0, 90.0, 101.0] {
            let region = region_within(&grid, &values, limit);
            let size = |region: &Region| region.rectangle.map_or(0.0, |found| found.area());
            assert!(
                region.area >= before.area && size(&region) >= size(&before),
                "{limit}"
            );
            let mut holed = values.clone();
            holed[40] = None;
            assert!(region_within(&grid, &holed, limit).area <= region.area);
            before = region;
        }
        assert!((before.area - 0.36).abs() < 1e-12);
    }
}
