//! Where the lines of dexels cross the triangles of a mesh.
//!
//! A line crosses a triangle if a ray across the line, along one direction, crosses an odd number of its edges, all seen along the line. Each edge is decided in the
//! same way for both of its triangles, whatever the rounding: so a line crosses a closed mesh an even number of times, and an odd
//! number proves that the mesh is open. Between the first and the second crossing is material, and so on.
//!
//! Not decided: which side of a surface is inside (the order of corners is not used), solids that overlap.
//!
//! Source: the usual even-odd rule \[derived\].

use nalgebra::Point3;
use rayon::prelude::*;

use super::dexel::{STOCK, Span};
use super::grid::DexelGrid;
use super::swept::across;
use crate::clearance::Triangle;

/// A crossing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// Number of the cell, the first direction fastest.
    pub(super) cell: usize,
    /// Along the dexel, relative to the box, m.
    pub(super) place: f32,
    /// Number of the triangle.
    pub(super) triangle: u32,
}

/// All crossings of the dexels of a grid, by cell and from low to high.
pub(super) fn crossings(grid: &DexelGrid, triangles: &[Triangle]) -> Vec<Crossing> {
    let of_triangle = |(number, triangle): (usize, &Triangle)| of_one(grid, triangle, number as u32);
    let mut all: Vec<Crossing> = triangles
        .par_iter()
        .enumerate()
        .flat_map_iter(of_triangle)
        .collect();
    all.par_sort_by(|a, b| {
        let places = a.place.total_cmp(&b.place);
        a.cell.cmp(&b.cell).then(places).then(a.triangle.cmp(&b.triangle))
    });
    all
}

/// The crossings with one triangle.
fn of_one(grid: &DexelGrid, triangle: &Triangle, number: u32) -> Vec<Crossing> {
    let [i, j] = across(grid.k);
    let corners = triangle.0.map(|corner| [corner[i], corner[j]]);
    let range = |n: usize| {
        let (low, side) = (grid.low[[i, j][n]], grid.sides[n]);
        let ends = corners.map(|corner| (corner[n] - low) / side);
        let count = grid.cells[n] as f64;
        let least = ends.into_iter().fold(f64::INFINITY, f64::min);
        let most = ends.into_iter().fold(f64::NEG_INFINITY, f64::max);
        (least - 0.5).floor().clamp(0.0, count) as usize..(most + 0.5).ceil().clamp(0.0, count) as usize
    };
    let mut found = Vec::new();
    for row in range(1) {
        for column in range(0) {
            let at = grid.at([column, row]);
            let [a, b, c] = corners;
            if is_right_of(a, b, at) ^ is_right_of(b, c, at) ^ is_right_of(c, a, at) {
                let place = place(triangle, grid.k, at) - grid.low[grid.k];
                found.push(Crossing {
                    cell: row * grid.cells[0] + column,
                    place: place as f32,
                    triangle: number,
                });
            }
        }
    }
    found
}

/// Whether the ray from `at` along the first coordinate crosses an edge: the same for both orders of its ends.
fn is_right_of(a: [f64; 2], b: [f64; 2], at: [f64; 2]) -> bool {
    if (a[1] > at[1]) == (b[1] > at[1]) {
        return false;
    }
    let (lower, upper) = if a[1] < b[1] { (a, b) } else { (b, a) };
    let part = (at[1] - lower[1]) / (upper[1] - lower[1]);
    lower[0] + part * (upper[0] - lower[0]) > at[0]
}

/// Coordinate along `k` of a triangle over a point; within that of its corners.
fn place(triangle: &Triangle, k: usize, at: [f64; 2]) -> f64 {
    let normal = triangle.area_vector();
    let [i, j] = across(k);
    let corner: Point3<f64> = triangle.0[0];
    let off = (at[0] - corner[i]) * normal[i] + (at[1] - corner[j]) * normal[j];
    let ends = triangle.0.map(|corner| corner[k]);
    let [least, most] = [
        ends[0].min(ends[1]).min(ends[2]),
        ends[0].max(ends[1]).max(ends[2]),
    ];
    // A triangle along the line has no single place: any of its own is right to its height.
    let place = corner[k] - off / normal[k];
    if place.is_finite() {
        place.clamp(least, most)
    } else {
        least
    }
}

/// The material between the crossings of a dexel.
pub(super) fn spans_of(crossings: &[Crossing]) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for pair in crossings.chunks_exact(2) {
        let span = Span {
            low: pair[0].place,
            high: pair[1].place,
            low_origin: STOCK + pair[0].triangle,
            high_origin: STOCK + pair[1].triangle,
        };
        // Solids that touch are one.
        match spans.last_mut() {
            Some(last) if last.high >= span.low => {
                (last.high, last.high_origin) = (span.high, span.high_origin);
            }
            _ if span.low < span.high => spans.push(span),
            _ => {}
        }
    }
    spans
}
