//! Points of the surface of a part, and their normals.
//!
//! A point is an end of material along a dexel. Its move is known; the normal is that of the tool on this move, turned round: at the time `t` when
//! the distance of the point from the tool is least. The distance from a convex solid is convex in `t`, so the sign of its derivative is enough to find that by
//! halving:
//!
//! ```text
//! df/dt = -n(t) . m
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `f`, `n` | distance from the tool, negative inside; its gradient | m, - |
//! | `m`, `t` | the move, its time from 0 to 1 | m, - |
//!
//! At an edge of the tool, where two faces meet, the normal is that of one of both.
//!
//! Source: \[derived\].

use nalgebra::{Point3, Unit, Vector3};

use super::dexel::EndOrigin;
use super::grid::DexelGrid;
use super::outline::nearest;
use super::part::DexelPart;
use super::tool_solid::ToolSolid;
use super::turning::{Stroke, ToolMove};

/// A point where a dexel enters or leaves material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// In the frame of the part, m.
    pub position: Point3<f64>,
    /// Direction of its dexel: 0, 1, 2 for x, y, z.
    pub direction: usize,
    /// Whether material begins here, seen along the dexel; else it ends.
    pub begins: bool,
    /// What made it.
    pub origin: EndOrigin,
}

/// Distances that differ by less are equal, m: the resolution of the ends of dexels in 1 m.
const AS_NEAR: f64 = 1e-7;
/// Halvings of the time of a move: a billionth of a move.
const HALVINGS: usize = 30;

impl DexelPart {
    /// All points of the surface: by grid, cell and from low to high.
    pub fn surface(&self) -> impl Iterator<Item = SurfacePoint> {
        self.grids().iter().flat_map(|grid| {
            let [columns, rows] = grid.cells();
            let cells = (0..rows).flat_map(move |row| (0..columns).map(move |column| [column, row]));
            cells.flat_map(move |cell| grid.surface_at(cell))
        })
    }
}

impl DexelGrid {
    /// The points of the surface on the dexel of a cell, from low to high.
    pub fn surface_at(&self, cell: [usize; 2]) -> impl Iterator<Item = SurfacePoint> {
        self.material(cell).flat_map(move |span| {
            [0, 1].map(|end| SurfacePoint {
                position: self.position(cell, span.ends[end]),
                direction: self.direction(),
                begins: end == 0,
                origin: span.origins[end],
            })
        })
    }
}

impl ToolMove {
    /// The normal of the surface that this move leaves at `point`, out of the material; `turn_tolerance` (m) as it was cut.
    /// `None` where the point is on the axis of the tool, which has no direction across.
    pub fn surface_normal(
        &self,
        tool: &ToolSolid,
        turn_tolerance: f64,
        point: &Point3<f64>,
    ) -> Option<Unit<Vector3<f64>>> {
        let of_strokes = self
            .strokes(tool, turn_tolerance, 0)
            .map(|stroke| least_distance(tool, &stroke, point));
        let nearest = of_strokes.min_by(|one, other| one.0.total_cmp(&other.0))?;
        Unit::try_new(-nearest.1, 0.5)
    }
}

/// The least distance of a point from a moving tool, m, and its gradient.
fn least_distance(tool: &ToolSolid, stroke: &Stroke, point: &Point3<f64>) -> (f64, Vector3<f64>) {
    let travel = stroke.ends[1] - stroke.ends[0];
    let at = |t: f64| {
        let off = point - (stroke.ends[0] + travel * t);
        let height = off.dot(&stroke.axis);
        let across = off - stroke.axis.into_inner() * height;
        let rho = across.norm();
        let found = nearest(tool, rho, height);
        let [out, up] = found.normal;
        let radial = if rho > 0.0 { across / rho } else { Vector3::zeros() };
        (found.distance, radial * out + stroke.axis.into_inner() * up)
    };
    let falls = |t: f64| at(t).1.dot(&travel) > 0.0;
    let (mut low, mut high) = (0.0, 1.0);
    if !falls(0.0) {
        return at(0.0);
    }
    if falls(1.0) {
        return at(1.0);
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *(if falls(middle) { &mut low } else { &mut high }) = middle;
    }
    let (one, other) = (at(low), at(high));
    // Where the tool touches the point from one time on, as a drill its hole: of two faces that are equally near, the one that the move grazes.
    let is_as_near = (one.0.abs() - other.0.abs()).abs() <= AS_NEAR;
    let grazes = |face: &(f64, Vector3<f64>)| face.1.dot(&travel).abs();
    let first = match is_as_near {
        true => grazes(&one) < grazes(&other),
        false => one.0 <= other.0,
    };
    if first { one } else { other }
}
