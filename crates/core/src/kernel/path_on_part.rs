//! A path on a part and a placement of the part, as a placement search gives them.

use nalgebra::Vector3;

use crate::frame::Isometry;
use crate::spatial::Wrench;

/// A point of a path relative to the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedPoint {
    /// The tool at this point, without additional spin.
    pub part_from_tool: Isometry,
    /// Directions of the selected component of the deviation, part axes; of length 1, or 0 where one is enough.
    pub along: [Vector3<f64>; 2],
}

/// The axes that wrenches are given in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrenchAxes {
    /// Those of the robot's base: independent of the placement of the part.
    Base,
    /// Those of the part: they rotate with the part.
    Part,
}

/// Wrenches on the tool at the TCP.
#[derive(Clone, Debug, PartialEq)]
pub struct PathWrenches {
    /// Their axes.
    pub wrench_axes: WrenchAxes,
    /// Load cases per point.
    pub cases: usize,
    /// One value per load case for all points, or for each point, point after point.
    pub wrenches: Vec<Wrench>,
}

/// Pose of a part, and the spin of the tool in addition to that of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartPlacement {
    /// The part in base.
    pub base_from_part: Isometry,
    /// Additional spin of the tool, rad.
    pub spin: f64,
    /// Position of the rail (the first prismatic joint), m; `None` where the question specifies it.
    pub rail: Option<f64>,
}

/// A placement with further spins of the tool to be tried.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpunPlacement<'a> {
    pub placement: &'a PartPlacement,
    /// In addition to that of the placement, rad.
    pub spins: &'a [f64],
}

/// Margins of postures to limits and singularities, and the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PostureMargins {
    /// Smallest distance of every revolute joint from its limits, of the elbow from stretched or folded, of the wrist
    /// from straight, rad.
    pub margin: f64,
    /// Smallest bend of the wrist, rad.
    pub wrist: f64,
    /// The excess of deviations over it is summed, m.
    pub tolerance: f64,
}
