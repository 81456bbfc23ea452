//! A profile as it was read, and what must be given in addition to its file.

use armill_core::nalgebra::{Point2, Point3};

use super::length_unit::LengthUnit;
use crate::table::sheet::RowLimit;

/// Format of a file of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A table with named columns.
    Table,
    /// Rows of numbers without a header.
    Plain,
}

impl Format {
    /// Its name, for messages.
    pub fn name(self) -> &'static str {
        match self {
            Format::Table => "table",
            Format::Plain => "rows without header",
        }
    }
}

/// Values that the file does not give.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProfileReadOptions {
    /// The radius to which deviations refer, mm.
    pub radius_mm: Option<f64>,
    /// The radius to use if the file has deviations and no other radius is known, mm.
    pub else_radius_mm: Option<f64>,
    /// The unit of rows without a header.
    pub unit: Option<LengthUnit>,
}

/// Points, m.
#[derive(Clone, Debug, PartialEq)]
pub enum Points {
    /// In the plane of the profile.
    Plane(Vec<Point2<f64>>),
    /// In space, near a plane.
    Space(Vec<Point3<f64>>),
}

/// Content of a file of points.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredProfile {
    /// Its format.
    pub format: Format,
    /// The points, in order.
    pub points: Points,
    /// Line of each point, from 1.
    pub lines: Vec<usize>,
    /// Ignored columns.
    pub unused: Vec<String>,
}

/// Maximum number of points: an hour of an instrument that takes 10 000 per second.
pub(super) const LIMIT: RowLimit = RowLimit {
    most: 20_000_000,
    rows: "points",
    hint: "keep every tenth point, for example",
};

impl Points {
    /// Number of points.
    pub fn count(&self) -> usize {
        match self {
            Points::Plane(points) => points.len(),
            Points::Space(points) => points.len(),
        }
    }

    /// Adds a point with as many coordinates as the others.
    pub(super) fn push(&mut self, [x, y, z]: [f64; 3]) {
        match self {
            Points::Plane(points) => points.push(Point2::new(x, y)),
            Points::Space(points) => points.push(Point3::new(x, y, z)),
        }
    }
}
