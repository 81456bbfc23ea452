//! `machined_part` in SI: what is cut, from what, by what, and what it is compared with.

use armill_core::clearance::Triangle;
use armill_core::form::AlignmentOptions;
use armill_core::machined::PathTool;
use armill_core::nalgebra::Point3;
use armill_core::removal::{DexelDirections, PartSize, StockSolid};

/// The part that comes out of a path.
#[derive(Clone, Debug)]
pub struct MachinedSetting {
    /// What it is cut from, frame of the path.
    pub stock: PartStock,
    /// Distance of the dexels, m.
    pub cell: f64,
    /// Their directions.
    pub directions: DexelDirections,
    /// Their number.
    pub size: PartSize,
    /// What the part is compared with.
    pub nominal: NominalPart,
    /// What cuts.
    pub tools: Vec<PathTool>,
    /// Walls whose thickness is evaluated.
    pub walls: Vec<WallSetting>,
    /// The measured part.
    pub scan: Option<ScanSetting>,
    /// What a user should know.
    pub notes: Vec<String>,
}

/// What a part is compared with.
#[derive(Clone, Debug)]
pub enum NominalPart {
    /// What the program leaves.
    Program,
    /// The solid within these triangles, frame of the path, m.
    Mesh(Vec<Triangle>),
}

/// The stock, frame of the path, m.
#[derive(Clone, Debug)]
pub enum PartStock {
    /// Between two corners.
    Box([Point3<f64>; 2]),
    /// Centre of the lower face, radius, height.
    Cylinder(Point3<f64>, f64, f64),
    /// Within triangles.
    Mesh(Vec<Triangle>),
}

impl PartStock {
    /// As the core has it.
    pub fn solid(&self) -> StockSolid<'_> {
        match self {
            PartStock::Box(corners) => StockSolid::Box(*corners),
            PartStock::Cylinder(base, radius, height) => StockSolid::Cylinder {
                base: *base,
                radius: *radius,
                height: *height,
            },
            PartStock::Mesh(triangles) => StockSolid::Mesh(triangles),
        }
    }
}

/// A wall between the faces of two features.
#[derive(Clone, Debug)]
pub struct WallSetting {
    /// Its name.
    pub name: String,
    /// Names of the features.
    pub between: [String; 2],
}

/// Measured points, and how they are compared.
#[derive(Clone, Debug)]
pub struct ScanSetting {
    /// Its file, as the study has it.
    pub file: String,
    /// Frame of the path, m; not yet aligned.
    pub points: Vec<Point3<f64>>,
    /// How they are aligned.
    pub align: Align,
    /// What is given in addition.
    pub options: AlignmentOptions,
    /// Wavelengths between the bands, m, descending.
    pub wavelengths: [f64; 2],
    /// What was assumed.
    pub notes: Vec<String>,
}

/// An alignment.
#[derive(Clone, Debug)]
pub enum Align {
    /// None.
    None,
    /// Least squares.
    BestFit,
    /// Datum points, frame of the path.
    Datums(DatumPoints),
}

/// Nominal positions of datum points, m.
#[derive(Clone, Debug)]
pub struct DatumPoints {
    /// On the primary plane.
    pub primary: Vec<Point3<f64>>,
    /// On the secondary plane.
    pub secondary: Vec<Point3<f64>>,
    /// On the tertiary plane.
    pub tertiary: Point3<f64>,
    /// Measured points within this distance are averaged, m.
    pub radius: f64,
}

/// Bytes of a point of the surface that is compared, with its values in files.
const BYTES_PER_POINT: f64 = 400.0;

impl MachinedSetting {
    /// Estimated memory, bytes: the stock, the nominal part and the part, and the points of their surface, some for each dexel.
    pub fn bytes(&self) -> f64 {
        3.0 * self.size.bytes + self.size.dexels * BYTES_PER_POINT
    }
}
