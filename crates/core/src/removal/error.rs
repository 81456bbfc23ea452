//! Why no part can be computed.

use crate::units::to_mm;
use crate::watch::Cancelled;

/// Why no part can be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RemovalError {
    /// A number that is not finite.
    #[error("{0} is not a finite number")]
    NotFinite(&'static str),
    /// A number out of its range.
    #[error(
        "{what} is {} mm: must be between {} mm and {} mm",
        to_mm(value),
        to_mm(least),
        to_mm(most)
    )]
    OutOfRange {
        /// Which one.
        what: &'static str,
        /// m
        value: f64,
        /// m
        least: f64,
        /// m
        most: f64,
    },
    /// Too many dexels.
    #[error("the part has {dexels:.3e} dexels, {:.1} GB: the maximum is {most:.1e}; use a larger cell", bytes * 1e-9)]
    TooLarge {
        /// Number.
        dexels: f64,
        /// Memory of them.
        bytes: f64,
        /// Maximum number.
        most: f64,
    },
    /// No triangles.
    #[error("the mesh of the stock has no triangle")]
    NoTriangles,
    /// A mesh that does not enclose a solid.
    #[error(
        "the mesh of the stock is open: {lines} of the dexels cross it an odd number of times, the first along {axis} at ({:.3}, {:.3}) mm \
         across it; close its holes",
        to_mm(at[0]),
        to_mm(at[1])
    )]
    OpenMesh {
        /// How many dexels.
        lines: usize,
        /// Direction of the first.
        axis: char,
        /// Its coordinates across that direction, in the order of x, y, z; m.
        at: [f64; 2],
    },
    /// A number of a move that is not valid.
    #[error("move {place} of the list: {problem}")]
    Move {
        /// Its place in the list, from 0.
        place: usize,
        /// What is wrong.
        problem: &'static str,
    },
    /// A stride of 0.
    #[error("the stride of the mesh is 0: must be at least 1")]
    NoStride,
    /// Too many lattice points in a layer.
    #[error(
        "the lattice of the mesh has {points:.3e} points in a layer: the maximum is {most:.1e}; use a larger stride or cell"
    )]
    LatticeTooLarge {
        /// Number.
        points: f64,
        /// Maximum number.
        most: f64,
    },
    /// Too many triangles.
    #[error("the mesh has {triangles} triangles: the maximum is {most}; use a larger stride")]
    MeshTooLarge {
        /// Number.
        triangles: usize,
        /// Maximum number.
        most: usize,
    },
    /// Cancelled from outside; there is no result.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
