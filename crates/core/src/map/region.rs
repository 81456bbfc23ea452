//! The region of a plane map within a limit: how large, where, and what part fits into it.
//!
//! Area and boundary follow the limit between points, linearly; cells with an unreached corner do not count.
//! Rectangle and circle are made of grid points within. m, m^2.

use nalgebra::Point2;

pub use super::inscribed::{Disc, Rectangle};
use super::inscribed::{largest_disc, largest_rectangle};
use super::marching_squares::within_level;
use crate::workpiece::Grid;

/// The part of a plane where the deviation is within a limit.
#[derive(Clone, Debug)]
pub struct Region {
    /// Area, m^2.
    pub area: f64,
    /// Polylines in part x and y (m), the region to their left; closed ones repeat their first point.
    pub boundary: Vec<Vec<Point2<f64>>>,
    /// Largest axis-parallel rectangle inside.
    pub rectangle: Option<Rectangle>,
    /// Largest circle inside.
    pub disc: Option<Disc>,
}

/// The region of `grid` where `values` (by grid index, `None` where unreached) are at most `limit`.
pub fn region_within(grid: &Grid, values: &[Option<f64>], limit: f64) -> Region {
    let within: Vec<bool> = values.iter().map(|v| v.is_some_and(|v| v <= limit)).collect();
    let shape = within_level(grid, values, limit);
    Region {
        area: shape.area,
        boundary: shape.boundary,
        rectangle: largest_rectangle(grid, &within),
        disc: largest_disc(grid, &within),
    }
}
