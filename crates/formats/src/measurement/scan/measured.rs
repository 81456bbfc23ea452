//! Points of a part as they were read, and what must be given in addition to their file.

use armill_core::nalgebra::{Point3, Vector3};

use crate::measurement::profile::LengthUnit;
use crate::table::sheet::RowLimit;

/// Largest coordinate, m.
pub(super) const FARTHEST: f64 = 1e4;
/// Largest number of points.
pub(super) const LIMIT: RowLimit = RowLimit {
    most: 50_000_000,
    rows: "points",
    hint: "keep every tenth point, for example",
};
/// What a file of points is.
pub(super) const EMPTY_HINT: &str = "points are rows `x y z`, with or without a normal `nx ny nz`; a table with names such as \
    `x_mm,y_mm,z_mm`; a mesh; QIF or DMIS with measured points";
/// A vector is a normal if its length is 1 but for this.
const NEAR_ONE: f64 = 0.02;

/// Format of a file of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScanFormat {
    /// A mesh, or PLY without faces.
    Surface,
    /// Rows of numbers without names.
    Rows,
    /// A table with named columns.
    Table,
    /// The first sheet of an Excel workbook.
    Workbook,
    /// QIF.
    Qif,
    /// DMIS.
    Dmis,
}

impl ScanFormat {
    /// Its name, for messages.
    pub fn name(self) -> &'static str {
        match self {
            ScanFormat::Surface => "mesh or point cloud",
            ScanFormat::Rows => "rows without header",
            ScanFormat::Table => "table",
            ScanFormat::Workbook => "workbook",
            ScanFormat::Qif => "QIF",
            ScanFormat::Dmis => "DMIS",
        }
    }
}

/// Values that the file does not give.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScanReadOptions {
    /// The unit of lengths without one; mm if it is not given either.
    pub unit: Option<LengthUnit>,
}

/// Kind of a feature that the measuring software fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredFeatureKind {
    /// A plane.
    Plane,
    /// A circle.
    Circle,
    /// A cylinder.
    Cylinder,
}

/// A feature that the measuring software fitted to its points.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredFeature {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// What it is.
    pub kind: MeasuredFeatureKind,
    /// Its centre, a point of its plane or its axis, m.
    pub at: Option<Point3<f64>>,
    /// Its normal or axis, of length 1.
    pub direction: Option<Vector3<f64>>,
    /// m
    pub diameter: Option<f64>,
    /// Form error as the file gives it, m.
    pub form: Option<f64>,
}

/// Content of a file of points. Lists of what a file does not give are empty; any other has one entry per point.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    /// Its format.
    pub format: ScanFormat,
    /// The points, m, in the order of the file.
    pub points: Vec<Point3<f64>>,
    /// Outer normals, of length 1.
    pub normals: Vec<Option<Vector3<f64>>>,
    /// Nominal points, m.
    pub nominal: Vec<Option<Point3<f64>>>,
    /// Deviations as the file gives them, m.
    pub deviations: Vec<Option<f64>>,
    /// Names of points or of their features.
    pub names: Vec<String>,
    /// Features that the measuring software fitted.
    pub features: Vec<MeasuredFeature>,
    /// What was assumed or not used, one sentence each.
    pub notes: Vec<String>,
}

impl Scan {
    /// Without any point.
    pub(super) fn empty(format: ScanFormat) -> Scan {
        Scan {
            format,
            points: Vec::new(),
            normals: Vec::new(),
            nominal: Vec::new(),
            deviations: Vec::new(),
            names: Vec::new(),
            features: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Empties the lists that have no entry.
    pub(super) fn finished(mut self) -> Scan {
        if self.normals.iter().all(Option::is_none) {
            self.normals.clear();
        }
        if self.nominal.iter().all(Option::is_none) {
            self.nominal.clear();
        }
        if self.deviations.iter().all(Option::is_none) {
            self.deviations.clear();
        }
        if self.names.iter().all(String::is_empty) {
            self.names.clear();
        }
        let without = self.normals.iter().filter(|normal| normal.is_none()).count();
        if without > 0 {
            self.notes
                .push(format!("{without} points have no normal of length 1"));
        }
        self
    }
}

/// The unit to use, and what to note about it.
pub(super) fn unit_of(given: &ScanReadOptions, scan: &mut Scan) -> f64 {
    if given.unit.is_none() {
        scan.notes.push("no unit is given: mm assumed".to_owned());
    }
    given.unit.unwrap_or(LengthUnit::Millimetre).factor()
}

/// A vector that is a normal, scaled to length 1.
pub(super) fn normal_of(vector: [f64; 3]) -> Option<Vector3<f64>> {
    let vector = Vector3::from(vector);
    let length = vector.norm();
    ((length - 1.0).abs() < NEAR_ONE).then(|| vector / length)
}

/// A point that can be calculated with.
///
/// # Errors
/// A coordinate beyond the largest one: what is wrong.
pub(super) fn point_of(coordinates: [f64; 3]) -> Result<Point3<f64>, String> {
    match coordinates.iter().find(|x| x.is_nan() || x.abs() > FARTHEST) {
        Some(x) => Err(format!("a coordinate of {x} m exceeds {FARTHEST} m")),
        None => Ok(Point3::from(coordinates)),
    }
}
